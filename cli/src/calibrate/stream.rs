//! `fingertip calibrate --stream`: files of any length, row by row.

use std::path::{Path, PathBuf};

use fingertip_calibration::file::{Quality, Verdict};
use fingertip_calibration::loads::{LoadReader, LoadRow};
use fingertip_calibration::model::{SensorModel, StreamedFit};
use nalgebra::DMatrix;

use super::args::{CalibrateArguments, FitMethod};
use super::files::{bad, of_reading, open};
use super::{limits, range, refuse_bad, write_calibration};
use crate::error::CliError;
use crate::output::Outputs;
use crate::standard::is_standard;
use crate::table::count;

/// Reads the files twice: to fit, and to see what the fit leaves.
pub(super) fn run(arguments: &CalibrateArguments, output: &Path, outputs: &Outputs) -> Result<(), CliError> {
    let first = arguments.loads.first().cloned().unwrap_or_default();
    let fault = |error: &dyn core::fmt::Display| bad(&first, &error);
    if !matches!(arguments.method, FitMethod::LeastSquares) {
        return Err(fault(&"--stream is for --method least-squares; the others need all samples at once"));
    }
    if arguments.loads.iter().any(|path| is_standard(path)) {
        return Err(fault(&"--stream reads its files twice; write the standard input into one"));
    }
    let mut notes = Vec::new();
    let mut fit: Option<StreamedFit> = None;
    let mut saturated = 0_u64;
    let limits_of_gauges = range(arguments);
    let inside = |row: &LoadRow| {
        limits_of_gauges.is_none_or(|[low, high]| row.signals.iter().all(|v| *v > low && *v < high))
    };
    let mut layout = None;
    for path in &arguments.loads {
        let mut reader = LoadReader::new(open("table of loads", path)?).map_err(|error| bad(path, &error))?;
        let here = (reader.axes().to_vec(), reader.gauges(), reader.signal_unit());
        if *layout.get_or_insert_with(|| here.clone()) != here {
            return Err(bad(path, &"it has other axes, gauges or units than the first file"));
        }
        let fit = fit.get_or_insert_with(|| StreamedFit::new(&here.0, here.1, here.2, !arguments.no_bias));
        while let Some(row) = reader.next_row().map_err(|error| bad(path, &error))? {
            if !inside(row) {
                saturated += 1;
            } else if !fit.push(&row.loads, &row.signals, row.weight.unwrap_or(1.0)) {
                return Err(bad(path, &format!("line {}: the weight is negative", row.line)));
            }
        }
        notes.extend(of_reading(path, &reader));
    }
    let Some(fit) = fit else { return Err(fault(&"there are no files")) };
    let samples = fit.samples();
    let model = fit.finish(arguments.full_scale.as_deref()).map_err(|error| fault(&error))?;
    if saturated > 0 {
        notes.push(format!("{} saturated samples were left out", count(saturated)));
    }
    let errors = Errors::of(&model, &arguments.loads, inside)?;
    let allowed = limits(arguments.limit).left_out_percent;
    let mut file = model.to_file("least squares of signals on loads, streamed").map_err(|e| fault(&e))?;
    let mut reasons = vec!["streamed: no load was left out of the fit to test it".to_owned()];
    let mut verdict = Verdict::Unchecked;
    let mut worst: Vec<_> = model.axes.iter().zip(&errors.rms).collect();
    worst.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    for (axis, rms) in worst {
        if !(*rms <= allowed) {
            verdict = Verdict::Bad;
            reasons.push(format!("{axis}: {rms:.2} % of full scale on these loads; {allowed} % is allowed"));
        }
    }
    let number = model.condition_number();
    file.quality = Quality {
        verdict,
        reasons: reasons.clone(),
        samples: Some(samples),
        condition_number: Some(number).filter(|number| number.is_finite()),
        rms_percent: Some(errors.rms.clone()),
        greatest_percent: Some(errors.greatest.clone()),
        left_out_percent: None,
    };
    write_calibration(file, arguments, output, outputs)?;
    let word = if verdict == Verdict::Bad { "BAD" } else { "unchecked" };
    let mut text = format!("Calibration: {word}\n");
    for reason in &reasons {
        text.push_str(&format!("  because {reason}\n"));
    }
    text.push_str(&format!("{} samples, condition number N_c = {number:.2}\n", count(samples)));
    for (i, axis) in model.axes.iter().enumerate() {
        text.push_str(&format!(
            "{axis}: full scale {:.4} {}, RMS {:.3} %, greatest {:.3} %\n",
            model.nominal[i],
            axis.unit(),
            errors.rms[i],
            errors.greatest[i]
        ));
    }
    outputs.say(&text, &notes)?;
    refuse_bad(arguments, output, verdict, reasons.get(1..).unwrap_or_default())
}

/// What a fit leaves, axis by axis, % of full scale.
struct Errors {
    rms: Vec<f64>,
    greatest: Vec<f64>,
}

impl Errors {
    fn of(
        model: &SensorModel,
        paths: &[PathBuf],
        inside: impl Fn(&LoadRow) -> bool,
    ) -> Result<Self, CliError> {
        let axes = model.axes.len();
        let (mut squares, mut greatest, mut samples) = (vec![0.0; axes], vec![0.0_f64; axes], 0_u64);
        for path in paths {
            let mut reader =
                LoadReader::new(open("table of loads", path)?).map_err(|error| bad(path, &error))?;
            // The inverse is taken once for a block of rows.
            let mut block: Vec<LoadRow> = Vec::with_capacity(4096);
            loop {
                let row = reader.next_row().map_err(|error| bad(path, &error))?;
                let end = row.is_none();
                block.extend(row.filter(|row| inside(row)).cloned());
                if block.len() == 4096 || (end && !block.is_empty()) {
                    let signals = DMatrix::from_fn(block.len(), model.gauges(), |i, j| block[i].signals[j]);
                    let loads = model
                        .loads(&signals)
                        .ok_or_else(|| bad(path, &"the fitted matrix has no inverse"))?;
                    for (i, row) in block.iter().enumerate() {
                        for j in 0..axes {
                            let error = 100.0 * (loads[(i, j)] - row.loads[j]) / model.nominal[j];
                            squares[j] += error * error;
                            greatest[j] = greatest[j].max(error.abs());
                        }
                    }
                    samples += block.len() as u64;
                    block.clear();
                }
                if end {
                    break;
                }
            }
        }
        let rms = squares.iter().map(|sum| (sum / samples.max(1) as f64).sqrt()).collect();
        Ok(Self { rms, greatest })
    }
}
