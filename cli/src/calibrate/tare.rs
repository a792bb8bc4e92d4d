//! `fingertip tare`: a new zero for a calibration.

use fingertip_calibration::file::CalibrationFile;
use fingertip_calibration::loads::{Rest, signals_from_csv};
use fingertip_calibration::tare::Tared;

use super::args::TareArguments;
use super::files::{bad, cut, open, read_calibration};
use crate::error::CliError;
use crate::health::{of_table, seen};
use crate::output::Outputs;
use crate::table::{Table, number};

pub(crate) fn run(arguments: &TareArguments) -> Result<(), CliError> {
    // Writing over the calibration itself, with --overwrite, is what taring often means.
    let outputs = Outputs::guard(arguments.overwrite, "output", [&arguments.rest], [&arguments.output])?;
    let file = read_calibration(&arguments.calibration)?;
    let fault = |error: &dyn core::fmt::Display| bad(&arguments.rest, &error);
    let rest = signals_from_csv(open("recording", &arguments.rest)?).map_err(|error| fault(&error))?;
    let tared = file.tared_by_rest(&rest, arguments.celsius, arguments.accept_motion);
    let tared = tared.map_err(|error| fault(&error))?;
    let text = tared.file.to_toml().map_err(|error| fault(&error))?;
    outputs.write("calibration", &arguments.output, &text)?;
    let mut notes = tared.warnings.clone();
    notes.extend(seen(&of_table(&rest.signals, rest.unit, file.range)));
    notes.extend(rest.cut_line.map(|line| cut(&arguments.rest, line)));
    outputs.say(&said(&tared, &file, &rest), &notes)
}

/// What was taken, and how sure it is.
fn said(tared: &Tared, before: &CalibrationFile, rest: &Rest) -> String {
    let mut gauges = Table::new("Zeros", ["gauge", "zero", "moved by", "noise of one reading"]);
    let noise = tared.file.noise.as_deref().unwrap_or_default();
    for (gauge, ((zero, moved), noise)) in tared.file.zero.iter().zip(&tared.moved).zip(noise).enumerate() {
        let name = format!("{} {}", gauge + 1, rest.unit.name());
        gauges.row([name.trim_end().to_owned(), number(*zero), number(*moved), number(*noise)]);
    }
    let mut axes =
        Table::new("Loads", ["", "the old zero read", "noise of one reading", "ranged over", "unit"]);
    let loads = tared.load_before.iter().zip(&tared.load_noise).zip(&tared.load_range);
    for (axis, ((before, noise), range)) in before.axes.iter().zip(loads) {
        let unit = axis.unit().to_owned();
        axes.row([axis.to_string(), format!("{before:+.4}"), number(*noise), number(*range), unit]);
    }
    format!("Zero of {} readings at rest.\n\n{gauges}\n{axes}", tared.samples)
}
