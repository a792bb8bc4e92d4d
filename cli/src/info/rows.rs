//! What a CSV holds.

use fingertip_recordings::{ReaderOptions, Timing};

use super::{Info, columns};
use crate::error::CliError;
use crate::input::Input;
use crate::span::{Place, Span, Window};

pub(super) fn of(input: &mut Input, span: Span) -> Result<Info, CliError> {
    let mut reader = input.rows(ReaderOptions::default())?;
    let layout = reader.layout().clone();
    let mut info =
        Info { file: input.name(), format: "csv", columns: columns::of(&layout), ..Info::default() };
    span.needs_time(layout.has_time())?;
    info.notes.extend(span.note());
    let (mut window, mut timing) = (Window::new(span), Timing::default());
    while let Some(row) = reader.next_row()? {
        match window.place(row.time().unwrap_or(f64::NAN)) {
            Place::Before => continue,
            Place::Behind => break,
            Place::Within => {}
        }
        info.samples += 1;
        row.time().into_iter().for_each(|time| timing.add(time));
    }
    info.steps = (&timing).into();
    let quality = reader.quality();
    for left_out in layout.left_out() {
        info.notes.push(left_out.problem.to_string());
    }
    for (what, fault) in quality.faults() {
        if fault.count() > 0 {
            let lines: Vec<String> = fault.first_lines().iter().map(u64::to_string).collect();
            let more = if fault.count() > lines.len() as u64 { " …" } else { "" };
            info.notes.push(format!("{} {what} (line {}{more})", fault.count(), lines.join(", ")));
        }
    }
    Ok(info)
}
