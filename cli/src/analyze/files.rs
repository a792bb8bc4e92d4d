//! The files of a run, and what is said at its end.

use std::fs::{self, File};
use std::io::{self, Cursor, Read, Write};
use std::path::Path;

use fingertip_drivers::recording::RecordingReader;

use crate::args::AnalyzeArguments;
use crate::convert::from_mcap::to_csv;
use crate::error::CliError;
use crate::record::output::Kind;
use crate::summary::Findings;

/// Refuses to write over what is read.
pub(super) fn guard(arguments: &AnalyzeArguments) -> Result<(), CliError> {
    let inputs = [
        Some(&arguments.recording),
        Some(&arguments.scene),
        arguments.calibration.as_ref(),
        arguments.payload.as_ref(),
    ];
    let report = (!arguments.no_report).then_some(&arguments.report);
    for (what, output) in [("contacts file", Some(&arguments.output)), ("report", report)] {
        let Some(output) = output else { continue };
        let Ok(place) = fs::canonicalize(output) else { continue };
        // A device may well be read and written.
        let file = fs::metadata(&place).is_ok_and(|meta| meta.is_file());
        let read =
            inputs.iter().flatten().any(|input| fs::canonicalize(input).is_ok_and(|input| input == place));
        if file && read {
            return Err(CliError::WouldOverwrite { what, path: output.clone() });
        }
    }
    Ok(())
}

/// The rows of a recording, whichever way it was recorded.
pub(super) type Rows = RecordingReader<Box<dyn Read>>;

/// Opens a recording, and tells its length if it has one (a pipe has none). One of MCAP is read as what
/// `convert` makes of it; what to know of that goes to `notes`.
pub(super) fn open(path: &Path, notes: &mut Vec<String>) -> Result<(Rows, Option<u64>), CliError> {
    let name = path.display().to_string();
    if matches!(Kind::of(path), Ok(Kind::Mcap)) {
        let (rows, account) = to_csv(path, path, || Ok(Vec::new()))?;
        notes.extend(account.notes);
        let length = rows.len() as u64;
        return Ok((Rows::new(name, Box::new(Cursor::new(rows)))?, Some(length)));
    }
    let fault = |source| CliError::read("recording", path, source);
    let file = File::open(path).map_err(fault)?;
    let meta = file.metadata().map_err(fault)?;
    if meta.is_dir() {
        return Err(fault(io::ErrorKind::IsADirectory.into()));
    }
    let length = meta.is_file().then_some(meta.len());
    Ok((Rows::new(name, Box::new(file))?, length))
}

/// Prints what was found and what was written.
pub(super) fn say(findings: &Findings, to_stderr: bool, written: &[Option<&Path>]) -> Result<(), CliError> {
    let written = written.iter().flatten().filter(|path| **path != Path::new("-"));
    let list: Vec<String> = written.map(|path| path.display().to_string()).collect();
    let mut text = findings.to_string();
    if !list.is_empty() {
        text.push_str(&format!("\nWritten: {}\n", list.join(", ")));
    }
    if to_stderr {
        // If even the standard error is closed, there is nobody left to tell.
        let _ = io::stderr().write_all(text.as_bytes());
        return Ok(());
    }
    let mut stdout = io::stdout();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(CliError::stdout)
}
