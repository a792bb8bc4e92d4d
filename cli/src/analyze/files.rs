//! The files of a run, and what is said at its end.

use fingertip_recordings::ReaderOptions;
use fingertip_scene::Scene;

use super::args::AnalyzeArguments;
use crate::error::CliError;
use crate::output::Outputs;

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

/// How the recordings of a scene are read.
pub(super) fn of(scene: &Scene) -> ReaderOptions {
    let (renamed, header) = (scene.renamed_columns().to_vec(), scene.has_header());
    ReaderOptions { renamed, header, ..ReaderOptions::default() }
}
