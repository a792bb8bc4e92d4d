//! The files of a run, and what is said at its end.

use std::io::Read;

use fingertip_recordings::{ReaderOptions, RecordingReader};
use fingertip_scene::Scene;
use indicatif::ProgressBar;

use super::args::AnalyzeArguments;
use crate::convert::McapAsCsv;
use crate::error::CliError;
use crate::input::Input;
use crate::output::Outputs;
use crate::progress::bar;
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
pub(super) type Rows = RecordingReader<Box<dyn Read + Send>>;

/// A recording that is read.
pub(super) struct Opened {
    pub(super) rows: Rows,
    /// How much of the file was read; of a pipe that cannot be told.
    pub(super) bar: ProgressBar,
}

/// How the recordings of a scene are read.
pub(super) fn of(scene: &Scene) -> ReaderOptions {
    ReaderOptions { renamed: scene.renamed_columns().to_vec(), ..ReaderOptions::default() }
}

/// Opens a recording. One of MCAP is read as what `convert` makes of it; what to know of that goes to `notes`.
pub(super) fn open(
    arguments: &AnalyzeArguments,
    options: ReaderOptions,
    notes: &mut Vec<String>,
) -> Result<Opened, CliError> {
    let mut input = Input::open(&arguments.recording)?;
    let bar = bar(input.length());
    let text: Box<dyn Read + Send> = match input.kind() {
        Kind::Mcap => {
            let file = bar.wrap_read(input.messages()?);
            Box::new(McapAsCsv::new(file, &input, &arguments.topics, notes)?)
        }
        Kind::Csv => Box::new(bar.wrap_read(input.text()?)),
    };
    Ok(Opened { rows: Rows::with_options(input.name(), text, options)?, bar })
}
