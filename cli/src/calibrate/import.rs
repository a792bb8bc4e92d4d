//! `fingertip import`: the calibrations of others.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use fingertip_calibration::file::{
    CalibrationFile, PlainError, PlainMatrix, PlainUnits, SignalUnit, plain_csv, plain_npy,
};
use fingertip_calibration::units::{ForceUnit, TorqueUnit};

use super::files::{bytes, read_calibration};
use crate::error::CliError;
use crate::output::{Outputs, Overwrite};
use crate::standard::{is_standard, shown};

/// How a file of NumPy begins.
const NPY: &[u8] = b"\x93NUMPY";

/// Which way a plain matrix goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Way {
    /// Load = matrix · signals: 6 rows, a column for each gauge
    LoadPerSignal,
    /// Signals = matrix · load: a row for each gauge, 6 columns
    SignalPerLoad,
}

#[derive(Debug, Args)]
#[command(after_help = "\
A plain matrix says neither which way it goes nor its units, so they must be said. It has no zero
either: tare before use (fingertip tare). A .cal, or TOML written by hand without a checksum,
says what it is.

  fingertip import matrix.npy --matrix load-per-signal --signal V --force N --torque Nmm --full-scale 30,0.3 -o tip.toml")]
pub(crate) struct ImportArguments {
    /// A plain matrix (.csv, .txt, .npy), an ATI .cal, or TOML
    #[arg(value_name = "FILE")]
    from: PathBuf,
    /// Which way a plain matrix goes
    #[arg(long, value_enum)]
    matrix: Option<Way>,
    /// The unit of its signals: V, mV, mVpV, counts
    #[arg(long, value_name = "UNIT")]
    signal: Option<String>,
    /// The unit of its forces: N, mN, lbf …
    #[arg(long, value_name = "UNIT")]
    force: Option<String>,
    /// The unit of its torques: Nm, Nmm, lbf-in …
    #[arg(long, value_name = "UNIT")]
    torque: Option<String>,
    /// Nominal loads [N, N·m]: of forces and torques, or six
    #[arg(long, value_name = "LOADS", value_delimiter = ',')]
    full_scale: Option<Vec<f64>>,
    /// Its loads are what the sensor does to the world, the opposite of fingertip's
    #[arg(long)]
    reaction: bool,
    /// Where to write the calibration
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    overwrite: Overwrite,
}

pub(crate) fn run(arguments: &ImportArguments) -> Result<(), CliError> {
    let outputs = Outputs::guard(arguments.overwrite, "output", [&arguments.from], [&arguments.output])?;
    let path = arguments.from.as_path();
    let fault = |message: String| CliError::Calibration { path: path.to_owned(), message };
    // What comes by the standard input has no ending: it is a matrix if it is said which way that goes.
    let is_plain = match ending(path).as_deref() {
        Some(ending) => ["npy", "csv", "txt"].contains(&ending),
        None => is_standard(path) && arguments.matrix.is_some(),
    };
    let mut file = if is_plain {
        let bytes = bytes("matrix", path)?;
        let matrix = match core::str::from_utf8(&bytes) {
            Ok(text) if !bytes.starts_with(NPY) => plain_csv(text),
            _ => plain_npy(&bytes),
        };
        plain(arguments, matrix).map_err(fault)?
    } else {
        read_calibration(path)?
    };
    file.provenance.source = shown(path);
    let text = file.to_toml().map_err(|error| fault(error.to_string()))?;
    outputs.write("calibration", &arguments.output, &text)?;
    let said = format!("A calibration of {} gauges for {} components.\n", file.gauges(), file.axes.len());
    outputs.say(&said, &file.quality.reasons)
}

/// The ending of a name, in lower case.
pub(super) fn ending(path: &Path) -> Option<String> {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase())
}

fn plain(
    arguments: &ImportArguments,
    matrix: Result<nalgebra::DMatrix<f64>, PlainError>,
) -> Result<CalibrationFile, String> {
    let matrix = matrix.map_err(|error| error.to_string())?;
    let units = units(arguments)?;
    units.calibration(&matrix).map_err(|error| error.to_string())
}

/// What was said of the matrix, or what is not.
fn units(arguments: &ImportArguments) -> Result<PlainUnits, String> {
    let missing = |option: &str| format!("a plain matrix does not say this of itself: give {option}");
    let unknown = |option: &str, unit: &str| format!("{option} {unit}: this unit is not known");
    let matrix = match arguments.matrix.ok_or_else(|| missing("--matrix"))? {
        Way::LoadPerSignal => PlainMatrix::LoadPerSignal,
        Way::SignalPerLoad => PlainMatrix::SignalPerLoad,
    };
    let signal = arguments.signal.as_deref().ok_or_else(|| missing("--signal, the unit of its signals"))?;
    let signal = SignalUnit::from_name(signal)
        .filter(|(_, size)| *size == 1.0)
        .map(|(unit, _)| unit)
        .ok_or_else(|| format!("{} (V, mVpV, counts are)", unknown("--signal", signal)))?;
    let force = arguments.force.as_deref().ok_or_else(|| missing("--force, the unit of its forces"))?;
    let force = ForceUnit::from_name(force).ok_or_else(|| unknown("--force", force))?;
    let torque = arguments.torque.as_deref().ok_or_else(|| missing("--torque, the unit of its torques"))?;
    let torque = TorqueUnit::from_name(torque).ok_or_else(|| unknown("--torque", torque))?;
    let loads = arguments.full_scale.as_deref().ok_or_else(|| missing("--full-scale, its nominal loads"))?;
    let nominal = match *loads {
        [force, torque] => [force, force, force, torque, torque, torque],
        ref six => {
            <[f64; 6]>::try_from(six).map_err(|_| "--full-scale must have 2 or 6 numbers".to_owned())?
        }
    };
    Ok(PlainUnits { matrix, signal, force, torque, nominal, reaction: arguments.reaction })
}
