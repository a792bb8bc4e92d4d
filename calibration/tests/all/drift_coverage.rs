//! Intervals of what is fitted beside a drift with temperature hold the truth as often as they say.

use fingertip_calibration::file::SignalUnit;
use fingertip_calibration::fit::fit_temperature;
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::Options;
use fingertip_calibration::nalgebra::DMatrix;
use fingertip_calibration::{Axis, calibrate};
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;
use statrs::distribution::{ContinuousCDF as _, StudentsT};

use super::coverage::{Coverage, LONG, SHORT, judged};
use super::random::{gaussians, sensor};

const SAMPLES: usize = 30;
const GAUGES: usize = 4;

/// A sensor that drifts, and the temperatures at which it is loaded.
struct Drifting {
    loads: DMatrix<f64>,
    /// Sensor, and its zero in the last row.
    truth: DMatrix<f64>,
    celsius: Vec<f64>,
    /// Slope and curvature of the zero, slope of the gain.
    drift: [f64; 3],
    reference: f64,
    weights: Vec<f64>,
}

impl Drifting {
    fn new(random: &mut Pcg64Mcg, reference: f64) -> Self {
        let mut truth = sensor(random, 3, GAUGES).insert_row(3, 0.0);
        truth.row_mut(3).fill(0.4);
        Self {
            loads: gaussians(random, SAMPLES, 3),
            truth,
            celsius: (0..SAMPLES).map(|i| 15.0 + (i * 7 % SAMPLES) as f64 * 0.7).collect(),
            drift: [0.01, -2e-4, 2e-3],
            reference,
            weights: (0..SAMPLES).map(|i| [1.0, 4.0, 0.25][i % 3]).collect(),
        }
    }

    /// Readings with noise that gauges have in common, less of it where the weight is greater.
    fn signals(&self, random: &mut Pcg64Mcg) -> DMatrix<f64> {
        let common = gaussians(random, SAMPLES, 1);
        let own = gaussians(random, SAMPLES, GAUGES);
        DMatrix::from_fn(SAMPLES, GAUGES, |i, j| {
            let warmer = self.celsius[i] - self.reference;
            let load = self.loads.row(i).transpose().dot(&self.truth.view((0, j), (3, 1)));
            let noise = 0.03 * (0.7 * common[i] + 0.7 * own[(i, j)]) / self.weights[i].sqrt();
            self.truth[(3, j)]
                + self.drift[0] * warmer
                + self.drift[1] * warmer * warmer
                + (1.0 + self.drift[2] * warmer) * load
                + noise
        })
    }
}

/// Reference within the temperatures, at their end, and beyond it.
const REFERENCES: [f64; 3] = [22.0, 35.0, 45.0];

fn of_drifts(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(311);
    for reference in REFERENCES {
        let made = Drifting::new(random, reference);
        // Of three of the loads, the zero and the drift, seven coefficients.
        let student = StudentsT::new(0.0, 1.0, (SAMPLES - 7) as f64).unwrap().inverse_cdf(0.975);
        Coverage::over(trials, || {
            let signals = made.signals(random);
            let fit = fit_temperature(&made.loads, &signals, Some(&made.weights), &made.celsius, reference)
                .unwrap();
            let (mut errors, mut widths) = (Vec::new(), Vec::new());
            for gauge in 0..GAUGES {
                let drift = &fit.temperature;
                let mut off: Vec<f64> =
                    (0..3).map(|axis| fit.matrix[(gauge, axis)] - made.truth[(axis, gauge)]).collect();
                off.push(fit.zero[gauge] - made.truth[(3, gauge)]);
                off.push(drift.zero_drift[gauge] - made.drift[0]);
                off.push(drift.zero_curvature[gauge] - made.drift[1]);
                off.push(drift.gain_drift[gauge] - made.drift[2]);
                errors.append(&mut off);
                widths.extend(fit.covariances[gauge].diagonal().iter().map(|v| student * v.sqrt()));
            }
            Some((errors, widths))
        })
        .holds(&format!("drift about {reference} °C"));
    }
}

/// The matrix and zero of a calibration whose drift was taken off first are as uncertain as those beside the drift.
fn of_calibrations(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(312);
    for reference in REFERENCES {
        let made = Drifting::new(random, reference);
        let options =
            Options { reference_celsius: Some(reference), nominal: Some(vec![1.0; 3]), ..Options::default() };
        Coverage::over(trials, || {
            let mut table =
                LoadTable::new(&Axis::FORCES, made.loads.clone(), made.signals(random), SignalUnit::Volt)
                    .unwrap();
            table.temperatures = Some(made.celsius.clone());
            table.weights = Some(made.weights.clone());
            judged(&calibrate(&table, &options).unwrap().model.fit, &made.truth)
        })
        .holds(&format!("calibration with a drift about {reference} °C"));
    }
}

#[test]
fn intervals_of_drifts_hold() {
    of_drifts(SHORT);
}

#[test]
fn intervals_of_calibrations_with_a_drift_hold() {
    of_calibrations(SHORT);
}

#[test]
#[ignore = "long: 2 000 calibrations of each"]
fn intervals_beside_drifts_hold_in_many_trials() {
    of_drifts(LONG);
    of_calibrations(LONG);
}
