//! The page around the figures.

use super::Figure;
use super::svg::escape;
use crate::summary::Findings;
use crate::table::Table;

/// The whole page: style and drawings inline, no script, no network.
pub(super) fn render(findings: &Findings, figures: &[Figure]) -> String {
    let mut page = String::from("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    page.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    page.push_str("<meta name=\"color-scheme\" content=\"light dark\">\n");
    page.push_str(&format!("<title>{}</title>\n", escape(&findings.title)));
    page.push_str(concat!("<style>\n", include_str!("style.css"), "</style>\n</head>\n<body>\n<main>\n"));
    page.push_str(&format!("<h1>{}</h1>\n", escape(&findings.title)));
    for sentence in &findings.lead {
        page.push_str(&format!("<p class=\"lead\">{}</p>\n", escape(&unbroken(sentence))));
    }
    page.push_str("<div class=\"tables\">\n");
    findings.tables.iter().for_each(|table| push_table(&mut page, table));
    page.push_str("</div>\n<div class=\"figures\">\n");
    figures.iter().for_each(|figure| push_figure(&mut page, figure));
    page.push_str("</div>\n");
    if !findings.notes.is_empty() {
        page.push_str("<h2>To be minded</h2>\n<ul>\n");
        for note in &findings.notes {
            page.push_str(&format!("<li>{}.</li>\n", escape(&unbroken(note))));
        }
        page.push_str("</ul>\n");
    }
    page.push_str(&format!(
        "<footer>Forces and torques are loads on the fingertip, in the sensor frame. Curves are thinned so that their \
         peaks are kept; quantiles are right to 0.4 %. Made by fingertip {}.</footer>\n</main>\n</body>\n</html>\n",
        env!("CARGO_PKG_VERSION")
    ));
    page
}

/// Keeps numbers and their units on one line.
fn unbroken(text: &str) -> String {
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

fn push_table(page: &mut String, table: &Table) {
    page.push_str(&format!("<section><h2>{}</h2><table><thead><tr>", escape(&table.title)));
    for head in &table.head {
        page.push_str(&format!("<th scope=\"col\">{}</th>", escape(&unbroken(head))));
    }
    page.push_str("</tr></thead><tbody>\n");
    for row in &table.rows {
        page.push_str("<tr>");
        for (column, cell) in row.iter().enumerate() {
            let tag = if column == 0 { "th scope=\"row\"" } else { "td" };
            let end = if column == 0 { "th" } else { "td" };
            page.push_str(&format!("<{tag}>{}</{end}>", escape(&unbroken(cell))));
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody></table></section>\n");
}

fn push_figure(page: &mut String, figure: &Figure) {
    page.push_str(&format!("<figure><h2>{}</h2>\n", escape(&figure.title)));
    if !figure.keys.is_empty() {
        page.push_str("<p class=\"keys\">");
        for (class, name) in &figure.keys {
            page.push_str(&format!("<span><i class=\"{class}\"></i>{}</span>", escape(name)));
        }
        page.push_str("</p>\n");
    }
    page.push_str(&figure.svg);
    page.push_str(&format!("\n<figcaption>{}</figcaption></figure>\n", escape(&unbroken(&figure.caption))));
}

#[cfg(test)]
mod tests {
    use super::super::Figure;
    use super::super::svg::escape;
    use super::{Findings, Table, render, unbroken};

    #[test]
    fn numbers_stay_with_their_units() {
        assert_eq!(
            unbroken("It is 1.5 N, or 3 %. In 2 steps."),
            "It is 1.5\u{a0}N, or 3\u{a0}%. In 2 steps."
        );
    }

    #[test]
    fn only_a_number_and_its_unit_are_kept_together() {
        let kept = |text: &str| unbroken(text).replace('\u{a0}', "_");
        assert_eq!(kept("5 mm, 3 ms; 1 Hz: 2 s"), "5_mm, 3_ms; 1_Hz: 2_s");
        assert_eq!(kept("N of s % 5 apples x1 N"), "N of s % 5 apples x1_N");
        assert_eq!(kept("  5  N "), "  5  N ");
        assert_eq!(kept("N"), "N");
    }

    #[test]
    fn the_page_holds_everything_that_was_found_and_nothing_unescaped() {
        let mut table = Table::new("T<1>", ["", "a & b"]);
        table.row(["first".to_owned(), "1 N".to_owned()]);
        table.row(["second".to_owned(), "\"2\"".to_owned()]);
        let findings = Findings {
            title: "A < B".to_owned(),
            lead: vec!["Lead 1 N.".to_owned()],
            tables: vec![table],
            notes: vec!["mind > this".to_owned()],
        };
        let figure = |keys| Figure {
            title: "F&G".to_owned(),
            svg: "<svg></svg>".to_owned(),
            keys,
            caption: "C \"q\"".to_owned(),
        };
        let page = render(&findings, &[figure(vec![("a", "x < y".to_owned())]), figure(Vec::new())]);
        let (_, body) = page.split_once("<body>\n").unwrap();
        let (body, footer) = body.split_once("<footer>").unwrap();
        let expected = "<main>\n<h1>A &lt; B</h1>\n<p class=\"lead\">Lead 1\u{a0}N.</p>\n<div class=\"tables\">\n\
            <section><h2>T&lt;1&gt;</h2><table><thead><tr><th scope=\"col\"></th><th scope=\"col\">a &amp; b</th></tr></thead>\
            <tbody>\n<tr><th scope=\"row\">first</th><td>1\u{a0}N</td></tr>\n<tr><th scope=\"row\">second</th>\
            <td>&quot;2&quot;</td></tr>\n</tbody></table></section>\n</div>\n<div class=\"figures\">\n\
            <figure><h2>F&amp;G</h2>\n<p class=\"keys\"><span><i class=\"a\"></i>x &lt; y</span></p>\n<svg></svg>\n\
            <figcaption>C &quot;q&quot;</figcaption></figure>\n<figure><h2>F&amp;G</h2>\n<svg></svg>\n\
            <figcaption>C &quot;q&quot;</figcaption></figure>\n</div>\n\
            <h2>To be minded</h2>\n<ul>\n<li>mind &gt; this.</li>\n</ul>\n";
        assert_eq!(body, expected);
        assert!(footer.ends_with("</footer>\n</main>\n</body>\n</html>\n"));
        assert!(page.contains("<title>A &lt; B</title>"));
        assert!(!render(&Findings::default(), &[]).contains("To be minded"));
        assert_eq!(escape("<&>\""), "&lt;&amp;&gt;&quot;");
    }
}
