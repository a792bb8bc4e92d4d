//! The files of a run, and what is said at its end.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use fingertip_recordings::{ReaderOptions, RecordingReader};
use fingertip_scene::Scene;
use indicatif::ProgressBar;

use super::args::AnalyzeArguments;
use super::progress::bar;
use crate::convert::McapAsCsv;
use crate::error::CliError;
use crate::output::Outputs;
use crate::recording_file::Kind;

/// Refuses to write over what is read.
pub(super) fn guard(arguments: &AnalyzeArguments) -> Result<Outputs, CliError> {
    let inputs = [
        Some(&arguments.recording),
        Some(&arguments.scene),
        arguments.calibration.as_ref(),
        arguments.payload.as_ref(),
    ];
    let report = (!arguments.no_report).then_some(&arguments.report);
    let outputs = core::iter::once(&arguments.output).chain(report);
    Outputs::guard(arguments.overwrite, "output", inputs.into_iter().flatten(), outputs)
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
