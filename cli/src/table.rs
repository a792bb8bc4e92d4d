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
    use super::{Table, count, number, number_or_dash, percent, short};

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

    #[test]
    fn a_number_has_three_digits_whatever_its_size() {
        // Each read back is within half a unit of its third digit.
        for decade in -12..12_i32 {
            for lead in [1.0, 1.234_5, 4.996, 9.94, 9.949_9] {
                for sign in [1.0, -1.0] {
                    let value = sign * lead * 10.0_f64.powi(decade);
                    let text = number(value);
                    let read: f64 = text.parse().unwrap();
                    assert!((read - value).abs() <= 0.500_001 * 10.0_f64.powi(decade - 2), "{value}: {text}");
                    assert_eq!(text.contains('e'), !(-3..5).contains(&decade), "{value}: {text}");
                    if !text.contains('e') && decade < 3 {
                        let digits = text.chars().filter(char::is_ascii_digit).collect::<String>();
                        assert_eq!(digits.trim_start_matches('0').len(), 3, "{value}: {text}");
                    }
                    assert_eq!(short(value).parse::<f64>().unwrap(), read, "{value}: {}", short(value));
                    assert!(
                        !short(value).ends_with(['.'])
                            && (short(value).contains('e')
                                || !short(value).contains('.')
                                || !short(value).ends_with('0')),
                        "{value}: {}",
                        short(value)
                    );
                }
            }
        }
        assert_eq!([100.0, 10.0, 2.5, 0.0, 1e5].map(short), ["100", "10", "2.5", "0", "1.00e5"]);
        assert_eq!((number_or_dash(None), number_or_dash(Some(2.0))), ("–".to_owned(), "2.00".to_owned()));
        assert_eq!(
            [0, 7, 999, 1000, 999_999, 1_000_000].map(count),
            ["0", "7", "999", "1\u{202f}000", "999\u{202f}999", "1\u{202f}000\u{202f}000"]
        );
    }

    #[test]
    fn shares_are_exact_where_it_matters() {
        for (part, whole, expected) in [
            (0, 0, "–"),
            (1, 10_000, "0.01 %"),
            (1, 10_001, "<0.01 %"),
            (9_999, 10_000, "99.99 %"),
            (10_000, 10_001, ">99.99 %"),
            (1, 2, "50.00 %"),
            (5, 5, "100 %"),
        ] {
            assert_eq!(percent(part, whole), expected);
        }
    }

    #[test]
    fn rows_of_other_lengths_and_empty_ones_are_no_trouble() {
        let mut table = Table::new("T", ["", ""]);
        table.row(["long name".to_owned(), "1".to_owned(), "µ2".to_owned()]);
        table.row(["x".to_owned(), String::new()]);
        table.row([String::new(), "12".to_owned()]);
        assert_eq!(table.to_string(), "T\n  long name   1  µ2\n  x\n             12\n");
    }
}
