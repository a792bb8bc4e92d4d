//! `fingertip refine`: what ordinary point contacts say of a calibration, and mending it by them.

use std::path::{Path, PathBuf};

use clap::Args;
use fingertip_calibration::Axis;
use fingertip_calibration::file::{CalibrationFile, Quality, Verdict};
use fingertip_calibration::in_situ::{PointContactForm, angle_between, form_of, refine};
use fingertip_calibration::linear::pseudo_inverse;
use fingertip_calibration::loads::{Rest, signals_from_csv};
use nalgebra::DMatrix;

use crate::calibrate::files::{bad, open, read_calibration, read_loads};
use crate::error::CliError;
use crate::output::{Outputs, Overwrite};

#[derive(Debug, Args)]
#[command(
    after_help = "The wrench of a point contact has no pitch (f·m = 0), wherever it is and however large: \
    touches that nobody measured determine 20 of the 36 numbers of a sensor of six gauges. Known loads, five at \
    least in general directions, determine the rest; what nothing determines stays as it was."
)]
pub(crate) struct RefineArguments {
    /// The calibration
    #[arg(value_name = "CAL.toml")]
    calibration: PathBuf,
    /// Readings of point contacts, a few dozen at least: CSV with v1_V … (and temperature_C)
    #[arg(value_name = "TOUCHES.csv")]
    touches: PathBuf,
    /// Known loads and readings
    #[arg(long, value_name = "LOADS.csv")]
    loads: Option<PathBuf>,
    /// How far from zero the pitch f·m/(|f||m|) of a touch may be for other reasons
    #[arg(long, value_name = "SHARE", default_value_t = 0.01)]
    pitch_error: f64,
    /// Standard deviation of the known loads, share of full scale
    #[arg(long, value_name = "SHARE", default_value_t = 0.001)]
    load_error: f64,
    /// Where to write the mended calibration; nothing is mended without it
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    overwrite: Overwrite,
}

pub(crate) fn run(arguments: &RefineArguments) -> Result<(), CliError> {
    let path = &arguments.touches;
    let inputs = [path, &arguments.calibration].into_iter().chain(&arguments.loads);
    let outputs = Outputs::guard(arguments.overwrite, "output", inputs, &arguments.output)?;
    let file = read_calibration(&arguments.calibration)?;
    let unusable = |message: &str| CliError::Calibration {
        path: arguments.calibration.clone(),
        message: message.to_owned(),
    };
    if file.axes != Axis::ALL || file.is_curved() {
        return Err(unusable("only a linear calibration of six components can be refined"));
    }
    let Rest { signals, unit, temperatures, .. } =
        signals_from_csv(open("recording of touches", path)?).map_err(|error| bad(path, &error))?;
    if unit != file.signal_unit {
        return Err(bad(path, &"its readings are in another unit than the calibration"));
    }
    let touches = less_zero(&file, &signals, temperatures.as_deref(), path)?;
    let start = pseudo_inverse(&file.matrix).ok_or_else(|| unusable("its matrix has no inverse"))?;

    let mut form = PointContactForm::new(file.gauges());
    let taken = touches.row_iter().filter(|row| form.push(&row.iter().copied().collect::<Vec<_>>())).count();
    let mut text = format!("{taken} touches\n");
    match form.solve() {
        Ok(seen) => text.push_str(&format!(
            "the form that vanishes on them is {:.3}° off that of the calibration (± {:.3}°; ambiguity {:.1e}; \
             signature {}, {}, where 3, 3 is that of a sensor)\n",
            angle_between(&seen.matrix, &form_of(&start)).to_degrees(),
            seen.deviation.to_degrees(),
            seen.ambiguity,
            seen.signature.0,
            seen.signature.1
        )),
        Err(error) => text.push_str(&format!("no form of their own: {error}\n")),
    }
    let mut notes = Vec::new();
    let (readings, loads) = match &arguments.loads {
        None => (DMatrix::zeros(0, file.gauges()), DMatrix::zeros(0, 6)),
        Some(path) => {
            let table = read_loads(path, &mut notes)?;
            if table.axes != Axis::ALL || table.gauges() != file.gauges() || table.signal_unit != unit {
                return Err(bad(path, &"it has other axes, gauges or units than the calibration"));
            }
            let mut loads = table.loads.clone();
            for (mut column, nominal) in loads.column_iter_mut().zip(&file.nominal) {
                column /= *nominal;
            }
            (less_zero(&file, &table.signals, table.temperatures.as_deref(), path)?, loads)
        }
    };
    let mended = refine(&start, &touches, arguments.pitch_error, &readings, &loads, arguments.load_error)
        .map_err(|error| bad(path, &error))?;
    text.push_str(&format!(
        "pitch of the touches (RMS of f·m/(|f||m|) in nominal loads): {:.5}, mended {:.5}\n\
         {} of {} numbers of the matrix are not observed and stay as they were\n",
        mended.pitch.0,
        mended.pitch.1,
        mended.unobserved,
        start.len()
    ));
    let size = mended.loads_per_signal.norm();
    text.push_str(&format!(
        "what is observed of it is known to {:.3} % (standard deviation of the whole matrix, relative)\n",
        100.0 * mended.deviations.norm() / size
    ));
    if let Some(output) = &arguments.output {
        let matrix = pseudo_inverse(&mended.loads_per_signal)
            .ok_or_else(|| bad(path, &"the mended matrix is singular"))?;
        let covariance =
            file.covariance.as_ref().and_then(|before| mended.covariance_after(&file.matrix, before));
        let mut better = CalibrationFile { matrix, covariance, ..file };
        better.provenance.method.push_str("; refined by point contacts");
        better.quality = Quality {
            verdict: Verdict::Unchecked,
            reasons: vec!["refined by point contacts: check it on known loads".to_owned()],
            ..Quality::default()
        };
        outputs.write("calibration", output, &better.to_toml().map_err(|error| bad(path, &error))?)?;
    }
    outputs.say(&text, &notes)
}

/// Readings less their zero, at the reference temperature.
fn less_zero(
    file: &CalibrationFile,
    readings: &DMatrix<f64>,
    celsius: Option<&[f64]>,
    path: &Path,
) -> Result<DMatrix<f64>, CliError> {
    if readings.ncols() != file.gauges() {
        let message = format!("it has {} gauges, the calibration {}", readings.ncols(), file.gauges());
        return Err(bad(path, &message));
    }
    let mut signals = readings.clone();
    for (i, mut row) in signals.row_iter_mut().enumerate() {
        let mut reading: Vec<f64> = row.iter().copied().collect();
        if let Some(drift) = &file.temperature {
            let at = celsius.map(|list| list[i]).and_then(|t| drift.at_reference(&reading, &file.zero, t));
            let message = "the calibration drifts with temperature: a column temperature_C is needed";
            reading = at.ok_or_else(|| bad(path, &message))?;
        }
        for ((slot, reading), zero) in row.iter_mut().zip(reading).zip(&file.zero) {
            *slot = reading - zero;
        }
    }
    Ok(signals)
}
