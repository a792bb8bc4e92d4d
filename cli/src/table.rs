//! A small table, for the terminal and for the report.

use core::fmt;

/// Words on top, numbers below; the first column is a name.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    pub(crate) title: String,
    pub(crate) head: Vec<String>,
    pub(crate) rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn new<const N: usize>(title: &str, head: [&str; N]) -> Self {
        Self { title: title.to_owned(), head: head.map(str::to_owned).to_vec(), rows: Vec::new() }
    }

    pub(crate) fn row<const N: usize>(&mut self, cells: [String; N]) {
        self.rows.push(cells.to_vec());
    }
}

impl fmt::Display for Table {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = || core::iter::once(&self.head).chain(&self.rows);
        let columns = lines().map(Vec::len).max().unwrap_or(0);
        let width = |column: usize| {
            lines().filter_map(|line| line.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        writeln!(out, "{}", self.title)?;
        for line in lines().filter(|line| line.iter().any(|cell| !cell.is_empty())) {
            let mut text = String::from(" ");
            for (column, (cell, width)) in line.iter().zip(&widths).enumerate() {
                text.push_str(&if column == 0 {
                    format!(" {cell:<width$}")
                } else {
                    format!("  {cell:>width$}")
                });
            }
            writeln!(out, "{}", text.trim_end())?;
        }
        Ok(())
    }
}

/// A number with three significant digits, in the shortest form that a reader expects.
pub(crate) fn number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e5).contains(&magnitude) {
        format!("{value:.2e}")
    } else if magnitude >= 100.0 {
        format!("{value:.0}")
    } else if magnitude >= 10.0 {
        format!("{value:.1}")
    } else if magnitude >= 1.0 {
        format!("{value:.2}")
    } else if magnitude >= 0.1 {
        format!("{value:.3}")
    } else if magnitude >= 0.01 {
        format!("{value:.4}")
    } else {
        format!("{value:.5}")
    }
}

/// As [`number`], without zeros at the end.
pub(crate) fn short(value: f64) -> String {
    let text = number(value);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// A number that may be missing.
pub(crate) fn number_or_dash(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), number)
}

/// A count with thin groups of three digits.
pub(crate) fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// A share of a whole in percent; the whole and nothing are said only where they are exact.
pub(crate) fn percent(part: u64, whole: u64) -> String {
    if whole == 0 {
        return "–".to_owned();
    }
    let share = 100.0 * part as f64 / whole as f64;
    if part > 0 && share < 0.01 {
        "<0.01 %".to_owned()
    } else if part < whole && share > 99.99 {
        ">99.99 %".to_owned()
    } else if part == 0 || part == whole {
        format!("{share:.0} %")
    } else {
        format!("{share:.2} %")
    }
}

#[cfg(test)]
mod tests {
    use super::{Table, count, number, percent};

    #[test]
    fn lines_up_its_columns() {
        let mut table = Table::new("Forces", ["", "median", "95 %"]);
        table.row(["normal".to_owned(), "1.00".to_owned(), "12.5".to_owned()]);
        assert_eq!(table.to_string(), "Forces\n          median  95 %\n  normal    1.00  12.5\n");
    }

    #[test]
    fn numbers_are_short_and_shares_never_round_to_the_whole() {
        let written = [0.0, 1.0, -12.34, 0.02134, 123_456.0, 1e-7, 0.00123].map(number);
        assert_eq!(written, ["0", "1.00", "-12.3", "0.0213", "1.23e5", "1.00e-7", "0.00123"]);
        assert_eq!(count(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!(percent(9_999_999, 10_000_000), ">99.99 %");
        assert_eq!(percent(1, 10_000_000), "<0.01 %");
        assert_eq!(
            (percent(3, 3), percent(0, 3), percent(1, 3)),
            ("100 %".into(), "0 %".into(), "33.33 %".into())
        );
    }
}
