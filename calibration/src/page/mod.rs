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
///
/// ```
/// use fingertip_calibration::page::Page;
///
/// let mut page = Page::new("Force sensor");
/// page.lead("It is off by < 20 mN.");
/// page.list("To mind", &["The zero drifts.".into()]);
/// page.list("Faults", &[]);
/// let html = page.finish("made on Tuesday");
/// assert!(html.starts_with("<!doctype html>") && html.contains("off by &lt; 20"));
/// // A list without items has no heading.
/// assert!(html.contains("To mind") && !html.contains("Faults"));
/// ```
#[derive(Debug)]
pub struct Page {
    title: String,
    body: String,
}

/// A table: its first column is names, the others are numbers, or with `words` whatever they are.
///
/// ```
/// use fingertip_calibration::page::{Page, Table};
///
/// let head = ["axis", "error / mN"].map(String::from);
/// let rows = [["Fx", "7"], ["Fy", "9"]].map(|row| row.map(String::from).to_vec());
/// let mut page = Page::new("Force sensor");
/// page.table(&Table { title: "Errors", head: &head, rows: &rows, ..Table::default() });
/// let html = page.finish("");
/// assert!(html.contains("<table") && html.contains("error / mN"));
/// // A row for the head and one for each axis.
/// assert_eq!(html.matches("<tr>").count(), 3);
/// ```
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
///
/// ```
/// use fingertip_calibration::page::{Axis, Chart, Figure, Page};
///
/// let mut chart = Chart::new("force over time", Axis::linear("t / s", 0.0, 2.0), Axis::linear("F / N", 0.0, 5.0));
/// chart.curve("a", &[vec![(0.0, 0.0), (1.0, 4.0), (2.0, 1.0)]]);
/// let figure = Figure {
///     title: "A push".into(),
///     svg: chart.finish(),
///     keys: vec![("a", "normal force".into())],
///     caption: "It lasts a second.".into(),
///     ..Figure::default()
/// };
/// let mut page = Page::new("Force sensor");
/// page.figure(&figure);
/// let html = page.finish("");
/// assert!(html.contains("<svg") && html.contains("normal force") && html.contains("It lasts"));
/// ```
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
mod tests;
