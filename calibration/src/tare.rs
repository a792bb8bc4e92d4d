//! A new zero for a calibrated sensor.

use std::io::Read;

use nalgebra::{DMatrix, RowDVector};
use thiserror::Error;

use crate::file::{CalibrationFile, FileError, SignalUnit};
use crate::linear::pseudo_inverse;
use crate::loads::{LoadError, Rest, signals_from_csv};

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
    /// What to mind: a recording that was not at rest, a gauge at its end.
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
}

impl CalibrationFile {
    /// Takes the zero and the noise of the gauges from a recording of the sensor at rest, without load:
    /// CSV with the columns `v1_V` … as in [`crate::loads::LoadTable::from_csv`].
    ///
    /// A calibration with temperature terms needs the column `temperature_C`, or the temperature of the
    /// whole recording; the zero is then that of the reference temperature.
    ///
    /// A recording whose second half differs from its first by more than five standard errors and by
    /// more than one deviation of a single reading was not at rest (or drifts): that is a warning.
    ///
    /// # Errors
    /// [`RestError`].
    pub fn tared(&self, rest: impl Read, celsius: Option<f64>) -> Result<Tared, RestError> {
        let Rest { mut signals, unit, temperatures, .. } = signals_from_csv(rest)?;
        if unit != self.signal_unit {
            return Err(RestError::WrongUnit { recording: unit, calibration: self.signal_unit });
        }
        self.check_readings(&signals)?;
        if let Some(drift) = &self.temperature {
            for (i, mut row) in signals.row_iter_mut().enumerate() {
                let known = temperatures.as_ref().map(|list| list[i]).or(celsius.filter(|t| t.is_finite()));
                let reference = drift.reference_celsius;
                let celsius = known.ok_or(FileError::NeedsTemperature { reference })?;
                row -= RowDVector::from_vec(drift.drift_of_zero(celsius));
            }
        }
        self.tared_at_reference(&signals)
    }

    /// As [`tared`](Self::tared), from readings (samples × gauges) in the calibration's unit.
    ///
    /// # Errors
    /// [`RestError`].
    pub fn tared_by(&self, signals: &DMatrix<f64>) -> Result<Tared, RestError> {
        if let Some(drift) = &self.temperature {
            return Err(FileError::NeedsTemperature { reference: drift.reference_celsius }.into());
        }
        self.check_readings(signals)?;
        self.tared_at_reference(signals)
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

    fn tared_at_reference(&self, signals: &DMatrix<f64>) -> Result<Tared, RestError> {
        let samples = signals.nrows();
        let mut file = self.clone();
        let mut warnings = Vec::new();
        let mut noise = Vec::with_capacity(self.gauges());
        for (gauge, column) in signals.column_iter().enumerate() {
            let (mean, deviation) = mean_and_deviation(column.as_slice());
            let (first, second) = column.as_slice().split_at(samples / 2);
            let drift = mean_and_deviation(second).0 - mean_and_deviation(first).0;
            // The means of two halves differ by 2σ/√n.
            if drift.abs() > 10.0 * deviation / (samples as f64).sqrt() && drift.abs() > deviation {
                warnings.push(format!(
                    "gauge {}: the recording was not at rest: its second half differs by {drift:.3e} from its first, \
                     single readings by {deviation:.3e}",
                    gauge + 1
                ));
            }
            file.zero[gauge] = mean;
            noise.push(deviation);
        }
        let mean: Vec<f64> = file.zero.clone();
        let inverse = pseudo_inverse(&self.matrix).ok_or(FileError::Singular)?;
        let load_before = self.load_with(&inverse, &mean).ok_or(FileError::Singular)?.as_slice().to_vec();
        let moved = mean.iter().zip(&self.zero).map(|(new, old)| new - old).collect();
        file.noise = Some(noise);
        file.validate()?;
        Ok(Tared { file, samples, moved, load_before, warnings })
    }
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
        let tared = file().tared_by(&signals).unwrap();
        for j in 0..6 {
            assert!((tared.file.zero[j] - j as f64).abs() < 0.001);
            assert!((tared.file.noise.as_ref().unwrap()[j] - 0.01).abs() < 0.001);
            // A reading of 2 V is the nominal load of 10.
            assert!((tared.load_before[j] - 5.0 * (j as f64 - 0.5)).abs() < 0.01);
        }
        assert!(tared.warnings.is_empty());
        let mut moving = signals;
        for i in 0..2000 {
            moving[(i, 3)] += i as f64 * 1e-4;
        }
        assert!(file().tared_by(&moving).unwrap().warnings[0].contains("gauge 4"));
    }

    /// Readings that alternate by ±1 about a level that changes by `step` halfway.
    fn stepped(samples: usize, step: f64) -> DMatrix<f64> {
        DMatrix::from_fn(samples, 6, |i, j| {
            let noise = if i % 2 == 0 { 1.0 } else { -1.0 };
            noise + if j == 2 && 2 * i >= samples { step } else { 0.0 }
        })
    }

    fn is_said_to_drift(samples: usize, step: f64) -> bool {
        let warnings = file().tared_by(&stepped(samples, step)).unwrap().warnings;
        assert!(warnings.iter().all(|warning| warning.starts_with("gauge 3: ")), "{warnings:?}");
        !warnings.is_empty()
    }

    /// The deviation of all readings is √(1 + d²/4) · √(n/(n−1)) with a step of d. Of many readings it is one
    /// deviation that the step must exceed: d > 2/√3. Of 36 it is five standard errors of the difference of the
    /// halves, 10/√36 of a deviation: d² (1 − 25/36 · 36/35) > 25/9 · 36/35.
    #[test]
    fn drift_is_warned_of_in_both_directions() {
        let few = (20.0_f64 / 7.0 / (1.0 - 5.0 / 7.0)).sqrt();
        // Of 10 000 readings n/(n−1) changes the fourth digit.
        for (samples, least) in [(10_000, 2.0 / 3.0_f64.sqrt()), (36, few)] {
            for sign in [1.0, -1.0] {
                assert!(is_said_to_drift(samples, sign * 1.001 * least), "{samples} {sign}");
                assert!(!is_said_to_drift(samples, sign * 0.999 * least), "{samples} {sign}");
            }
        }
        // A step of one deviation to the last bit is not more: numbers whose squares make it 22.
        let mut exact = vec![0.0];
        exact.extend((0..120).map(|i| if i % 2 == 0 { 19.0 } else { -19.0 }));
        exact.extend([-41.0, 4.0, 10.0, 12.0, 15.0].map(|noise| 22.0 + noise));
        exact.extend((0..116).map(|i| if i % 2 == 0 { 41.0 } else { 3.0 }));
        let readings =
            |last: f64| {
                DMatrix::from_fn(242, 6, |i, j| {
                    if j == 0 { exact[i] + if i == 241 { last } else { 0.0 } } else { 0.0 }
                })
            };
        let tared = file().tared_by(&readings(0.0)).unwrap();
        assert_eq!((tared.file.noise.as_ref().unwrap()[0], tared.warnings.len()), (22.0, 0));
        assert_eq!(file().tared_by(&readings(1.0)).unwrap().warnings.len(), 1);
        // A ramp, up and down.
        for slope in [1e-2, -1e-2] {
            let ramp = DMatrix::from_fn(1000, 6, |i, j| if j == 4 { slope * i as f64 } else { 0.0 });
            let warnings = file().tared_by(&ramp).unwrap().warnings;
            assert!(warnings.len() == 1 && warnings[0].starts_with("gauge 5: "), "{warnings:?}");
        }
        // Readings that do not change at all are at rest.
        assert!(file().tared_by(&DMatrix::from_element(10, 6, 3.0)).unwrap().warnings.is_empty());
    }

    /// Two readings: their mean, half their difference times √2, and what changed.
    #[test]
    fn two_readings_are_enough() {
        let mut before = file();
        before.range = Some([-10.0, 10.0]);
        let signals = DMatrix::from_fn(2, 6, |i, j| j as f64 + 1e6 * f64::EPSILON * i as f64);
        let tared = before.tared_by(&signals).unwrap();
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
        assert!(matches!(before.tared_by(&end), Err(RestError::Saturated { gauge: 2 })));
        end.row_mut(1).fill(9.9);
        assert!(before.tared_by(&end).is_ok());
        let low = DMatrix::from_element(3, 6, -10.0);
        assert!(matches!(before.tared_by(&low), Err(RestError::Saturated { gauge: 1 })));
        let five = DMatrix::zeros(3, 5);
        let error = before.tared_by(&five).unwrap_err();
        assert!(
            matches!(error, RestError::Calibration(FileError::WrongGauges { found: 6, expected: 5 })),
            "{error}"
        );
    }

    #[test]
    fn mistakes_are_named() {
        let text = "v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n1,2,3,4,5,6\n1,2,3,4,5,6\n";
        assert_eq!(file().tared(text.as_bytes(), None).unwrap().file.zero[4], 5.0);
        let counts = text.replace("_V", "_count");
        assert!(matches!(file().tared(counts.as_bytes(), None), Err(RestError::WrongUnit { .. })));
        assert!(matches!(file().tared("v1_V\n1\n2\n".as_bytes(), None), Err(RestError::Calibration(_))));
        assert!(matches!(file().tared("a\n1\n".as_bytes(), None), Err(RestError::Recording(_))));
        let mut ranged = file();
        ranged.range = Some([-5.0, 5.0]);
        assert!(matches!(ranged.tared(text.as_bytes(), None), Err(RestError::Saturated { gauge: 5 })));
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
        assert!(needs(drifting.tared(text.as_bytes(), None).unwrap_err()));
        assert!(needs(drifting.tared_by(&DMatrix::zeros(3, 6)).unwrap_err()));
        for wrong in [f64::NAN, f64::INFINITY] {
            assert!(needs(drifting.tared(text.as_bytes(), Some(wrong)).unwrap_err()), "{wrong}");
        }
        let warm =
            "v1_V,v2_V,v3_V,v4_V,v5_V,v6_V,temperature_C\n1,1,1,1,1,1,22\n1.05,1.05,1.05,1.05,1.05,1.05,27\n";
        assert!((drifting.tared(warm.as_bytes(), None).unwrap().file.zero[2] - 0.98).abs() < 1e-12);
        assert!((drifting.tared(text.as_bytes(), Some(25.0)).unwrap().file.zero[4] - 4.95).abs() < 1e-12);
        let one = DMatrix::from_element(1, 6, 0.0);
        assert!(matches!(file().tared_by(&one), Err(RestError::TooFewSamples { samples: 1 })));
    }
}
