//! The report: headings, paragraphs, tables and diagrams, as a page and as files.

use std::path::Path;

use fingertip_calibration::page::{self, Figure};

use crate::Failure;
use crate::multiples::Group;
use crate::plots::Diagram;
use crate::table::Table;

/// The report in the order in which it was said.
#[derive(Default)]
pub(crate) struct Page {
    parts: Vec<Part>,
    files: Vec<(String, String)>,
    groups: Vec<Group>,
}

enum Part {
    Heading(String),
    Subheading(String),
    Paragraph(String),
    Table(Table),
    Data(String),
    Diagram(Figure),
}

impl Page {
    pub(crate) fn heading(&mut self, text: &str) {
        self.parts.push(Part::Heading(text.to_owned()));
        self.groups.push((text.to_owned(), Vec::new()));
    }

    pub(crate) fn subheading(&mut self, text: &str) {
        self.parts.push(Part::Subheading(text.to_owned()));
    }

    pub(crate) fn say(&mut self, paragraph: &str) {
        self.parts.push(Part::Paragraph(paragraph.to_owned()));
    }

    /// Shows a table.
    pub(crate) fn table(&mut self, table: &Table) {
        self.parts.push(Part::Table(table.clone()));
    }

    /// Keeps a table as a file beside the page.
    pub(crate) fn data(&mut self, name: &str, table: &Table) {
        let file = format!("{name}.csv");
        self.files.push((file.clone(), table.csv()));
        self.parts.push(Part::Data(file));
    }

    pub(crate) fn diagram(&mut self, name: &str, diagram: &Diagram) -> Result<(), Failure> {
        if let Some((_, diagrams)) = self.groups.last_mut() {
            diagrams.push(diagram.clone());
        }
        let svg = diagram.svg()?;
        self.files.push((format!("{name}.svg"), svg.clone()));
        let title = diagram.title.to_string();
        self.parts.push(Part::Diagram(Figure { title, svg, on_white: true, ..Figure::default() }));
        Ok(())
    }

    /// The diagrams of each part.
    pub(crate) fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// Writes the page, its diagrams and its data.
    pub(crate) fn write(&self, folder: &Path, introduction: &str) -> Result<(), Failure> {
        for (name, text) in &self.files {
            std::fs::write(folder.join(name), text)?;
        }
        let mut page = page::Page::new("Error against run time");
        page.paragraph(introduction);
        page.contents(self.parts.iter().filter_map(|part| match part {
            Part::Heading(text) => Some(text.as_str()),
            _ => None,
        }));
        for part in &self.parts {
            match part {
                Part::Heading(text) => page.heading(text),
                Part::Subheading(text) => page.subheading(text),
                Part::Paragraph(text) => page.paragraph(text),
                Part::Table(table) => page.table(&table.on_page()),
                Part::Data(file) => page.link("Data: ", file),
                Part::Diagram(figure) => page.figure(figure),
            }
        }
        std::fs::write(folder.join("report.html"), page.finish(""))?;
        Ok(())
    }
}
