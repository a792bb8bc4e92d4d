//! `fingertip calibrate`, `check` and `tare`: files to files, by `fingertip-calibration`.

pub(crate) mod args;
pub(crate) mod check;
pub(crate) mod files;
mod gravity;
pub(crate) mod import;
mod inertial;
mod inertial_args;
mod stream;
pub(crate) mod tare;
mod touches;
mod watched;

use std::path::{Path, PathBuf};

use fingertip_calibration::calibrate_taking as fit;
use fingertip_calibration::file::{AtiCalibration, CalibrationFile, Scalar, Verdict};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Direction, Limits, Method, Options};

use crate::error::CliError;
use crate::health::{of_table, seen_in_loads};
use crate::output::Outputs;
use crate::progress::working;
use crate::standard::shown;
use args::{CalibrateArguments, CurvatureChoice, FitMethod};
use files::{bad, read_calibration, read_payload, write_reports};

/// `fingertip calibrate`.
pub(crate) fn calibrate(arguments: &CalibrateArguments) -> Result<(), CliError> {
    if let Some(poses) = &arguments.gravity {
        return gravity::run(poses, arguments);
    }
    if let Some(motion) = &arguments.inertial.inertial {
        return inertial::run(motion, arguments);
    }
    let output = arguments.output.clone().unwrap_or_else(|| "calibration.toml".into());
    let paths = [Some(&output), arguments.html.as_ref(), arguments.json.as_ref()];
    let extra = [arguments.cal.as_ref(), arguments.rust.as_ref()];
    let paths = paths.into_iter().chain(extra).flatten();
    let inputs = arguments.loads.iter().chain(&arguments.prior).chain(&arguments.payload);
    let inputs = inputs.chain(&arguments.touches.scene);
    let outputs = Outputs::guard(arguments.overwrite, "output", inputs, paths)?;
    if arguments.stream {
        return stream::run(arguments, &output, &outputs);
    }
    let mut notes = Vec::new();
    let (mut sessions, mut health) = (Vec::with_capacity(arguments.loads.len()), None);
    for path in &arguments.loads {
        let (table, seen) = watched::read(path, range(arguments), &mut notes)?;
        sessions.push(table);
        health = seen;
    }
    let first = arguments.loads.first().cloned().unwrap_or_default();
    let fault = |error: &dyn core::fmt::Display| bad(&first, &error);
    let mut table = match sessions.pop() {
        // One is all, and may be large.
        Some(only) if sessions.is_empty() => only,
        last => {
            sessions.extend(last);
            LoadTable::merged(&sessions).map_err(|error| fault(&error))?
        }
    };
    // Of several files all readings follow each other.
    let health = health.filter(|_| arguments.loads.len() == 1);
    let health = health.unwrap_or_else(|| of_table(&table.signals, table.signal_unit, range(arguments)));
    notes.extend(seen_in_loads(&health));
    if let Some(path) = &arguments.payload {
        let payload = read_payload(path)?;
        table.loads = table.carrying(&payload, false).map_err(|error| fault(&error))?.loads;
    }
    let (table, unloaded) = table.of_loaded_axes();
    if !unloaded.is_empty() {
        let names: Vec<String> = unloaded.iter().map(ToString::to_string).collect();
        let names = names.join(", ");
        notes.push(format!(
            "{names}: no load has any, so the calibration is for the other components alone; under such a load it reads falsely"
        ));
    }
    let options = options(arguments, &table, &outputs)?;
    let calibration = working("fits", || fit(table, &options)).map_err(|error| fault(&error))?;
    let file = calibration.to_file().map_err(|error| fault(&error))?;
    write_calibration(file, arguments, &output, &outputs)?;
    let title = if arguments.serial.is_empty() { "Calibration" } else { &arguments.serial };
    let loads: Vec<String> = arguments.loads.iter().map(|path| shown(path)).collect();
    let of = [
        ("serial number", arguments.serial.clone()),
        ("date", arguments.date.clone()),
        ("loads", loads.join(", ")),
        ("calibration", output.display().to_string()),
    ];
    let (html, json) = (arguments.html.as_ref(), arguments.json.as_ref());
    write_reports(&calibration.report, title, &of, html, json, &outputs)?;
    if calibration.report.verdict == Verdict::Suspect {
        notes.push(
            "suspect until somebody has looked: repeat the readings named above, or leave them out by \
             --reject-outliers"
                .to_owned(),
        );
    }
    if calibration.report.curve.as_ref().is_some_and(|curve| !curve.taken) {
        notes.push("--curvature chosen fits terms of higher order, too".to_owned());
    }
    outputs.say(&calibration.report.to_string(), &notes)?;
    let report = &calibration.report;
    refuse_bad(arguments, &output, report.verdict, &report.reasons)
}

/// An error for a calibration that is bad, unless the user takes it as it is. The files are written: they say so.
fn refuse_bad(
    arguments: &CalibrateArguments,
    output: &Path,
    verdict: Verdict,
    reasons: &[String],
) -> Result<(), CliError> {
    if verdict != Verdict::Bad || arguments.accept_bad {
        return Ok(());
    }
    let reason = reasons.first().cloned().unwrap_or_default();
    Err(CliError::BadCalibration { path: output.to_owned(), reason })
}

/// Writes the calibration in every form that was asked for.
fn write_calibration(
    mut file: CalibrationFile,
    arguments: &CalibrateArguments,
    output: &Path,
    outputs: &Outputs,
) -> Result<(), CliError> {
    let first = arguments.loads.first().cloned().unwrap_or_default();
    let fault = |error: &dyn core::fmt::Display| bad(&first, &error);
    file.provenance.serial.clone_from(&arguments.serial);
    file.provenance.date.clone_from(&arguments.date);
    let sources: Vec<String> = arguments.loads.iter().map(|path| shown(path)).collect();
    file.provenance.source = sources.join(", ");
    file.range = range(arguments);
    outputs.write("calibration", output, &file.to_toml().map_err(|error| fault(&error))?)?;
    if let Some(path) = &arguments.cal {
        let ati = AtiCalibration::from_calibration(&file).map_err(|error| fault(&error))?;
        outputs.write(".cal file", path, &ati.to_xml())?;
    }
    if let Some(path) = &arguments.rust {
        outputs.write("Rust file", path, &file.to_rust(Scalar::F32).map_err(|error| fault(&error))?)?;
    }
    Ok(())
}

fn range(arguments: &CalibrateArguments) -> Option<[f64; 2]> {
    arguments.range.as_deref().and_then(|range| <[f64; 2]>::try_from(range).ok())
}

fn options(
    arguments: &CalibrateArguments,
    table: &LoadTable,
    outputs: &Outputs,
) -> Result<Options, CliError> {
    let full_scale = arguments.full_scale.clone().unwrap_or_else(|| table.greatest_loads());
    Ok(Options {
        direction: if arguments.inverse || arguments.curvature != CurvatureChoice::Straight {
            Direction::LoadsFromSignals
        } else {
            Direction::SignalsFromLoads
        },
        bias: !arguments.no_bias,
        curvature: arguments.curvature.into(),
        method: method(arguments, table)?,
        nominal: arguments.full_scale.clone(),
        range: range(arguments),
        tare_groups: arguments.tare_groups,
        reference_celsius: arguments.reference_celsius,
        creep: arguments.creep,
        reject_outliers: arguments.reject_outliers,
        touches: arguments.touches.set(&table.axes, &full_scale, outputs)?,
        limits: limits(arguments.limit),
    })
}

fn method(arguments: &CalibrateArguments, table: &LoadTable) -> Result<Method, CliError> {
    let first = arguments.loads.first().map_or(Path::new(""), PathBuf::as_path);
    let wrong = |option: &str, needed: String| {
        Err(bad(first, &format!("{option} must have {needed}, all positive numbers")))
    };
    let axes = &table.axes;
    let load_error = arguments.load_error.as_deref().unwrap_or_default();
    let load_deviations: Vec<f64> = match load_error {
        // Two: forces and torques.
        [force, torque] if axes.len() > 2 => {
            axes.iter().map(|axis| if axis.is_torque() { *torque } else { *force }).collect()
        }
        [force] if axes.iter().all(|axis| !axis.is_torque()) => vec![*force; axes.len()],
        list => list.to_vec(),
    };
    let reading_error = arguments.reading_error.as_deref().unwrap_or_default();
    let signal_deviations = match reading_error {
        [one] => vec![*one; table.gauges()],
        list => list.to_vec(),
    };
    let uncertain = matches!(arguments.method, FitMethod::Total | FitMethod::GaussHelmert);
    let positive = |list: &[f64], length| list.len() == length && list.iter().all(|x| *x > 0.0);
    if uncertain && !positive(&load_deviations, axes.len()) {
        return wrong("--load-error", format!("2 numbers (forces, torques) or {}", axes.len()));
    }
    if uncertain && !positive(&signal_deviations, table.gauges()) {
        return wrong("--reading-error", format!("1 number or {}", table.gauges()));
    }
    if let Some(path) = &arguments.prior {
        if !matches!(arguments.method, FitMethod::Prior | FitMethod::LeastSquares) {
            return Err(bad(first, &"--prior is for --method prior alone"));
        }
        let prior = read_calibration(path)?;
        if prior.axes != *axes || prior.gauges() != table.gauges() || prior.signal_unit != table.signal_unit {
            return Err(bad(path, &"the earlier calibration has other axes, gauges or units than the loads"));
        }
        return Ok(Method::Prior { prior: Box::new(prior), relative: arguments.prior_error });
    }
    Ok(match arguments.method {
        FitMethod::LeastSquares | FitMethod::Prior => Method::LeastSquares,
        FitMethod::Huber => Method::Huber,
        FitMethod::Ransac => Method::Ransac { outliers: arguments.bad_share, seed: 1 },
        FitMethod::Total => Method::Total { load_deviations, signal_deviations },
        FitMethod::GaussHelmert => {
            Method::GaussHelmert { load_deviations, relative: arguments.load_error_share, signal_deviations }
        }
    })
}

fn limits(percent: Option<f64>) -> Limits {
    let limits = Limits::default();
    Limits { left_out_percent: percent.unwrap_or(limits.left_out_percent), ..limits }
}
