//! One cell of a row.

use crate::layout::UsedColumn;
use crate::plain::read_plain;
use crate::quality::Quality;
use crate::record::Record;
use crate::row::RowMarks;

/// What stands in a cell.
pub(super) enum Cell {
    Number(f64),
    NotFinite,
    Empty,
    Text,
}

impl Cell {
    #[inline]
    pub(super) fn read(record: &Record, used: UsedColumn) -> Self {
        let Some((cell, window)) = record.cell(used.column) else { return Self::Empty };
        match read_plain(cell, window) {
            Some(number) => Self::finite(number * used.scale),
            None => Self::read_whole(cell, used.scale),
        }
    }

    /// Any cell: numbers with an exponent or of many digits, and what is no number.
    #[inline(never)]
    fn read_whole(cell: &[u8], scale: f64) -> Self {
        // The whole cell first: cells with blanks around the number are rare.
        match fast_float2::parse::<f64, _>(cell) {
            Ok(number) => Self::finite(number * scale),
            Err(_) => Self::unusual(cell.trim_ascii(), scale),
        }
    }

    fn finite(number: f64) -> Self {
        if number.is_finite() { Self::Number(number) } else { Self::NotFinite }
    }

    #[cold]
    fn unusual(cell: &[u8], scale: f64) -> Self {
        let missing: [&[u8]; 5] = [b"", b"na", b"n/a", b"null", b"none"];
        if missing.iter().any(|text| cell.eq_ignore_ascii_case(text)) {
            return Self::Empty;
        }
        fast_float2::parse::<f64, _>(cell).map_or(Self::Text, |number| Self::finite(number * scale))
    }

    /// Counts a cell without a number, whose value is then NaN; `None` for text.
    pub(super) fn count(&self, line: u64, marks: &mut RowMarks, quality: &mut Quality) -> Option<f64> {
        match self {
            Self::Number(number) => return Some(*number),
            Self::Text => return None,
            Self::Empty => {
                marks.empty = true;
                quality.empty_cells.add(line);
            }
            Self::NotFinite => {
                marks.not_finite = true;
                quality.not_finite_cells.add(line);
            }
        }
        Some(f64::NAN)
    }
}
