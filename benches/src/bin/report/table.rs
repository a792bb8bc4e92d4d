//! A table that can be read by people and by programs.

/// Headings and rows of cells.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn new(head: &[&str]) -> Self {
        Self { head: head.iter().map(|cell| (*cell).to_owned()).collect(), rows: Vec::new() }
    }

    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    pub(crate) fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    pub(crate) fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let mut text = line(&self.head);
        text += &format!("|{}\n", "---|".repeat(self.head.len()));
        self.rows.iter().for_each(|row| text += &line(row));
        text
    }

    pub(crate) fn csv(&self) -> String {
        let line = |cells: &[String]| {
            let quoted: Vec<String> = cells
                .iter()
                .map(|cell| {
                    if cell.contains([',', '"']) {
                        format!("\"{}\"", cell.replace('"', "\"\""))
                    } else {
                        cell.clone()
                    }
                })
                .collect();
            quoted.join(",") + "\n"
        };
        self.rows.iter().fold(line(&self.head), |text, row| text + &line(row))
    }

    /// As a page shows it.
    pub(crate) fn on_page(&self) -> fingertip_calibration::page::Table<'_> {
        fingertip_calibration::page::Table { title: "", head: &self.head, rows: &self.rows, words: true }
    }
}

/// A figure in as many digits as it is worth.
pub(crate) fn shown(x: f64) -> String {
    if x.is_nan() {
        "-".to_owned()
    } else if x == 0.0 || (0.1..1e4).contains(&x.abs()) {
        let digits = if x.abs() >= 100.0 {
            0
        } else if x.abs() >= 10.0 {
            1
        } else {
            2
        };
        format!("{x:.digits$}")
    } else if x.is_infinite() {
        "diverges".to_owned()
    } else {
        format!("{x:.1e}")
    }
}
