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
    let (head, rows) = (strings(["", "a & b"]), [strings(["first", "1 N"]), strings(["second", "\"w\""])]);
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
        every.contains(" print-color-adjust: exact") && every.contains("-webkit-print-color-adjust: exact")
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
