//! Tables on sheets.

use super::letters::width;
use super::{Anchor, Pen, Sheet};
use crate::page::Table;

const LEFT: f64 = 15.0;
const TOP: f64 = 12.0;
/// Letters, and the distance of lines \[mm\].
const LETTERS: f64 = 2.6;
const LINE: f64 = 4.4;
/// Room between columns \[mm\].
const GAP: f64 = 3.0;
/// Lowest line \[mm\].
const BOTTOM: f64 = 282.0;

/// Sheets of A4 with tables below each other, as many as it takes: the first column of a table is names, on the left, and
/// the others stand on the right of theirs. `lines` stand between the heading and the tables. Columns that are wider
/// than the sheet together get smaller letters.
#[must_use]
pub fn tables(title: &str, lines: &[String], tables: &[Table<'_>]) -> Vec<Sheet> {
    let mut first = Sheet::a4(title);
    let at = first.heading(LEFT, TOP, lines) + 3.0;
    let mut pages = Pages { title, sheets: Vec::new(), sheet: first, at };
    for table in tables {
        let columns = Columns::of(table);
        // The head is never alone at the foot of a sheet.
        pages.room_for(if table.title.is_empty() { 2.0 } else { 3.5 });
        if !table.title.is_empty() {
            pages.sheet.text([LEFT, pages.at + 0.5], 1.2 * LETTERS, Anchor::Start, table.title);
            pages.at += 1.5 * LINE;
        }
        pages.head(table, &columns);
        for row in table.rows {
            if pages.room_for(1.0) {
                pages.head(table, &columns);
            }
            columns.write(&mut pages.sheet, row, pages.at);
            pages.at += LINE;
        }
        pages.at += 1.5 * LINE;
    }
    let Pages { mut sheets, sheet, .. } = pages;
    sheets.push(sheet);
    sheets
}

/// How wide the columns of a table are.
struct Columns {
    widths: Vec<f64>,
    letters: f64,
}

impl Columns {
    fn of(table: &Table<'_>) -> Self {
        let columns = table.rows.iter().map(Vec::len).fold(table.head.len(), usize::max);
        let all = || core::iter::once(table.head).chain(table.rows.iter().map(Vec::as_slice));
        let widest = |column: usize| {
            let cells = all().filter_map(|row| row.get(column));
            cells.map(|cell| width(cell, LETTERS)).fold(0.0, f64::max) + GAP
        };
        let widths: Vec<f64> = (0..columns).map(widest).collect();
        let room = Sheet::a4("").size()[0] - 2.0 * LEFT;
        let shrunk = (room / widths.iter().sum::<f64>()).min(1.0);
        Self { widths: widths.into_iter().map(|wide| wide * shrunk).collect(), letters: LETTERS * shrunk }
    }

    fn write(&self, sheet: &mut Sheet, cells: &[String], at: f64) {
        let mut x = LEFT;
        for (column, (cell, wide)) in cells.iter().zip(&self.widths).enumerate() {
            let (place, anchor) = if column == 0 { (x, Anchor::Start) } else { (x + wide, Anchor::End) };
            sheet.text([place, at], self.letters, anchor, cell);
            x += wide;
        }
    }
}

/// The sheets that are full, the one that is written, and the place on it.
struct Pages<'a> {
    title: &'a str,
    sheets: Vec<Sheet>,
    sheet: Sheet,
    at: f64,
}

impl Pages<'_> {
    /// Begins another sheet where there is no room for so many lines; whether it did.
    fn room_for(&mut self, lines: f64) -> bool {
        let full = self.at + (lines - 1.0) * LINE > BOTTOM;
        if full {
            let mut sheet = Sheet::a4(&format!("{}, continued", self.title));
            self.at = sheet.heading(LEFT, TOP, &[]) + 3.0;
            self.sheets.push(core::mem::replace(&mut self.sheet, sheet));
        }
        full
    }

    fn head(&mut self, table: &Table<'_>, columns: &Columns) {
        columns.write(&mut self.sheet, table.head, self.at);
        let wide: f64 = columns.widths.iter().sum();
        self.sheet.line(Pen::Thin, [LEFT, self.at + 1.3], [LEFT + wide, self.at + 1.3]);
        self.at += LINE + 0.8;
    }
}
