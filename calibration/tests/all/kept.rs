//! What a calibration keeps in its file, and what methods make of an earlier one.

use fingertip_calibration::Axis;
use fingertip_calibration::calibrate;
use fingertip_calibration::design::{DesignTouch, TouchSet};
use fingertip_calibration::file::{CalibrationFile, SignalUnit};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Curvature, Direction, Method, Options};
use fingertip_calibration::nalgebra::{DMatrix, DVector};
use fingertip_calibration::report::ContactReport;
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::{gaussian, gaussians, sensor};
use super::testing::Largest as _;

const NOMINAL: [f64; 3] = [2.0, 4.0, 0.5];

/// Loads and readings of four gauges with noise.
fn noisy(seed: u64) -> (LoadTable, DMatrix<f64>) {
    let random = &mut Pcg64Mcg::seed_from_u64(seed);
    let (loads, truth) = (gaussians(random, 25, 3), sensor(random, 3, 4));
    let signals = (&loads * &truth).add_scalar(0.7) + gaussians(random, 25, 4) * 0.05;
    (LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt).unwrap(), truth)
}

/// The loads in nominal loads, and the constant.
fn regressors(table: &LoadTable, bias: bool) -> DMatrix<f64> {
    let loads = DMatrix::from_fn(table.samples(), 3, |i, j| table.loads[(i, j)] / NOMINAL[j]);
    if bias { loads.insert_column(3, 1.0) } else { loads }
}

#[test]
fn the_file_has_matrix_covariance_and_quality() {
    for bias in [true, false] {
        let (table, _) = noisy(201);
        let options = Options { bias, nominal: Some(NOMINAL.to_vec()), ..Options::default() };
        let calibration = calibrate(&table, &options).unwrap();
        let file = calibration.to_file().unwrap();
        // The normal equations: a fair oracle while all is well conditioned.
        let x = regressors(&table, bias);
        let inverse = (x.transpose() * &x).try_inverse().unwrap();
        let theta = &inverse * x.transpose() * &table.signals;
        let left = &table.signals - &x * &theta;
        let noise = left.transpose() * &left / (25 - x.ncols()) as f64;
        assert!((&file.matrix - theta.rows(0, 3).transpose()).largest() < 1e-12);
        let zero = if bias { theta.row(3).into_owned() } else { theta.row(0) * 0.0 };
        assert!(file.zero.iter().zip(zero.iter()).all(|(a, b)| (a - b).abs() < 1e-12), "{:?}", file.zero);
        let covariance = file.covariance.as_ref().unwrap();
        assert!((&covariance.signals - noise).largest() < 1e-14);
        assert!((&covariance.loads - inverse.view((0, 0), (3, 3))).largest() < 1e-13);
        assert_eq!((file.nominal.as_slice(), file.axes.as_slice()), (&NOMINAL[..], &Axis::FORCES[..]));
        // What the report found.
        let report = &calibration.report;
        assert_eq!((file.quality.verdict, &file.quality.reasons), (report.verdict, &report.reasons));
        assert_eq!(
            (file.quality.samples, file.quality.condition_number),
            (Some(25), report.condition_number)
        );
        let (rms, greatest, left_out) = (
            file.quality.rms_percent.unwrap(),
            file.quality.greatest_percent.unwrap(),
            file.quality.left_out_percent,
        );
        for (j, axis) in report.axes.iter().enumerate() {
            assert_eq!((rms[j], greatest[j]), (axis.rms_percent, axis.greatest_percent));
            assert_eq!(left_out.as_ref().map(|list| list[j]), axis.left_out_percent);
        }
        assert_eq!(file.provenance.method, report.method);
    }
}

/// The sensor found makes the residuals and what it is off the earlier one, each over its variance, least; and the
/// variance of the residuals is that which it leaves.
#[test]
fn a_prior_weighs_as_much_as_is_said() {
    for (bias, relative) in [(false, 0.01), (true, 0.01), (true, 0.1)] {
        let (table, truth) = noisy(202);
        let random = &mut Pcg64Mcg::seed_from_u64(203);
        // Made with other nominal loads.
        let earlier = [1.0, 2.0, 3.0];
        let physical = truth + gaussians(random, 3, 4) * 0.05;
        let of = |nominal: [f64; 3]| DMatrix::from_fn(3, 4, |i, j| physical[(i, j)] * nominal[i]);
        let zero = vec![0.5, 0.6, 0.7, 0.8];
        let prior =
            CalibrationFile::new(of(earlier).transpose(), earlier.to_vec(), zero, SignalUnit::Volt).unwrap();
        let mut center = of(NOMINAL);
        // The root mean square of the matrix.
        let entry = (center.iter().map(|x| x * x).sum::<f64>() / 12.0).sqrt();
        // A zero may be off by a hundred times as much.
        let mut off = vec![relative * entry; 3];
        if bias {
            center = center.insert_row(3, 0.0);
            (0..4).for_each(|j| center[(3, j)] = prior.zero[j]);
            off.push(100.0 * relative * entry);
        }
        let method = Method::Prior { prior: Box::new(prior), relative };
        let options = Options { bias, nominal: Some(NOMINAL.to_vec()), method, ..Options::default() };
        let found = calibrate(&table, &options).unwrap().model.fit.coefficients;
        let x = regressors(&table, bias);
        let left = &table.signals - &x * &found;
        // variance · 25 · 4 = residuals² + variance · Σ (how far off / how far it may be)².
        let pulled: f64 =
            (0..off.len()).map(|i| (found.row(i) - center.row(i)).norm_squared() / off[i].powi(2)).sum();
        let variance = left.norm_squared() / (100.0 - pulled);
        assert!(variance > 0.0, "{pulled}");
        let precision =
            DMatrix::from_fn(
                off.len(),
                off.len(),
                |i, j| if i == j { variance / off[i].powi(2) } else { 0.0 },
            );
        let slope = x.transpose() * left - &precision * (&found - &center);
        assert!(slope.largest() < 1e-9 * (precision * &center).largest(), "{bias} {relative}: {slope}");
    }
}

/// Two samples that RANSAC does not believe: the gauge that is worst off, in deviations of the others.
#[test]
fn what_is_left_out_is_told_in_deviations_of_the_rest() {
    let (mut table, _) = noisy(204);
    let plain = table.clone();
    table.signals[(6, 2)] += 3.0;
    table.signals[(17, 0)] -= 2.0;
    table.signals[(17, 3)] -= 5.0;
    let method = Method::Ransac { outliers: 0.2, seed: 1 };
    let options = Options { nominal: Some(NOMINAL.to_vec()), method, ..Options::default() };
    let found = calibrate(&table, &options).unwrap();
    let good: Vec<usize> = (0..25).filter(|i| ![6, 17].contains(i)).collect();
    let x = regressors(&plain, true);
    let (rows, readings) = (x.select_rows(&good), table.signals.select_rows(&good));
    let theta = (rows.transpose() * &rows).try_inverse().unwrap() * rows.transpose() * &readings;
    let left = &readings - &rows * &theta;
    let off = &table.signals - &x * &theta;
    let told = |sample: usize, gauge: usize| {
        let deviation = (left.column(gauge).norm_squared() / (good.len() - 4) as f64).sqrt();
        let number = off[(sample, gauge)].abs() / deviation;
        format!(
            "RANSAC: gauge {} is off by {number:.1} standard deviations of the samples that agree",
            gauge + 1
        )
    };
    let reasons: Vec<(&str, &str)> =
        found.report.excluded.iter().map(|one| (one.sample.as_str(), one.reason.as_str())).collect();
    assert_eq!(reasons, [("sample 7", told(6, 2).as_str()), ("sample 18", told(17, 3).as_str())]);
    assert_eq!((found.table.samples(), found.model.fit.trust.shape()), (23, (23, 4)));
}

/// Loads from signals: the covariance of the entries of the matrix is that of the coefficients, carried over by
/// differences of the matrix.
#[test]
fn the_covariance_of_an_inverted_fit_is_carried_over() {
    let random = &mut Pcg64Mcg::seed_from_u64(205);
    let signals = gaussians(random, 20, 3);
    let loads = (&signals * sensor(random, 3, 3)).add_scalar(0.3) + gaussians(random, 20, 3) * 0.05;
    let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt).unwrap();
    let direction = Direction::LoadsFromSignals;
    let options = Options { direction, nominal: Some(NOMINAL.to_vec()), ..Options::default() };
    let model = calibrate(&table, &options).unwrap().model;
    let entries = |k: usize, by: f64| {
        let mut moved = model.clone();
        moved.fit.coefficients[(k % 3, k / 3)] += by;
        moved.matrix_and_zero().unwrap().0
    };
    let mut slope = DMatrix::zeros(9, 9);
    for k in 0..9 {
        slope.set_column(
            k,
            &DVector::from_column_slice(((entries(k, 1e-5) - entries(k, -1e-5)) / 2e-5).as_slice()),
        );
    }
    let fit = &model.fit;
    let of_fit = DMatrix::from_fn(9, 9, |a, b| {
        fit.inverse_gram[(a % 3, b % 3)] * fit.residual_covariance[(a / 3, b / 3)]
    });
    let expected = &slope * of_fit * slope.transpose();
    let found = model.covariance().unwrap();
    let found = DMatrix::from_fn(9, 9, |a, b| found.signals[(a % 3, b % 3)] * found.loads[(a / 3, b / 3)]);
    assert!((found - &expected).largest() < 1e-6 * expected.largest());
}

/// Of a bent sensor the zero reads no load, and the matrix is the inverse of the slope there.
#[test]
fn the_matrix_of_a_bent_sensor_is_that_at_its_zero() {
    let random = &mut Pcg64Mcg::seed_from_u64(206);
    let signals = gaussians(random, 40, 3);
    let loads = DMatrix::from_fn(40, 3, |i, j| {
        let s = |k: usize| signals[(i, (j + k) % 3)];
        3.0 * s(0) + 0.5 * s(1) + 0.1 * s(0) * s(0) - 0.2 * s(0) * s(2) + 0.15 * s(1) * s(2) + 0.4
            - 0.3 * j as f64
    });
    let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt).unwrap();
    let direction = Direction::LoadsFromSignals;
    let options = Options {
        direction,
        curvature: Curvature::Quadratic,
        nominal: Some(NOMINAL.to_vec()),
        ..Options::default()
    };
    let model = calibrate(&table, &options).unwrap().model;
    let (matrix, zero) = model.matrix_and_zero().unwrap();
    let said =
        |reading: &DVector<f64>| model.loads(&DMatrix::from_row_slice(1, 3, reading.as_slice())).unwrap();
    assert!(zero.norm() > 0.05 && said(&zero).largest() < 1e-12, "{zero}");
    let mut slope = DMatrix::zeros(3, 3);
    for k in 0..3 {
        let mut step = DVector::zeros(3);
        step[k] = 1e-4;
        let change = (said(&(&zero + &step)) - said(&(&zero - &step))) / 2e-4;
        (0..3).for_each(|j| slope[(j, k)] = change[j] / NOMINAL[j]);
    }
    assert!((&slope * &matrix - DMatrix::identity(3, 3)).largest() < 1e-9);
}

/// Noise of one reading, and of the matrix under the load, as newtons.
#[test]
fn the_covariance_of_a_load_has_the_reading_and_the_matrix() {
    let (table, _) = noisy(207);
    let options = Options { bias: false, nominal: Some(NOMINAL.to_vec()), ..Options::default() };
    let model = calibrate(&table, &options).unwrap().model;
    let x = regressors(&table, false);
    let inverse = (x.transpose() * &x).try_inverse().unwrap();
    let theta = &inverse * x.transpose() * &table.signals;
    let left = &table.signals - &x * &theta;
    let noise = left.transpose() * &left / 22.0;
    // Loads from readings, in N: least squares of each reading.
    let mut from_signals = (&theta * theta.transpose()).try_inverse().unwrap() * &theta;
    (0..3).for_each(|j| from_signals.row_mut(j).scale_mut(NOMINAL[j]));
    for load in [[0.0, 0.0, 0.0], [2.0, -3.0, 0.25], [-8.0, 1.0, 2.0]] {
        let share = DVector::from_fn(3, |j, _| load[j] / NOMINAL[j]);
        let more = 1.0 + share.dot(&(&inverse * &share));
        let expected = &from_signals * &noise * from_signals.transpose() * more;
        let found = model.load_covariance().unwrap().at(&load);
        assert!((found - &expected).largest() < 1e-11 * expected.largest());
    }
}

/// Of many touches the figures are root mean squares of those of each, and the worst is the greatest.
#[test]
fn touches_together_are_the_mean_and_the_worst_of_each() {
    let random = &mut Pcg64Mcg::seed_from_u64(208);
    let nominal = [5.0, 5.0, 5.0, 0.05, 0.05, 0.05];
    let loads = DMatrix::from_fn(20, 6, |_, j| nominal[j] * gaussian(random));
    let shares = DMatrix::from_fn(20, 6, |i, j| loads[(i, j)] / nominal[j]);
    let signals = shares * sensor(random, 6, 7) + gaussians(random, 20, 7) * 1e-3;
    let table = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap();
    let mut touches: Vec<DesignTouch> =
        DesignTouch::on_sphere(0.01, 1.4, 0.5, 5.0).unwrap().into_iter().step_by(97).collect();
    // One of another size, neither first nor last.
    touches[5].force *= 0.3;
    let told = |touches: &[DesignTouch]| {
        let set = TouchSet { surface: "a sphere".to_owned(), touches: touches.to_vec() };
        let options = Options { touches: Some(set), nominal: Some(nominal.to_vec()), ..Options::default() };
        calibrate(&table, &options).unwrap().report.contacts.unwrap()
    };
    let all = told(&touches);
    let each: Vec<_> = touches.iter().map(|touch| told(core::slice::from_ref(touch))).collect();
    let near =
        |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    let count = touches.len() as f64;
    let mean = |of: &dyn Fn(&ContactReport) -> f64| {
        (each.iter().map(|one| of(one).powi(2)).sum::<f64>() / count).sqrt()
    };
    near(all.calibration_mm, mean(&|one| one.calibration_mm));
    near(all.reading_mm, mean(&|one| one.reading_mm));
    near(all.together_mm, mean(&|one| one.together_mm));
    near(all.worst_mm, each.iter().map(|one| one.together_mm).fold(0.0, f64::max));
    near(all.force, touches.iter().map(|touch| touch.force.norm()).sum::<f64>() / count);
    for one in &each {
        near(one.worst_mm, one.together_mm);
        near(one.together_mm, one.calibration_mm.hypot(one.reading_mm));
    }
    assert!(all.worst_mm > 1.2 * all.together_mm);
}
