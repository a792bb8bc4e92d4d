//! The files of a run, and what is said at its end.

use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;

use fingertip_recordings::{ReaderOptions, RecordingReader};
use fingertip_scene::Scene;
use indicatif::ProgressBar;

use super::args::AnalyzeArguments;
use super::progress::bar;
use crate::convert::McapAsCsv;
use crate::error::CliError;
use crate::output;
use crate::recording_file::Kind;
use crate::summary::Findings;

/// Refuses to write over what is read.
pub(super) fn guard(arguments: &AnalyzeArguments) -> Result<(), CliError> {
    let inputs = [
        Some(&arguments.recording),
        Some(&arguments.scene),
        arguments.calibration.as_ref(),
        arguments.payload.as_ref(),
    ];
    let inputs = || inputs.into_iter().flatten();
    output::guard("contacts file", inputs(), [&arguments.output])?;
    output::guard("report", inputs(), (!arguments.no_report).then_some(&arguments.report))
}

/// The rows of a recording, whichever way it was recorded.
pub(super) type Rows = RecordingReader<Box<dyn Read>>;

/// A recording that is read.
pub(super) struct Opened {
    pub(super) rows: Rows,
    /// How much of the file was read; of a pipe that cannot be told.
    pub(super) bar: ProgressBar,
}

/// Opens a recording. One of MCAP is read as what `convert` makes of it; what to know of that goes to `notes`.
pub(super) fn open(path: &Path, scene: &Scene, notes: &mut Vec<String>) -> Result<Opened, CliError> {
    let fault = |source| CliError::read("recording", path, source);
    let file = File::open(path).map_err(fault)?;
    let meta = file.metadata().map_err(fault)?;
    if meta.is_dir() {
        return Err(fault(io::ErrorKind::IsADirectory.into()));
    }
    let bar = bar(meta.is_file().then_some(meta.len()));
    let file = bar.wrap_read(file);
    let text: Box<dyn Read> = match Kind::of(path) {
        Ok(Kind::Mcap) => Box::new(McapAsCsv::new(BufReader::new(file), path, notes)?),
        _ => Box::new(file),
    };
    let options = ReaderOptions { renamed: scene.renamed_columns().to_vec(), ..ReaderOptions::default() };
    Ok(Opened { rows: Rows::with_options(path.display().to_string(), text, options)?, bar })
}

/// Prints what was found and what was written.
pub(super) fn say(findings: &Findings, to_stderr: bool, files: &[Option<&Path>]) -> Result<(), CliError> {
    let files: Vec<_> = files.iter().flatten().filter(|path| **path != Path::new("-")).collect();
    let mut text = findings.to_string();
    if !files.is_empty() {
        text.push_str(&format!("\n{}", output::written(files)));
    }
    if to_stderr {
        // If even the standard error is closed, there is nobody left to tell.
        let _ = io::stderr().write_all(text.as_bytes());
        return Ok(());
    }
    output::print(&text)
}
