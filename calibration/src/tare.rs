//! A new zero for a calibrated sensor.

use std::io::Read;

use fingertip_wrench::{NotAtRest, RestTest};
use nalgebra::{DMatrix, RowDVector, SVector};
use thiserror::Error;

use crate::Axis;
use crate::file::{CalibrationFile, FileError, SignalUnit, UNTARED};
use crate::linear::pseudo_inverse;
use crate::loads::{LoadError, Rest, signals_from_csv};

/// The fraction of good rests that are called into question, as where a scene is tared.
const FALSE_ALARM_RATE: f64 = 1e-4;
/// A recording that fails the test of rest, and over whose parts the load ranges over more than this share of the nominal
/// load, is no rest.
const UNMISTAKABLE: f64 = 0.01;
/// Parts of a recording whose means are compared.
const PARTS: usize = 16;
/// Fewer readings tell no motion.
const FEWEST: usize = 8;

/// A calibration with a new zero, and what the recording of rest looked like.
///
/// ```
/// use fingertip_calibration::file::{CalibrationFile, SignalUnit};
/// use fingertip_calibration::nalgebra::DMatrix;
/// use fingertip_calibration::tare::Tared;
///
/// // 2 V under the nominal loads, 10 N and 0.1 N·m; no zero yet.
/// let nominal = vec![10.0, 10.0, 10.0, 0.1, 0.1, 0.1];
/// let matrix = DMatrix::from_diagonal_element(6, 6, 2.0);
/// let file = CalibrationFile::new(matrix, nominal, vec![0.0; 6], SignalUnit::Volt)?;
/// // A hundred readings at rest, around 0.3 V.
/// let volts = DMatrix::from_fn(100, 6, |i, j| 0.3 + 1e-4 * ((7 * i + 3 * j) as f64).sin());
/// let tared: Tared = file.tared_by(&volts, false)?;
/// assert!((tared.file.zero[0] - 0.3).abs() < 1e-4 && tared.samples == 100);
/// // With the old zero they were 0.3 V · 10 N / 2 V.
/// assert!((tared.load_before[0] - 1.5).abs() < 1e-3);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Tared {
    /// The calibration with the new zero and noise.
    pub file: CalibrationFile,
    /// How many readings the zero is the mean of.
    pub samples: usize,
    /// By how much each zero moved.
    pub moved: Vec<f64>,
    /// The load \[N, N·m\] that the old zero would have read at rest.
    pub load_before: Vec<f64>,
    /// Standard deviation of the load of one reading \[N, N·m\].
    pub load_noise: Vec<f64>,
    /// Over what the load ranged \[N, N·m\], by the means of sixteen parts of the recording: so far the zero may be off.
    pub load_range: Vec<f64>,
    /// What to mind: a recording that was not quite at rest.
    pub warnings: Vec<String>,
}

/// Why there is no new zero.
///
/// ```
/// use fingertip_calibration::file::{CalibrationFile, SignalUnit};
/// use fingertip_calibration::nalgebra::DMatrix;
/// use fingertip_calibration::tare::RestError;
///
/// let nominal = vec![10.0, 10.0, 10.0, 0.1, 0.1, 0.1];
/// let matrix = DMatrix::from_diagonal_element(6, 6, 2.0);
/// let file = CalibrationFile::new(matrix, nominal, vec![0.0; 6], SignalUnit::Volt)?;
/// // Readings that rise by 1 V, which are 5 N: somebody pushed.
/// let volts = DMatrix::from_fn(100, 6, |i, _| 0.01 * i as f64);
/// assert!(matches!(file.tared_by(&volts, false), Err(RestError::NotAtRest { .. })));
/// // If that is to be so, the mean is taken.
/// assert!(file.tared_by(&volts, true).is_ok());
/// # Ok::<(), fingertip_calibration::file::FileError>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RestError {
    /// The recording is wrong.
    #[error(transparent)]
    Recording(#[from] LoadError),
    /// The calibration is wrong.
    #[error(transparent)]
    Calibration(#[from] FileError),
    /// Fewer than two readings.
    #[error("a zero needs at least 2 readings at rest, not {samples}")]
    TooFewSamples {
        /// How many there are.
        samples: usize,
    },
    /// The recording is in another unit than the calibration.
    #[error("the recording is in {recording:?}, the calibration in {calibration:?}")]
    WrongUnit {
        /// Unit of the recording.
        recording: SignalUnit,
        /// Unit of the calibration.
        calibration: SignalUnit,
    },
    /// A gauge gives no other reading than the end of its range.
    #[error("gauge {gauge} is saturated at rest")]
    Saturated {
        /// Which gauge, from 1.
        gauge: usize,
    },
    /// The sensor moved or was loaded.
    #[error(
        "this is no rest: {axis} ranged over {range:.3} {unit}, and {seen}; record the sensor without load and motion, or \
         cut the recording to where it rests", unit = .axis.unit()
    )]
    NotAtRest {
        /// The component of the load that moved most, measured by its nominal load.
        axis: Axis,
        /// Over what it ranged \[N or N·m\].
        range: f64,
        /// What the readings show.
        seen: String,
    },
}

impl CalibrationFile {
    /// Takes the zero and the noise of the gauges from a recording of the sensor at rest, without load:
    /// CSV with the columns `v1_V` … as in [`crate::loads::LoadTable::from_csv`].
    ///
    /// A calibration with temperature terms needs the column `temperature_C`, or the temperature of the
    /// whole recording; the zero is then that of the reference temperature.
    ///
    /// Every gauge must pass the test of rest ([`RestTest`]). One that does not is a warning; if the load ranged over
    /// more than a hundredth of a nominal load besides, there is no zero, unless `any_motion` is put up with.
    ///
    /// # Errors
    /// [`RestError`].
    pub fn tared(&self, rest: impl Read, celsius: Option<f64>, any_motion: bool) -> Result<Tared, RestError> {
        let rest = signals_from_csv(rest)?;
        self.tared_by_rest(&rest, celsius, any_motion)
    }

    /// As [`tared`](Self::tared), from readings that have been read.
    ///
    /// # Errors
    /// [`RestError`].
    pub fn tared_by_rest(
        &self,
        rest: &Rest,
        celsius: Option<f64>,
        any_motion: bool,
    ) -> Result<Tared, RestError> {
        let Rest { signals, unit, temperatures, .. } = rest;
        if *unit != self.signal_unit {
            return Err(RestError::WrongUnit { recording: *unit, calibration: self.signal_unit });
        }
        self.check_readings(signals)?;
        let mut signals = signals.clone();
        if let Some(drift) = &self.temperature {
            for (i, mut row) in signals.row_iter_mut().enumerate() {
                let known = temperatures.as_ref().map(|list| list[i]).or(celsius.filter(|t| t.is_finite()));
                let reference = drift.reference_celsius;
                let celsius = known.ok_or(FileError::NeedsTemperature { reference })?;
                row -= RowDVector::from_vec(drift.drift_of_zero(celsius));
            }
        }
        self.tared_at_reference(&signals, any_motion)
    }

    /// As [`tared`](Self::tared), from readings (samples × gauges) in the calibration's unit.
    ///
    /// # Errors
    /// [`RestError`].
    pub fn tared_by(&self, signals: &DMatrix<f64>, any_motion: bool) -> Result<Tared, RestError> {
        if let Some(drift) = &self.temperature {
            return Err(FileError::NeedsTemperature { reference: drift.reference_celsius }.into());
        }
        self.check_readings(signals)?;
        self.tared_at_reference(signals, any_motion)
    }

    fn check_readings(&self, signals: &DMatrix<f64>) -> Result<(), RestError> {
        self.validate()?;
        let (samples, gauges) = signals.shape();
        if gauges != self.gauges() {
            return Err(FileError::WrongGauges { found: self.gauges(), expected: gauges }.into());
        }
        if samples < 2 {
            return Err(RestError::TooFewSamples { samples });
        }
        if let Some(range) = self.range {
            let stuck =
                |gauge: &usize| signals.column(*gauge).iter().all(|v| !(*v > range[0] && *v < range[1]));
            if let Some(gauge) = (0..gauges).find(stuck) {
                return Err(RestError::Saturated { gauge: gauge + 1 });
            }
        }
        Ok(())
    }

    fn tared_at_reference(&self, signals: &DMatrix<f64>, any_motion: bool) -> Result<Tared, RestError> {
        let samples = signals.nrows();
        let mut file = self.clone();
        let inverse = pseudo_inverse(&self.matrix).ok_or(FileError::Singular)?;
        let mut warnings = Vec::new();
        let mut noise = Vec::with_capacity(self.gauges());
        for (gauge, column) in signals.column_iter().enumerate() {
            let (mean, deviation) = mean_and_deviation(column.as_slice());
            let share = FALSE_ALARM_RATE / self.gauges() as f64;
            warnings.extend(doubt(column.as_slice(), share, gauge + 1));
            file.zero[gauge] = mean;
            noise.push(deviation);
        }
        let load = |reading: &[f64]| self.load_with(&inverse, reading).ok_or(FileError::Singular);
        let load_before = load(&file.zero)?.as_slice().to_vec();
        let mut loads = Vec::with_capacity(samples);
        for row in signals.row_iter() {
            let reading: Vec<f64> = row.iter().copied().collect();
            loads.push(load(&reading)?);
        }
        let of_axis = |axis: usize| -> Vec<f64> { loads.iter().map(|load| load[axis]).collect() };
        let axes: Vec<Vec<f64>> = (0..self.axes.len()).map(of_axis).collect();
        let load_noise = axes.iter().map(|loads| mean_and_deviation(loads).1).collect();
        let load_range: Vec<f64> = axes.iter().map(|loads| range_of_parts(loads)).collect();
        let worst = (0..load_range.len()).max_by(|a, b| {
            (load_range[*a] / self.nominal[*a]).total_cmp(&(load_range[*b] / self.nominal[*b]))
        });
        if let (Some(seen), Some(axis)) = (warnings.first_mut(), worst) {
            let range = load_range[axis];
            let name = self.axes[axis];
            if range > UNMISTAKABLE * self.nominal[axis] && !any_motion {
                return Err(RestError::NotAtRest { axis: name, range, seen: seen.clone() });
            }
            seen.push_str(&format!("; so far the zero may be off: {name} by {range:.2e} {}", name.unit()));
        }
        let moved = file.zero.iter().zip(&self.zero).map(|(new, old)| new - old).collect();
        file.noise = Some(noise);
        file.quality.reasons.retain(|reason| reason != UNTARED);
        file.validate()?;
        Ok(Tared { file, samples, moved, load_before, load_noise, load_range, warnings })
    }
}

/// Why the readings of a gauge are doubted to be a rest.
fn doubt(readings: &[f64], false_alarm_rate: f64, gauge: usize) -> Option<String> {
    let mut test = RestTest::<f64, 1>::new(false_alarm_rate).ok()?.finding_resolution();
    readings.iter().for_each(|reading| {
        test.add(&SVector::from([*reading]));
    });
    Some(match test.finish().err()? {
        NotAtRest::TooFewSamples { samples, needed } if moves(readings) => {
            format!(
                "gauge {gauge} moved between the halves of {samples} readings (a test of rest takes {needed})"
            )
        }
        NotAtRest::TooFewSamples { .. } => return None,
        NotAtRest::Drifts { over_noise, .. } => {
            format!("gauge {gauge} moved by {over_noise:.1} times its spread from start to end")
        }
        NotAtRest::Unsteady { .. } => format!("gauge {gauge} wandered"),
        NotAtRest::Outlier { over_noise, .. } => {
            format!("gauge {gauge} was once {over_noise:.0} times its spread away from its mean")
        }
        other => format!("gauge {gauge}: {other}"),
    })
}

/// Whether the halves of a few readings differ by more than five standard errors, and more than single readings do. The
/// means of two halves differ by 2σ/√n.
fn moves(readings: &[f64]) -> bool {
    if readings.len() < FEWEST {
        return false;
    }
    let (first, second) = readings.split_at(readings.len() / 2);
    let (first, second) = (mean_and_deviation(first), mean_and_deviation(second));
    let deviation = first.1.max(second.1);
    let change = (second.0 - first.0).abs();
    change > 10.0 * deviation / (readings.len() as f64).sqrt() && change > deviation
}

/// The range of the means of parts.
fn range_of_parts(values: &[f64]) -> f64 {
    let length = values.len().div_ceil(PARTS).max(1);
    let means = values.chunks(length).map(|part| part.iter().sum::<f64>() / part.len() as f64);
    let (low, high) =
        means.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    high - low
}

/// Two passes, so that a large mean does not cancel.
fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    let count = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    (mean, (squares / (count - 1.0).max(1.0)).sqrt())
}

#[cfg(test)]
mod tests;
