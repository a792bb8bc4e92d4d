//! The files of a run, and what is said at its end.

use std::path::PathBuf;

use fingertip_recordings::ReaderOptions;
use fingertip_scene::Scene;

use super::args::AnalyzeArguments;
use crate::error::CliError;
use crate::output::Outputs;
use crate::several::file_of;
use crate::standard::is_standard;

/// The files that one recording writes.
#[derive(Debug)]
pub(super) struct Files {
    pub(super) output: PathBuf,
    /// `None` if there is to be none.
    pub(super) report: Option<PathBuf>,
    pub(super) outputs: Outputs,
}

impl Files {
    /// Of each recording. Refuses to write over what is read, of which there is `more` than the command line names, and
    /// twice into one file.
    pub(super) fn of(arguments: &AnalyzeArguments, more: &[&PathBuf]) -> Result<Vec<Self>, CliError> {
        let recordings = &arguments.recordings;
        if recordings.len() > 1 && is_standard(&arguments.output) {
            return Err(CliError::SharedStdout);
        }
        let named = |recording: &PathBuf| {
            let report = || file_of(recording, recordings, &arguments.report);
            let output = file_of(recording, recordings, &arguments.output);
            (output, (!arguments.no_report).then(report))
        };
        let all: Vec<(PathBuf, Option<PathBuf>)> = recordings.iter().map(named).collect();
        let options = [Some(&arguments.scene), arguments.calibration.as_ref(), arguments.payload.as_ref()];
        let inputs = recordings.iter().chain(options.into_iter().flatten()).chain(more.iter().copied());
        let every = all.iter().flat_map(|(output, report)| core::iter::once(output).chain(report));
        let outputs = Outputs::guard(arguments.overwrite, "output", inputs, every)?;
        let files = |(output, report)| Self { output, report, outputs: outputs.part() };
        Ok(all.into_iter().map(files).collect())
    }
}

/// Refuses to write over what a scene names.
pub(super) fn spare(all: &[Files], scene: &Scene) -> Result<(), CliError> {
    // All have the outputs of all.
    all.first().map_or(Ok(()), |files| files.outputs.spare(scene.files()))
}

/// How the recordings of a scene are read.
pub(super) fn of(scene: &Scene) -> ReaderOptions {
    let (renamed, header) = (scene.renamed_columns().to_vec(), scene.has_header());
    ReaderOptions { renamed, header, ..ReaderOptions::default() }
}
