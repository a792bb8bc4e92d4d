//! The files of a run, and what is said at its end.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

use crate::args::AnalyzeArguments;
use crate::error::CliError;
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

/// Opens a recording, and tells its length if it has one (a pipe has none).
pub(super) fn open(path: &Path) -> io::Result<(File, Option<u64>)> {
    let file = File::open(path)?;
    let meta = file.metadata()?;
    if meta.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    Ok((file, meta.is_file().then_some(meta.len())))
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
