//! The report: headings, paragraphs, tables and diagrams, as a page and as files.

use std::path::Path;

use crate::Failure;
use crate::plots::Diagram;
use crate::table::{Table, escaped};

/// The report in the order in which it was said.
#[derive(Default)]
pub(crate) struct Page {
    body: String,
    contents: String,
    files: Vec<(String, String)>,
}

impl Page {
    pub(crate) fn heading(&mut self, text: &str) {
        let anchor: String = text.chars().filter(char::is_ascii_alphanumeric).collect();
        self.contents += &format!("<li><a href='#{anchor}'>{}</a></li>\n", escaped(text));
        self.body += &format!("<h2 id='{anchor}'>{}</h2>\n", escaped(text));
    }

    pub(crate) fn subheading(&mut self, text: &str) {
        self.body += &format!("<h3>{}</h3>\n", escaped(text));
    }

    pub(crate) fn say(&mut self, paragraph: &str) {
        self.body += &format!("<p>{}</p>\n", escaped(paragraph));
    }

    /// Shows a table.
    pub(crate) fn table(&mut self, table: &Table) {
        self.body += &table.html();
    }

    /// Keeps a table as a file beside the page.
    pub(crate) fn data(&mut self, name: &str, table: &Table) {
        self.files.push((format!("{name}.csv"), table.csv()));
        self.body += &format!("<p class='data'>Data: <a href='{name}.csv'>{name}.csv</a></p>\n");
    }

    pub(crate) fn diagram(&mut self, name: &str, diagram: &Diagram) -> Result<(), Failure> {
        let svg = diagram.svg()?;
        self.body += &format!("<figure><figcaption>{}</figcaption>{svg}</figure>\n", escaped(&diagram.title));
        self.files.push((format!("{name}.svg"), svg));
        Ok(())
    }

    /// Writes the page, its diagrams and its data.
    pub(crate) fn write(&self, folder: &Path, introduction: &str) -> Result<(), Failure> {
        for (name, text) in &self.files {
            std::fs::write(folder.join(name), text)?;
        }
        let page = format!(
            "<!doctype html><html lang='en'><meta charset='utf-8'>\
             <meta name='viewport' content='width=device-width'><title>Error against run time</title>\
             <style>body{{font-family:sans-serif;margin:1em auto;padding:0 1em;max-width:62em;line-height:1.4}}\
             table{{border-collapse:collapse;font-size:.9em}}td,th{{border:1px solid #999;padding:.15em .5em;\
             text-align:right}}th{{background:#eee;vertical-align:bottom}}.name{{text-align:left}}\
             .wide{{overflow-x:auto}}figure{{margin:1.5em 0}}figcaption{{font-weight:bold}}\
             svg{{max-width:100%;height:auto}}.data{{font-size:.85em}}h2{{border-bottom:1px solid #999;\
             margin-top:2em}}</style><h1>Error against run time</h1>{introduction}\
             <ul>{}</ul>{}</html>",
            self.contents, self.body
        );
        std::fs::write(folder.join("report.html"), page)?;
        Ok(())
    }
}
