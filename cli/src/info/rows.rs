//! What a CSV holds.

use fingertip_recordings::ReaderOptions;

use super::{Info, columns};
use crate::error::CliError;
use crate::input::Input;

pub(super) fn of(input: &mut Input) -> Result<Info, CliError> {
    let mut reader = input.rows(ReaderOptions::default())?;
    let layout = reader.layout().clone();
    let mut info =
        Info { file: input.name(), format: "csv", columns: columns::of(&layout), ..Info::default() };
    while reader.next_row()?.is_some() {}
    info.steps = reader.timing().into();
    let quality = reader.quality();
    info.samples = quality.rows;
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
