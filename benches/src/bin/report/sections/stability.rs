//! The matrix of stress cases and routines, large.

use super::Part;
use crate::Failure;
use crate::page::Page;
use crate::stability::all;
use crate::stability::matrix::Row;
use crate::table::{Table, shown};
use crate::timing::Effort;

/// The routine without the shape or kind after the first comma.
fn room(row: &Row) -> &str {
    row.routine.split(',').next().unwrap_or(&row.routine)
}

/// All rows, those beyond their bounds, and one row a routine.
struct Tables {
    all: Table,
    bad: Table,
    short: Table,
}

fn tables(rows: &[Row]) -> Tables {
    let mut all = Table::new(&[
        "routine",
        "case",
        "scalar",
        "trials",
        "worst over bound",
        "failures",
        "NaN",
        "most iterations",
        "note",
    ]);
    let mut bad = Table::new(&["routine", "case", "scalar", "worst over bound", "failures", "of", "NaN"]);
    let mut rooms: Vec<(&str, [usize; 4], f64)> = Vec::new();
    for row in rows {
        all.row([
            row.routine.clone(),
            row.case.clone(),
            row.scalar.to_owned(),
            row.trials.to_string(),
            shown(row.worst),
            row.failures.to_string(),
            row.nan.to_string(),
            row.iterations.map_or_else(|| "-".to_owned(), |n| n.to_string()),
            row.note.clone(),
        ]);
        let index = rooms.iter().position(|r| r.0 == room(row)).unwrap_or_else(|| {
            rooms.push((room(row), [0; 4], 0.0));
            rooms.len() - 1
        });
        let (_, counts, worst) = &mut rooms[index];
        counts[0] += 1;
        counts[1] += row.trials;
        counts[2] += usize::from(!row.good());
        counts[3] += row.nan;
        if row.good() {
            *worst = worst.max(row.worst);
        } else {
            bad.row([
                row.routine.clone(),
                row.case.clone(),
                row.scalar.to_owned(),
                shown(row.worst),
                row.failures.to_string(),
                row.trials.to_string(),
                row.nan.to_string(),
            ]);
        }
    }
    let mut short = Table::new(&[
        "routine",
        "rows",
        "trials",
        "rows beyond their bound",
        "NaN",
        "worst over bound of the others",
    ]);
    for (room, counts, worst) in rooms {
        let [rows, trials, broken, nan] = counts.map(|n| n.to_string());
        short.row([room.to_owned(), rows, trials, broken, nan, shown(worst)]);
    }
    Tables { all, bad, short }
}

pub(crate) fn report(page: &mut Page, effort: Effort) -> Result<Part, Failure> {
    page.heading("Stability: every routine under every stress case");
    page.say(
        "The greatest error over its bound: what a backward stable routine keeps, a small multiple of the \
         rounding unit times the conditioning of the case, or an invariant of the law; one or less is good. \
         Failures are answers of the wrong kind: none where there is one, or one where there is none. The \
         test `stability` of the root crate runs the same table with fewer draws.",
    );
    let rows = all(effort.choose(2, 60));
    let Tables { all: table, bad, short } = tables(&rows);
    page.table(&short);
    let mut said = short.markdown();
    if bad.rows().is_empty() {
        said += "\nNo row is beyond its bound.\n";
    } else {
        page.subheading("Beyond their bounds");
        page.table(&bad);
        said += &format!("\nBeyond their bounds, and so to be mended:\n\n{}", bad.markdown());
    }
    page.subheading("All rows");
    page.table(&without_notes(&rows));
    page.data("stability", &table);
    Ok(("Stability".to_owned(), said))
}

/// What fits on the page; the file has the rest.
fn without_notes(rows: &[Row]) -> Table {
    let mut table =
        Table::new(&["routine", "case", "scalar", "worst over bound", "failures", "NaN", "iterations"]);
    for row in rows {
        table.row([
            row.routine.clone(),
            row.case.clone(),
            row.scalar.to_owned(),
            shown(row.worst),
            row.failures.to_string(),
            row.nan.to_string(),
            row.iterations.map_or_else(|| "-".to_owned(), |n| n.to_string()),
        ]);
    }
    table
}
