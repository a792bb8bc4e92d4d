//! `fingertip calibrate`, `check` and `tare`: files to files, by `fingertip-calibration`.

pub(crate) mod args;
mod gravity;

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use fingertip_calibration::file::{AtiCalibration, CalibrationFile, Scalar, Verdict};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Direction, Limits, Method, Options, calibrate as fit};
use fingertip_calibration::report::Report;

use crate::error::CliError;
use args::{CalibrateArguments, CheckArguments, FitMethod, TareArguments};

/// `fingertip calibrate`.
pub(crate) fn calibrate(arguments: &CalibrateArguments) -> Result<(), CliError> {
    if let Some(poses) = &arguments.gravity {
        return gravity::run(poses, arguments);
    }
    let outputs = [Some(&arguments.output), arguments.html.as_ref(), arguments.json.as_ref()];
    let extra = [arguments.cal.as_ref(), arguments.rust.as_ref()];
    guard(&arguments.loads, outputs.into_iter().chain(extra).flatten())?;
    let mut notes = Vec::new();
    let sessions =
        arguments.loads.iter().map(|path| read_loads(path, &mut notes)).collect::<Result<Vec<_>, _>>()?;
    let first = arguments.loads.first().cloned().unwrap_or_default();
    let bad = |message: String| CliError::Calibrate { path: first.clone(), message };
    let table = LoadTable::merged(&sessions).map_err(|error| bad(error.to_string()))?;
    let options = options(arguments);
    let calibration = fit(&table, &options).map_err(|error| bad(error.to_string()))?;
    let mut file = calibration.to_file().map_err(|error| bad(error.to_string()))?;
    file.provenance.serial.clone_from(&arguments.serial);
    file.provenance.date.clone_from(&arguments.date);
    let sources: Vec<String> = arguments.loads.iter().map(|path| path.display().to_string()).collect();
    file.provenance.source = sources.join(", ");
    file.range = options.range;
    write("calibration", &arguments.output, &file.to_toml().map_err(|error| bad(error.to_string()))?)?;
    let mut written = vec![arguments.output.clone()];
    if let Some(path) = &arguments.cal {
        let ati = AtiCalibration::from_calibration(&file).map_err(|error| bad(error.to_string()))?;
        write(".cal file", path, &ati.to_xml())?;
        written.push(path.clone());
    }
    if let Some(path) = &arguments.rust {
        write("Rust file", path, &file.to_rust(Scalar::F32).map_err(|error| bad(error.to_string()))?)?;
        written.push(path.clone());
    }
    let title = if arguments.serial.is_empty() { "Calibration" } else { &arguments.serial };
    write_reports(
        &calibration.report,
        title,
        arguments.html.as_ref(),
        arguments.json.as_ref(),
        &mut written,
    )?;
    say(&calibration.report, &notes, &written)
}

/// `fingertip check`: an error if the calibration does not hold.
pub(crate) fn check(arguments: &CheckArguments) -> Result<(), CliError> {
    let inputs = [arguments.calibration.clone(), arguments.loads.clone()];
    guard(&inputs, [arguments.html.as_ref(), arguments.json.as_ref()].into_iter().flatten())?;
    let mut file = read_calibration(&arguments.calibration)?;
    let mut notes = Vec::new();
    let mut table = read_loads(&arguments.loads, &mut notes)?;
    let bad = |message: String| CliError::Calibrate { path: arguments.loads.clone(), message };
    if arguments.tare_groups {
        table = table.tared_by_group().map_err(|error| bad(error.to_string()))?;
        file.zero.fill(0.0);
        // The range is that of untared readings.
        file.range = None;
    }
    let report =
        Report::of_check(&file, &table, &limits(arguments.limit)).map_err(|error| bad(error.to_string()))?;
    let mut written = Vec::new();
    write_reports(&report, "Check", arguments.html.as_ref(), arguments.json.as_ref(), &mut written)?;
    say(&report, &notes, &written)?;
    if report.verdict == Verdict::Bad {
        return Err(CliError::DoesNotHold {
            calibration: arguments.calibration.clone(),
            loads: arguments.loads.clone(),
            reason: report.reasons.first().cloned().unwrap_or_default(),
        });
    }
    Ok(())
}

/// `fingertip tare`.
pub(crate) fn tare(arguments: &TareArguments) -> Result<(), CliError> {
    // Writing over the calibration itself is what taring often means.
    guard(std::slice::from_ref(&arguments.rest), [&arguments.output])?;
    let file = read_calibration(&arguments.calibration)?;
    let text = fs::File::open(&arguments.rest)
        .map_err(|source| CliError::read("recording", &arguments.rest, source))?;
    let bad = |message: String| CliError::Calibrate { path: arguments.rest.clone(), message };
    let tared = file.tared(text).map_err(|error| bad(error.to_string()))?;
    write("calibration", &arguments.output, &tared.file.to_toml().map_err(|error| bad(error.to_string()))?)?;
    let mut text = format!("Zero of {} readings at rest.\n", tared.samples);
    for (axis, load) in file.axes.iter().zip(&tared.load_before) {
        text.push_str(&format!("{axis}: the old zero read {load:+.4} {}\n", axis.unit()));
    }
    for warning in &tared.warnings {
        text.push_str(&format!("note: {warning}\n"));
    }
    text.push_str(&format!("\nWritten: {}\n", arguments.output.display()));
    print(&text)
}

fn options(arguments: &CalibrateArguments) -> Options {
    Options {
        direction: if arguments.inverse { Direction::LoadsFromSignals } else { Direction::SignalsFromLoads },
        bias: !arguments.no_bias,
        quadratic: arguments.quadratic,
        method: match arguments.method {
            FitMethod::LeastSquares => Method::LeastSquares,
            FitMethod::Huber => Method::Huber,
            FitMethod::Ransac => Method::Ransac { outliers: 0.2, seed: 1 },
        },
        nominal: arguments.full_scale.clone(),
        range: arguments.range.as_deref().and_then(|range| <[f64; 2]>::try_from(range).ok()),
        tare_groups: arguments.tare_groups,
        reject_outliers: arguments.reject_outliers,
        limits: limits(arguments.limit),
    }
}

fn limits(percent: Option<f64>) -> Limits {
    let limits = Limits::default();
    Limits { left_out_percent: percent.unwrap_or(limits.left_out_percent), ..limits }
}

fn read_loads(path: &Path, notes: &mut Vec<String>) -> Result<LoadTable, CliError> {
    let file = fs::File::open(path).map_err(|source| CliError::read("table of loads", path, source))?;
    let (table, ignored) = LoadTable::from_csv(io::BufReader::new(file))
        .map_err(|error| CliError::Calibrate { path: path.to_owned(), message: error.to_string() })?;
    if !ignored.is_empty() {
        notes.push(format!("{}: columns not used: {}", path.display(), ignored.join(", ")));
    }
    Ok(table)
}

/// Our TOML, or ATI's `.cal` by its extension.
fn read_calibration(path: &Path) -> Result<CalibrationFile, CliError> {
    let bad = |message: String| CliError::Calibration { path: path.to_owned(), message };
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("cal")) {
        let text = fs::read_to_string(path).map_err(|source| CliError::read("calibration", path, source))?;
        let ati = AtiCalibration::from_xml(&text).map_err(|error| bad(error.to_string()))?;
        return ati.to_calibration().map_err(|error| bad(error.to_string()));
    }
    let text = fs::read_to_string(path).map_err(|source| CliError::read("calibration", path, source))?;
    CalibrationFile::from_toml(&text).map_err(|error| bad(error.to_string()))
}

/// Refuses to write over what is read.
fn guard<'a>(inputs: &[PathBuf], outputs: impl IntoIterator<Item = &'a PathBuf>) -> Result<(), CliError> {
    for output in outputs {
        let Ok(place) = fs::canonicalize(output) else { continue };
        if inputs.iter().any(|input| fs::canonicalize(input).is_ok_and(|input| input == place)) {
            return Err(CliError::WouldOverwrite { what: "output", path: output.clone() });
        }
    }
    Ok(())
}

fn write(what: &'static str, path: &Path, text: &str) -> Result<(), CliError> {
    fs::write(path, text).map_err(|source| CliError::write(what, path, source))
}

fn write_reports(
    report: &Report,
    title: &str,
    html: Option<&PathBuf>,
    json: Option<&PathBuf>,
    written: &mut Vec<PathBuf>,
) -> Result<(), CliError> {
    if let Some(path) = html {
        write("report", path, &report.to_html(title))?;
        written.push(path.clone());
    }
    if let Some(path) = json {
        let text = report.to_json().map_err(|error| CliError::write("report", path, error.into()))?;
        write("report", path, &text)?;
        written.push(path.clone());
    }
    Ok(())
}

fn say(report: &Report, notes: &[String], written: &[PathBuf]) -> Result<(), CliError> {
    let mut text = report.to_string();
    for note in notes {
        text.push_str(&format!("note: {note}\n"));
    }
    if !written.is_empty() {
        let list: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
        text.push_str(&format!("\nWritten: {}\n", list.join(", ")));
    }
    print(&text)
}

fn print(text: &str) -> Result<(), CliError> {
    let mut stdout = io::stdout();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(CliError::stdout)
}
