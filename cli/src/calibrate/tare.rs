//! `fingertip tare`: a new zero for a calibration.

use super::args::TareArguments;
use super::files::{bad, open, read_calibration};
use crate::error::CliError;
use crate::output::{guard, say, write};

pub(crate) fn run(arguments: &TareArguments) -> Result<(), CliError> {
    // Writing over the calibration itself is what taring often means.
    guard("output", [&arguments.rest], [&arguments.output])?;
    let file = read_calibration(&arguments.calibration)?;
    let rest = open("recording", &arguments.rest)?;
    let tared = file.tared(rest, arguments.celsius).map_err(|error| bad(&arguments.rest, &error))?;
    let text = tared.file.to_toml().map_err(|error| bad(&arguments.rest, &error))?;
    write("calibration", &arguments.output, &text)?;
    let mut text = format!("Zero of {} readings at rest.\n", tared.samples);
    for (axis, load) in file.axes.iter().zip(&tared.load_before) {
        text.push_str(&format!("{axis}: the old zero read {load:+.4} {}\n", axis.unit()));
    }
    say(&text, &tared.warnings, core::slice::from_ref(&arguments.output))
}
