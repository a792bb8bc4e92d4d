//! The covariance that a calibration file holds, against the fits that it stands for and the spread of many.

use fingertip_calibration::file::{CalibrationFile, Covariance, SignalUnit};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Direction, Method, Options, SensorModel};
use fingertip_calibration::nalgebra::{DMatrix, DVector};
use fingertip_calibration::{Axis, calibrate};
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::coverage::{Coverage, LONG, SHORT};
use super::random::{gaussians, sensor};
use super::testing::Largest as _;

const NOMINAL: [f64; 3] = [2.0, 3.0, 0.5];

/// Loads by weights, wrong by a share of themselves: errors that differ from sample to sample.
fn weighed() -> Options {
    let method = Method::GaussHelmert {
        load_deviations: vec![0.004, 0.006, 0.001],
        relative: 0.08,
        signal_deviations: vec![0.01, 0.02, 0.03, 0.04],
    };
    Options { nominal: Some(NOMINAL.to_vec()), method, ..Options::default() }
}

/// A table of noisy readings under loads that are not what they are said to be.
fn table(random: &mut Pcg64Mcg, shares: &DMatrix<f64>, truth: &DMatrix<f64>) -> LoadTable {
    let noise = DMatrix::from_fn(shares.nrows(), 4, |_, j| 0.01 * (j + 1) as f64);
    let signals =
        (shares * truth).add_scalar(0.7) + gaussians(random, shares.nrows(), 4).component_mul(&noise);
    let off = gaussians(random, shares.nrows(), 3);
    let fixed = gaussians(random, shares.nrows(), 3) * 0.002;
    let stated = DMatrix::from_fn(shares.nrows(), 3, |i, j| {
        NOMINAL[j] * (shares[(i, j)] * (1.0 + 0.08 * off[(i, j)]) + fixed[(i, j)])
    });
    LoadTable::new(&Axis::FORCES, stated, signals, SignalUnit::Volt).unwrap()
}

fn covariance_of(file: &CalibrationFile) -> &Covariance {
    file.covariance.as_ref().unwrap()
}

/// What the file holds is what the fit says, whole; and it is no product.
#[test]
fn unequal_errors_are_written_whole() {
    let random = &mut Pcg64Mcg::seed_from_u64(301);
    let (truth, shares) = (sensor(random, 3, 4), gaussians(random, 30, 3));
    let calibration = calibrate(&table(random, &shares, &truth), &weighed()).unwrap();
    let text = calibration.to_file().unwrap().to_toml().unwrap();
    assert!(text.contains("version = 2"));
    let file = CalibrationFile::from_toml(&text).unwrap();
    let (covariance, fit) = (covariance_of(&file), &calibration.model.fit);
    let (deviations, full) = (fit.deviations(), fit.full_covariance.as_ref().unwrap());
    let mut unlike = 0.0_f64;
    for (gauge, axis) in (0..4).flat_map(|gauge| (0..3).map(move |axis| (gauge, axis))) {
        let variance = covariance.between((gauge, axis), (gauge, axis)).unwrap();
        assert!((variance.sqrt() / deviations[(axis, gauge)] - 1.0).abs() < 1e-12);
        // Four regressors to a gauge: the constant is one.
        let other = covariance.between((gauge, axis), (3, 1)).unwrap();
        assert_eq!(other, full[(4 * gauge + axis, 13)]);
        let product = covariance.signals[(gauge, gauge)] * covariance.loads[(axis, axis)];
        unlike = unlike.max((variance / product - 1.0).abs());
    }
    assert!(unlike > 0.2, "{unlike}");
    // A load, by its definition as the covariance of C x.
    let load = DVector::from_vec(vec![0.5, -1.0, 0.25]);
    let of_load = DMatrix::from_fn(4, 12, |i, entry| if entry / 3 == i { load[entry % 3] } else { 0.0 });
    let expected = &of_load * covariance.all() * of_load.transpose();
    assert!((covariance.of_signals(&load) - &expected).largest() < 1e-12 * expected.amax());
}

/// Intervals by the covariance of the file hold the truth, of entries and of what the sensor reads under a load.
fn hold(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(302);
    let (truth, shares) = (sensor(random, 3, 4), gaussians(random, 60, 3));
    let load = DVector::from_vec(vec![0.5, -1.0, 0.25]);
    Coverage::over(trials, || {
        let calibration = calibrate(&table(random, &shares, &truth), &weighed()).ok()?;
        let file = calibration.to_file().unwrap();
        let covariance = covariance_of(&file);
        let off = &file.matrix - truth.transpose();
        let of_load = covariance.of_signals(&load);
        let (mut errors, mut widths) = (Vec::new(), Vec::new());
        for gauge in 0..4 {
            errors.push((off.row(gauge) * &load)[(0, 0)]);
            widths.push(1.97 * of_load[(gauge, gauge)].sqrt());
            for axis in 0..3 {
                errors.push(off[(gauge, axis)]);
                widths.push(1.97 * covariance.between((gauge, axis), (gauge, axis))?.sqrt());
            }
        }
        Some((errors, widths))
    })
    .holds("a calibration file of loads wrong by 8 % of themselves");
}

#[test]
fn intervals_of_a_file_hold() {
    hold(SHORT);
}

#[test]
#[ignore = "long: 2 000 calibrations"]
fn intervals_of_a_file_hold_in_many_trials() {
    hold(LONG);
}

/// With more gauges than axes the matrix is a pseudo-inverse: against its own small differences.
#[test]
fn an_inverted_fit_of_more_gauges_is_carried_over() {
    let random = &mut Pcg64Mcg::seed_from_u64(303);
    let signals = gaussians(random, 25, 5);
    let loads = (&signals * sensor(random, 5, 3)).add_scalar(0.3) + gaussians(random, 25, 3) * 0.05;
    let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt).unwrap();
    let direction = Direction::LoadsFromSignals;
    let options = Options { direction, nominal: Some(NOMINAL.to_vec()), ..Options::default() };
    let model = calibrate(&table, &options).unwrap().model;
    let entries = |model: &SensorModel| {
        let matrix = model.matrix_and_zero().unwrap().0;
        DVector::from_column_slice(matrix.transpose().as_slice())
    };
    let mut slope = DMatrix::zeros(15, 15);
    for k in 0..15 {
        let moved = |by: f64| {
            let mut moved = model.clone();
            moved.fit.coefficients[(k % 5, k / 5)] += by;
            entries(&moved)
        };
        slope.set_column(k, &((moved(1e-5) - moved(-1e-5)) / 2e-5));
    }
    let fit = &model.fit;
    let of_fit = DMatrix::from_fn(15, 15, |a, b| {
        fit.inverse_gram[(a % 5, b % 5)] * fit.residual_covariance[(a / 5, b / 5)]
    });
    let expected = &slope * of_fit * slope.transpose();
    let found = model.covariance().unwrap().all();
    assert!((found - &expected).largest() < 1e-6 * expected.largest());
}
