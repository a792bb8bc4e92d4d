//! `fingertip tare`: a new zero for a calibration.

use super::args::TareArguments;
use super::files::{bad, open, read_calibration};
use crate::error::CliError;
use crate::output::Outputs;

pub(crate) fn run(arguments: &TareArguments) -> Result<(), CliError> {
    // Writing over the calibration itself, with --overwrite, is what taring often means.
    let outputs = Outputs::guard(arguments.overwrite, "output", [&arguments.rest], [&arguments.output])?;
    let file = read_calibration(&arguments.calibration)?;
    let rest = open("recording", &arguments.rest)?;
    let tared = file.tared(rest, arguments.celsius).map_err(|error| bad(&arguments.rest, &error))?;
    let text = tared.file.to_toml().map_err(|error| bad(&arguments.rest, &error))?;
    outputs.write("calibration", &arguments.output, &text)?;
    let mut text = format!("Zero of {} readings at rest.\n", tared.samples);
    for (axis, load) in file.axes.iter().zip(&tared.load_before) {
        text.push_str(&format!("{axis}: the old zero read {load:+.4} {}\n", axis.unit()));
    }
    outputs.say(&text, &tared.warnings)
}
