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
mod tests {
    use super::RestError;
    use crate::Axis;
    use crate::file::{CalibrationFile, FileError, SignalUnit, Temperature};
    use crate::fit::testing::gaussian;
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    fn file() -> CalibrationFile {
        let matrix = DMatrix::from_diagonal_element(6, 6, 2.0);
        CalibrationFile::new(matrix, vec![10.0; 6], vec![0.5; 6], SignalUnit::Volt).unwrap()
    }

    #[test]
    fn zero_and_noise_are_those_of_the_rest() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        let signals = DMatrix::from_fn(2000, 6, |_, j| j as f64 + 0.01 * gaussian(&mut random));
        let tared = file().tared_by(&signals, false).unwrap();
        for j in 0..6 {
            assert!((tared.file.zero[j] - j as f64).abs() < 0.001);
            assert!((tared.file.noise.as_ref().unwrap()[j] - 0.01).abs() < 0.001);
            // A reading of 2 V is the nominal load of 10.
            assert!((tared.load_before[j] - 5.0 * (j as f64 - 0.5)).abs() < 0.01);
        }
        assert!(tared.warnings.is_empty());
    }

    fn random(seed: u64) -> rand_pcg::Pcg64Mcg {
        rand_pcg::Pcg64Mcg::seed_from_u64(seed)
    }

    /// Readings with a noise of 1 mV, of which gauge 3 moves; 1 mV of it are 0.05 % of the nominal load.
    fn tared(samples: usize, seed: u64, moves: impl Fn(f64) -> f64) -> Result<super::Tared, RestError> {
        let mut random = random(seed);
        let signals = DMatrix::from_fn(samples, 6, |i, j| {
            let moved = if j == 2 { moves(i as f64 / samples as f64) } else { 0.0 };
            0.5 + moved + 1e-3 * gaussian(&mut random)
        });
        file().tared_by(&signals, false)
    }

    #[test]
    fn what_moves_is_refused_and_what_wanders_a_little_is_said() {
        for seed in 0..100 {
            assert!(tared(500, seed, |_| 0.0).unwrap().warnings.is_empty(), "{seed}");
            assert!(tared(20, seed, |_| 0.0).unwrap().warnings.is_empty(), "{seed}");
        }
        // Of a nominal load of 10 at 2 V: ±20, a drift, and a knock.
        type Motion = fn(f64) -> f64;
        let motions: [(Motion, f64); 3] = [
            (|t| 4.0 * (30.0 * t).sin(), 40.0),
            (|t| 0.1 * t, 0.5),
            (|t| if t > 0.5 { -0.2 } else { 0.0 }, 1.0),
        ];
        for samples in [24, 500, 20_000] {
            // A swing of a few readings cannot be told from noise.
            let skipped = usize::from(samples < 32);
            for (motion, wanted) in motions.into_iter().skip(skipped) {
                let error = tared(samples, 1, motion).unwrap_err();
                let RestError::NotAtRest { axis, range, seen } = &error else { panic!("{error}") };
                assert_eq!(*axis, Axis::Fz, "{error}");
                assert!(
                    (0.8..1.1).contains(&(range / wanted)) && seen.contains("gauge 3"),
                    "{samples} {error}"
                );
                assert!(error.to_string().starts_with("this is no rest: Fz ranged over "), "{error}");
            }
        }
        let little = tared(2000, 2, |t| 5e-3 * t).unwrap();
        assert!(little.warnings.len() == 1 && little.warnings[0].contains("gauge 3 moved by"), "{little:?}");
        assert!(little.warnings[0].contains("Fz by 2.") && (0.02..0.03).contains(&little.load_range[2]));
        // Asked for, any motion is taken.
        let moving = DMatrix::from_fn(500, 6, |i, j| if j == 2 { i as f64 } else { 0.0 });
        assert!(file().tared_by(&moving, false).is_err());
        assert_eq!(file().tared_by(&moving, true).unwrap().file.zero[2], 249.5);
        // Readings that do not change at all are at rest.
        assert!(file().tared_by(&DMatrix::from_element(10, 6, 3.0), false).unwrap().warnings.is_empty());
    }

    #[test]
    fn the_noise_of_the_load_is_that_of_the_gauges_through_the_calibration() {
        let rested = tared(5000, 3, |_| 0.0).unwrap();
        for noise in &rested.load_noise {
            assert!((noise / 5e-3 - 1.0).abs() < 0.05, "{noise}");
        }
        // Means of 313 readings.
        assert!(rested.load_range.iter().all(|range| *range < 6.0 * 5e-3 / 313_f64.sqrt()));
    }

    #[test]
    fn what_was_tared_is_not_to_be_tared() {
        let mut untared = file();
        untared.quality.reasons = vec![super::UNTARED.to_owned(), "it is old".to_owned()];
        let tared = untared.tared_by(&DMatrix::from_element(10, 6, 3.0), false).unwrap();
        assert_eq!(tared.file.quality.reasons, ["it is old"]);
    }

    /// Two readings: their mean, half their difference times √2, and what changed.
    #[test]
    fn two_readings_are_enough() {
        let mut before = file();
        before.range = Some([-10.0, 10.0]);
        let signals = DMatrix::from_fn(2, 6, |i, j| j as f64 + 1e6 * f64::EPSILON * i as f64);
        let tared = before.tared_by(&signals, false).unwrap();
        assert_eq!(tared.samples, 2);
        for j in 0..6 {
            let mean = j as f64 + 0.5e6 * f64::EPSILON;
            assert_eq!((tared.file.zero[j], tared.moved[j]), (mean, mean - 0.5));
            let noise = tared.file.noise.as_ref().unwrap()[j];
            assert!((noise / (1e6 * f64::EPSILON * 0.5_f64.sqrt()) - 1.0).abs() < 1e-5);
        }
        // One reading within the range is enough for a zero, at its ends none is.
        let mut end = DMatrix::from_element(3, 6, 10.0);
        end[(1, 0)] = 9.9;
        assert!(matches!(before.tared_by(&end, false), Err(RestError::Saturated { gauge: 2 })));
        end.row_mut(1).fill(9.9);
        assert!(before.tared_by(&end, false).is_ok());
        let low = DMatrix::from_element(3, 6, -10.0);
        assert!(matches!(before.tared_by(&low, false), Err(RestError::Saturated { gauge: 1 })));
        let five = DMatrix::zeros(3, 5);
        let error = before.tared_by(&five, false).unwrap_err();
        assert!(
            matches!(error, RestError::Calibration(FileError::WrongGauges { found: 6, expected: 5 })),
            "{error}"
        );
    }

    #[test]
    fn mistakes_are_named() {
        let text = "v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n1,2,3,4,5,6\n1,2,3,4,5,6\n";
        assert_eq!(file().tared(text.as_bytes(), None, false).unwrap().file.zero[4], 5.0);
        let counts = text.replace("_V", "_count");
        assert!(matches!(file().tared(counts.as_bytes(), None, false), Err(RestError::WrongUnit { .. })));
        assert!(matches!(
            file().tared("v1_V\n1\n2\n".as_bytes(), None, false),
            Err(RestError::Calibration(_))
        ));
        assert!(matches!(file().tared("a\n1\n".as_bytes(), None, false), Err(RestError::Recording(_))));
        let mut ranged = file();
        ranged.range = Some([-5.0, 5.0]);
        assert!(matches!(ranged.tared(text.as_bytes(), None, false), Err(RestError::Saturated { gauge: 5 })));
        // A zero that drifts: 0.01 V/K.
        let mut drifting = file();
        drifting.temperature = Some(Temperature {
            reference_celsius: 20.0,
            range_celsius: [10.0, 30.0],
            zero_drift: vec![0.01; 6],
            zero_curvature: vec![0.0; 6],
            gain_drift: vec![0.1; 6],
        });
        let needs = |error| matches!(error, RestError::Calibration(FileError::NeedsTemperature { .. }));
        assert!(needs(drifting.tared(text.as_bytes(), None, false).unwrap_err()));
        assert!(needs(drifting.tared_by(&DMatrix::zeros(3, 6), false).unwrap_err()));
        for wrong in [f64::NAN, f64::INFINITY] {
            assert!(needs(drifting.tared(text.as_bytes(), Some(wrong), false).unwrap_err()), "{wrong}");
        }
        let warm =
            "v1_V,v2_V,v3_V,v4_V,v5_V,v6_V,temperature_C\n1,1,1,1,1,1,22\n1.05,1.05,1.05,1.05,1.05,1.05,27\n";
        assert!((drifting.tared(warm.as_bytes(), None, false).unwrap().file.zero[2] - 0.98).abs() < 1e-12);
        assert!(
            (drifting.tared(text.as_bytes(), Some(25.0), false).unwrap().file.zero[4] - 4.95).abs() < 1e-12
        );
        let one = DMatrix::from_element(1, 6, 0.0);
        assert!(matches!(file().tared_by(&one, false), Err(RestError::TooFewSamples { samples: 1 })));
    }
}
