//! `fingertip check`: a calibration on loads that it has not seen.

use fingertip_calibration::file::Verdict;
use fingertip_calibration::report::Report;

use super::args::CheckArguments;
use super::files::{bad, read_calibration, read_loads, read_payload, write_reports};
use super::limits;
use crate::error::CliError;
use crate::output::Outputs;
use crate::progress::working;
use crate::standard::shown;

/// An error if the calibration does not hold.
pub(crate) fn run(arguments: &CheckArguments) -> Result<(), CliError> {
    let inputs = [&arguments.calibration, &arguments.loads].into_iter().chain(&arguments.payload);
    let inputs = inputs.chain(&arguments.touches.scene);
    let paths = [arguments.html.as_ref(), arguments.json.as_ref()].into_iter().flatten();
    let outputs = Outputs::guard(arguments.overwrite, "output", inputs, paths)?;
    let mut file = read_calibration(&arguments.calibration)?;
    let mut notes = Vec::new();
    let mut table = read_loads(&arguments.loads, &mut notes)?;
    let fault = |error: &dyn core::fmt::Display| bad(&arguments.loads, &error);
    if let (None, Some(celsius)) = (&table.temperatures, arguments.celsius) {
        table.temperatures = Some(vec![celsius; table.samples()]);
    }
    let loaded = match &arguments.payload {
        Some(path) => {
            let payload = read_payload(path)?;
            Some(table.carrying(&payload, arguments.tare_groups).map_err(|error| fault(&error))?.loads)
        }
        None => None,
    };
    if arguments.tare_groups {
        if let Some(drift) = &file.temperature {
            let reason = format!(
                "the calibration drifts with temperature (reference {} °C): a tare by group would take part of \
                 that off; check without --tare-groups",
                drift.reference_celsius
            );
            return Err(fault(&reason));
        }
        table = table.tared_by_group().map_err(|error| fault(&error))?;
        file.zero.fill(0.0);
        // The range is that of untared readings.
        file.range = None;
    }
    if let Some(loads) = loaded {
        table.loads = loads;
    }
    let touches = arguments.touches.set(&file.axes, &file.nominal, &outputs)?;
    let check = || Report::of_check(&file, &table, &limits(arguments.limit), touches.as_ref());
    let report = working("compares", check).map_err(|error| fault(&error))?;
    let of = [
        ("serial number", file.provenance.serial.clone()),
        ("date of the calibration", file.provenance.date.clone()),
        ("calibration", shown(&arguments.calibration)),
        ("loads", shown(&arguments.loads)),
    ];
    write_reports(&report, "Check", &of, arguments.html.as_ref(), arguments.json.as_ref(), &outputs)?;
    outputs.say(&report.to_string(), &notes)?;
    if report.verdict == Verdict::Bad {
        return Err(CliError::DoesNotHold {
            calibration: arguments.calibration.clone(),
            loads: arguments.loads.clone(),
            reason: report.reasons.first().cloned().unwrap_or_default(),
        });
    }
    Ok(())
}
