//! Web pages: every report of the workspace is written by this one writer, in one style.
//!
//! A page is one file without outside files. Its scripts are those that a drawing brings, and one that reads the point
//! under the pointer of drawings that tell their axes: an inner `svg` with `data-x` and `data-y`
//! (`label / unit;low;high`, and `;log` for decades) or with `data-turn` (how long the radius of a sphere is drawn,
//! in an equal-area map about the middle). Its style follows the reader's choice of light or dark, and
//! prints in light. Text is escaped wherever it stands. Drawings are SVG: those whose colours are classes of the style
//! sheet follow the reader's choice, and those with colours of their own stand on white.
//!
//! ```
//! use fingertip_calibration::page::{Figure, Page, Table};
//!
//! let mut page = Page::new("A sensor");
//! page.paragraph("It is off by 1 % or less, < 2 N.");
//! let rows = vec![vec!["Fx".to_owned(), "0.3".to_owned()]];
//! page.table(&Table { title: "Errors", head: &["axis".to_owned(), "%".to_owned()], rows: &rows, words: false });
//! let svg = "<svg></svg>".to_owned();
//! page.figures([Figure { title: "Error".to_owned(), svg, ..Figure::default() }]);
//! let html = page.finish("Made today.");
//! assert!(html.starts_with("<!doctype html>") && html.contains("&lt; 2\u{a0}N"));
//! ```

mod axis;
mod chart;
mod labels;
mod numbers;
mod svg;

pub use axis::{Axis, Scale, Tick};
pub use chart::Chart;
pub use labels::{Placed, text_width, thinned};
pub use numbers::Counting;
pub use svg::{Anchor, Svg, TICK_SIZE};

use maud::{DOCTYPE, Markup, PreEscaped, Render, html};

/// A page, in the order in which things are put on it.
#[derive(Debug)]
pub struct Page {
    title: String,
    body: String,
}

/// A table: its first column is names, the others are numbers, or with `words` whatever they are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Table<'a> {
    /// Its heading; nothing for none.
    pub title: &'a str,
    /// Heads of the columns.
    pub head: &'a [String],
    /// Its rows.
    pub rows: &'a [Vec<String>],
    /// Whether cells behind the first column can be words, which then stand on the left.
    pub words: bool,
}

/// A drawing with its legend.
#[derive(Clone, Debug, Default)]
pub struct Figure {
    /// Its heading.
    pub title: String,
    /// What is drawn: SVG, taken as it is, or an element around one, with what is shown in its place where scripts run.
    pub svg: String,
    /// A class of the style sheet, and what is drawn so.
    pub keys: Vec<(&'static str, String)>,
    /// What stands below.
    pub caption: String,
    /// Whether the drawing has colours of its own, so that it must stand on white.
    pub on_white: bool,
}

/// What a drawing has whose points can be read.
const READABLE: [&str; 2] = [" data-x=\"", " data-turn=\""];

impl Page {
    /// A page with its heading.
    #[must_use]
    pub fn new(title: &str) -> Self {
        Self { title: title.to_owned(), body: String::new() }
    }

    pub(crate) fn push(&mut self, markup: &Markup) {
        self.body.push_str(&markup.0);
        self.body.push('\n');
    }

    /// A sentence of the result, before all else.
    pub fn lead(&mut self, text: &str) {
        self.push(&html! { p.lead { (unbroken(text)) } });
    }

    /// A heading, which a link can lead to.
    pub fn heading(&mut self, text: &str) {
        self.push(&html! { h2 id=(anchor(text)) { (text) } });
    }

    /// A heading below a heading.
    pub fn subheading(&mut self, text: &str) {
        self.push(&html! { h3 { (text) } });
    }

    /// Text.
    pub fn paragraph(&mut self, text: &str) {
        self.push(&html! { p { (unbroken(text)) } });
    }

    /// Text in small print.
    pub fn small(&mut self, text: &str) {
        self.push(&html! { p.small { (unbroken(text)) } });
    }

    /// A file beside the page.
    pub fn link(&mut self, before: &str, file: &str) {
        self.push(&html! { p.small { (before) a href=(file) { (file) } } });
    }

    /// Links to headings.
    pub fn contents<'a>(&mut self, headings: impl IntoIterator<Item = &'a str>) {
        self.push(&html! { ul {
            @for text in headings { li { a href={ "#" (anchor(text)) } { (text) } } }
        } });
    }

    /// A heading with a list below it; nothing if the list is empty.
    pub fn list(&mut self, heading: &str, items: &[String]) {
        if !items.is_empty() {
            self.push(&html! { h2 { (heading) } ul { @for item in items { li { (unbroken(item)) } } } });
        }
    }

    /// A table.
    pub fn table(&mut self, table: &Table<'_>) {
        self.push(&table.render());
    }

    /// Tables side by side, where there is room.
    pub fn tables<'a>(&mut self, tables: impl IntoIterator<Item = Table<'a>>) {
        self.push(&html! { div.columns { @for table in tables { (table) } } });
    }

    /// Figures side by side, where there is room.
    pub fn figures(&mut self, figures: impl IntoIterator<Item = Figure>) {
        self.push(&html! { div.columns { @for figure in figures { (figure) } } });
    }

    /// A figure as wide as the page.
    pub fn figure(&mut self, figure: &Figure) {
        self.push(&figure.render());
    }

    /// The whole page; `footer` stands at its end.
    #[must_use]
    pub fn finish(&self, footer: &str) -> String {
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(include_str!("style.css"))) }
                }
                body {
                    main {
                        h1 { (self.title) }
                        (PreEscaped(&self.body))
                        @if !footer.is_empty() { footer { (unbroken(footer)) } }
                    }
                    @if READABLE.iter().any(|axes| self.body.contains(axes)) {
                        script { (PreEscaped(include_str!("read.js"))) }
                    }
                }
            }
        };
        let mut text = page.0.replacen("<!DOCTYPE html>", "<!doctype html>", 1);
        text.push('\n');
        text
    }
}

impl Render for Table<'_> {
    fn render(&self) -> Markup {
        let word = |cell: &str| {
            self.words && cell != "-" && cell.trim_end_matches('%').trim().parse::<f64>().is_err()
        };
        html! {
            section {
                @if !self.title.is_empty() { h2 { (self.title) } }
                table {
                    thead { tr { @for head in self.head { th scope="col" { (unbroken(head)) } } } }
                    tbody { @for row in self.rows { tr {
                        @for (column, cell) in row.iter().enumerate() {
                            @if column == 0 { th scope="row" { (unbroken(cell)) } }
                            @else if word(cell) { td.word { (unbroken(cell)) } }
                            @else { td { (unbroken(cell)) } }
                        }
                    } } }
                }
            }
        }
    }
}

impl Render for Figure {
    fn render(&self) -> Markup {
        html! {
            figure class=[self.on_white.then_some("on-white")] {
                @if !self.title.is_empty() { h2 { (self.title) } }
                @if !self.keys.is_empty() {
                    p.keys { @for (class, name) in &self.keys { span { i class=(self.class_of(class)) {} (name) } } }
                }
                (PreEscaped(&self.svg))
                @if !self.caption.is_empty() { figcaption { (unbroken(&self.caption)) } }
            }
        }
    }
}

impl Figure {
    /// The class of a key: one whose curve has shapes on it shows them.
    fn class_of(&self, class: &str) -> String {
        let shapes = format!("class=\"shapes {class}\"");
        if self.svg.contains(&shapes) { format!("{class} shaped") } else { class.to_owned() }
    }
}

fn anchor(text: &str) -> String {
    text.chars().filter(char::is_ascii_alphanumeric).collect()
}

/// Keeps numbers and their units on one line.
pub(crate) fn unbroken(text: &str) -> String {
    let units = ["%", "N", "mm", "s", "ms", "Hz"];
    let mut unbroken = String::with_capacity(text.len() + 16);
    for (number, word) in text.split(' ').enumerate() {
        let unit = word.trim_end_matches(['.', ',', ':', ';']);
        let after_digit = unbroken.ends_with(|c: char| c.is_ascii_digit());
        if number > 0 {
            unbroken.push(if after_digit && units.contains(&unit) { '\u{a0}' } else { ' ' });
        }
        unbroken.push_str(word);
    }
    unbroken
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The script that reads points comes with the drawings that tell their axes, once.
    #[test]
    fn points_are_read_where_axes_are_told() {
        let page = |drawing: &str| {
            let mut page = Page::new("");
            let figure = Figure { svg: drawing.to_owned(), ..Figure::default() };
            page.figures([figure.clone(), figure]);
            page.finish("")
        };
        assert_eq!(page("<svg></svg>").matches("<script>").count(), 0);
        for axes in ["data-x=\"time / s;0;1\" data-y=\"force / N;0.1;10;log\"", "data-turn=\"20\""] {
            assert_eq!(page(&format!("<svg><svg {axes}></svg></svg>")).matches("<script>").count(), 1);
        }
    }

    #[test]
    fn only_a_number_and_its_unit_are_kept_together() {
        let kept = |text: &str| unbroken(text).replace('\u{a0}', "_");
        assert_eq!(kept("It is 1.5 N, or 3 %. In 2 steps."), "It is 1.5_N, or 3_%. In 2 steps.");
        assert_eq!(kept("5 mm, 3 ms; 1 Hz: 2 s"), "5_mm, 3_ms; 1_Hz: 2_s");
        assert_eq!(kept("N of s % 5 apples x1 N"), "N of s % 5 apples x1_N");
        assert_eq!(kept("  5  N "), "  5  N ");
        assert_eq!(kept("N"), "N");
    }

    fn body(page: &Page) -> String {
        let html = page.finish("made & done");
        let (head, body) = html.split_once("<body>").unwrap();
        assert!(
            head.starts_with("<!doctype html><html lang=\"en\">") && head.contains("<title>A &lt; B</title>")
        );
        body.to_owned()
    }

    #[test]
    fn the_page_holds_everything_and_nothing_unescaped() {
        let mut page = Page::new("A < B");
        page.lead("Lead 1 N.");
        page.contents(["One & two"]);
        page.heading("One & two");
        page.subheading("<h3>");
        page.small("a < b");
        page.link("Data: ", "x.csv");
        page.list("Mind", &["mind > this".to_owned()]);
        page.list("Nothing", &[]);
        let strings = |cells: [&str; 2]| cells.map(str::to_owned).to_vec();
        let (head, rows) =
            (strings(["", "a & b"]), [strings(["first", "1 N"]), strings(["second", "\"w\""])]);
        page.tables([Table { title: "T<1>", head: &head, rows: &rows, words: false }]);
        page.table(&Table { title: "", head: &head, rows: &rows[1..], words: true });
        let figure = Figure {
            title: "F&G".to_owned(),
            svg: "<svg></svg>".to_owned(),
            keys: vec![("a", "x < y".to_owned())],
            caption: "C \"q\"".to_owned(),
            on_white: false,
        };
        page.figures([figure.clone()]);
        page.figure(&Figure { keys: Vec::new(), title: String::new(), on_white: true, ..figure });
        let expected = "<main><h1>A &lt; B</h1><p class=\"lead\">Lead 1\u{a0}N.</p>\n\
            <ul><li><a href=\"#Onetwo\">One &amp; two</a></li></ul>\n<h2 id=\"Onetwo\">One &amp; two</h2>\n\
            <h3>&lt;h3&gt;</h3>\n<p class=\"small\">a &lt; b</p>\n<p class=\"small\">Data: <a href=\"x.csv\">x.csv</a></p>\n\
            <h2>Mind</h2><ul><li>mind &gt; this</li></ul>\n\
            <div class=\"columns\"><section><h2>T&lt;1&gt;</h2><table><thead><tr><th scope=\"col\"></th>\
            <th scope=\"col\">a &amp; b</th></tr></thead><tbody><tr><th scope=\"row\">first</th><td>1\u{a0}N</td></tr>\
            <tr><th scope=\"row\">second</th><td>&quot;w&quot;</td></tr></tbody></table></section></div>\n\
            <section><table><thead><tr><th scope=\"col\"></th><th scope=\"col\">a &amp; b</th></tr></thead><tbody>\
            <tr><th scope=\"row\">second</th><td class=\"word\">&quot;w&quot;</td></tr></tbody></table></section>\n\
            <div class=\"columns\"><figure><h2>F&amp;G</h2><p class=\"keys\"><span><i class=\"a\"></i>x &lt; y</span></p>\
            <svg></svg><figcaption>C &quot;q&quot;</figcaption></figure></div>\n\
            <figure class=\"on-white\"><svg></svg><figcaption>C &quot;q&quot;</figcaption></figure>\n\
            <footer>made &amp; done</footer></main></body></html>\n";
        assert_eq!(body(&page), expected);
        assert!(!Page::new("A < B").finish("").contains("<footer>"));
    }

    #[test]
    fn the_style_is_for_light_dark_and_paper() {
        let page = Page::new("").finish("");
        for part in ["(prefers-color-scheme: dark)", "@media print", "--ground"] {
            assert!(page.contains(part), "{part}");
        }
        assert!(!page.contains("http") && !page.contains("<script"));
    }

    /// Colours and swatches are printed: browsers leave backgrounds out unless they are told not to, and the dark colours are
    /// for screens alone.
    #[test]
    fn print_keeps_the_swatches_and_light_colours() {
        let page = Page::new("").finish("");
        let (_, every) = page.split_once("* {").unwrap();
        let (every, _) = every.split_once('}').unwrap();
        assert!(
            every.contains(" print-color-adjust: exact")
                && every.contains("-webkit-print-color-adjust: exact")
        );
        assert!(page.contains("@media screen and (prefers-color-scheme: dark)"));
        assert_eq!(page.matches("prefers-color-scheme").count(), 1);
    }

    /// A key shows the shapes that its curve has, and none where it has none.
    #[test]
    fn keys_have_the_shapes_of_their_curves() {
        let mut chart = Chart::new("", Axis::linear("", 0.0, 1.0), Axis::linear("", 0.0, 1.0));
        chart.curve("b", &[vec![(0.0, 0.0), (1.0, 1.0)]]);
        chart.curve("a wide", &[vec![(0.0, 1.0), (1.0, 0.0)]]);
        chart.dots("c", &[(0.5, 0.5)]);
        let keys = ["a", "b", "c spot"].map(|class| (class, String::new())).to_vec();
        let figure = Figure { svg: chart.finish(), keys, ..Figure::default() }.render().0;
        assert!(figure.contains("<i class=\"a\">") && figure.contains("<i class=\"b shaped\">"), "{figure}");
        assert!(figure.contains("<i class=\"c spot\">"));
    }
}
