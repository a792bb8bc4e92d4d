//! Whole tables: quadratic sensors, partial sessions, samples that do not agree. Exact without noise, errors
//! as stated, and the same in any units, order and frame.

use fingertip_calibration::Axis;
use fingertip_calibration::calibrate;
use fingertip_calibration::file::{CalibrationFile, SignalUnit};
use fingertip_calibration::loads::{LoadError, LoadTable};
use fingertip_calibration::model::{Curvature, Direction, Method, Options, StreamedFit};
use fingertip_calibration::nalgebra::{DMatrix, DVector};
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::{gaussians, sensor, turn};
use super::spread::Spread;
use super::testing::Largest as _;

/// Quadratic loads of three gauges: bent, with cross-terms and a constant.
fn bent(signals: &DMatrix<f64>, linear: &DMatrix<f64>, second: &DMatrix<f64>) -> DMatrix<f64> {
    let products = DMatrix::from_fn(signals.nrows(), 6, |i, k| {
        let (a, b) = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)][k];
        signals[(i, a)] * signals[(i, b)]
    });
    (signals * linear + products * second).add_scalar(0.2)
}

fn quadratic() -> Options {
    Options {
        direction: Direction::LoadsFromSignals,
        curvature: Curvature::Quadratic,
        nominal: Some(vec![1.0; 3]),
        ..Options::default()
    }
}

fn forces(loads: &DMatrix<f64>, signals: &DMatrix<f64>) -> LoadTable {
    LoadTable::new(&Axis::FORCES, loads.clone(), signals.clone(), SignalUnit::Volt).unwrap()
}

/// Coefficients as the model has them: linear, products, constant.
fn all(linear: &DMatrix<f64>, second: &DMatrix<f64>) -> DMatrix<f64> {
    let mut all = linear.clone().resize(10, 3, 0.2);
    all.view_mut((3, 0), (6, 3)).copy_from(second);
    all
}

#[test]
fn quadratic_sensors_come_back_with_errors_as_stated() {
    let random = &mut Pcg64Mcg::seed_from_u64(71);
    let (linear, second) = (sensor(random, 3, 3), gaussians(random, 6, 3) * 0.2);
    let signals = gaussians(random, 30, 3);
    let clean = bent(&signals, &linear, &second);
    let truth = all(&linear, &second);
    let fit = calibrate(&forces(&clean, &signals), &quadratic()).unwrap().model.fit;
    assert!((fit.coefficients - &truth).largest() < 1e-12);
    let spread = Spread::over(600, || {
        let loads = &clean + gaussians(random, 30, 3) * 0.01;
        let fit = calibrate(&forces(&loads, &signals), &quadratic()).unwrap().model.fit;
        let variances = fit.inverse_gram.diagonal() * fit.residual_covariance.diagonal().transpose();
        ((fit.coefficients - &truth).as_slice().to_vec(), variances.as_slice().to_vec())
    });
    spread.agrees_in_the_mean("quadratic");
}

/// Forces turned and in other units, signals in other units, samples in another order: the same loads.
#[test]
fn quadratic_sensors_do_not_mind_units_order_and_frames() {
    let random = &mut Pcg64Mcg::seed_from_u64(72);
    for _ in 0..10 {
        let (linear, second) = (sensor(random, 3, 3), gaussians(random, 6, 3) * 0.2);
        let signals = gaussians(random, 30, 3);
        let loads = bent(&signals, &linear, &second) + gaussians(random, 30, 3) * 0.01;
        let order: Vec<usize> = (0..30).map(|i| (7 * i + 3) % 30).collect();
        let frame = turn(random);
        let frame = DMatrix::from_column_slice(3, 3, frame.as_slice());
        let turned = loads.select_rows(&order) * &frame * 1e3;
        let one = calibrate(&forces(&loads, &signals), &quadratic()).unwrap();
        let table = forces(&turned, &(signals.select_rows(&order) * 1e-4));
        let options = Options { nominal: Some(vec![1e3; 3]), ..quadratic() };
        let two = calibrate(&table, &options).unwrap();
        let unseen = gaussians(random, 5, 3);
        let (a, b) = (one.model.loads(&unseen).unwrap(), two.model.loads(&(&unseen * 1e-4)).unwrap());
        // Rounding of the constant column beside squares of signals.
        assert!((b * frame.transpose() / 1e3 - a).largest() < 1e-10);
        let trace = |calibration: &fingertip_calibration::Calibration| {
            calibration.model.fit.residual_covariance.trace()
        };
        assert!((trace(&two) / trace(&one) - 1.0).abs() < 1e-9);
    }
}

/// Two sessions, forces in one and torques in the other, each with a zero of its own.
fn sessions(random: &mut Pcg64Mcg, truth: &DMatrix<f64>) -> Vec<LoadTable> {
    [0, 3]
        .into_iter()
        .map(|blind| {
            let mut loads = gaussians(random, 15, 6);
            loads.columns_mut(blind, 3).fill(0.0);
            let signals = (&loads * truth).add_scalar(blind as f64 + 1.0);
            LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap()
        })
        .collect()
}

fn merged(sessions: &[LoadTable], nominal: f64) -> fingertip_calibration::fit::Fit {
    let options = Options { bias: false, nominal: Some(vec![nominal; 6]), ..Options::default() };
    calibrate(&LoadTable::merged(sessions).unwrap().centred_by_group(), &options).unwrap().model.fit
}

#[test]
fn merged_sessions_have_errors_as_stated() {
    let random = &mut Pcg64Mcg::seed_from_u64(73);
    let truth = sensor(random, 6, 6);
    let clean = sessions(random, &truth);
    assert!((merged(&clean, 1.0).coefficients - &truth).largest() < 1e-12);
    let spread = Spread::over(400, || {
        let mut noisy = clean.clone();
        noisy.iter_mut().for_each(|session| session.signals += gaussians(random, 15, 6) * 0.01);
        let fit = merged(&noisy, 1.0);
        let variances = fit.inverse_gram.diagonal() * fit.residual_covariance.diagonal().transpose();
        ((fit.coefficients - &truth).as_slice().to_vec(), variances.as_slice().to_vec())
    });
    spread.agrees_in_the_mean("merged sessions");
}

/// Three groups of which two are of one sample: their means take as many degrees of freedom as there are, so that
/// nothing is known of the noise. What is stated stays finite.
#[test]
fn without_a_degree_of_freedom_the_statement_is_that_of_the_fit() {
    let loads = DMatrix::from_column_slice(4, 1, &[1.0, 2.0, 5.0, 7.0]);
    let signals = DMatrix::from_column_slice(4, 1, &[2.0, 4.5, 1.0, 3.0]);
    let mut table = LoadTable::new(&[Axis::Fz], loads, signals, SignalUnit::Volt).unwrap();
    table.groups = vec![0, 0, 1, 2];
    let options = Options { bias: false, nominal: Some(vec![1.0]), ..Options::default() };
    // Centred, two samples of ±0.5 N and ±1.25 V are left: the slope fits them exactly.
    let fit = calibrate(&table.centred_by_group(), &options).unwrap().model.fit;
    assert!((fit.coefficients[(0, 0)] - 2.5).abs() < 1e-12);
    assert!((0.0..1e-12).contains(&fit.residual_covariance[(0, 0)]), "{}", fit.residual_covariance);
    table.groups = vec![0, 0, 0, 1];
    // Here one degree is left of three: all of the residuals, which centring left, are its.
    let centred = table.centred_by_group();
    let fit = calibrate(&centred, &options).unwrap().model.fit;
    let left = &centred.signals - &centred.loads * &fit.coefficients;
    assert!((fit.residual_covariance[(0, 0)] / left.norm_squared() - 1.0).abs() < 1e-12);
}

/// Each group has a zero of one reading or two, and loads to one side only, which that spoils most.
#[test]
fn tared_groups_have_errors_as_stated() {
    let random = &mut Pcg64Mcg::seed_from_u64(77);
    let truth = sensor(random, 3, 3);
    let mut loads = gaussians(random, 30, 3).abs();
    [0, 1, 10, 20].into_iter().for_each(|i| loads.row_mut(i).fill(0.0));
    let mut clean = forces(&loads, &(&loads * &truth).add_scalar(2.0));
    clean.groups = (0..30).map(|i| i / 10).collect();
    let nominal = Some(vec![1.0; 3]);
    let options = Options { bias: false, tare_groups: true, nominal, ..Options::default() };
    let fitted = |table: &LoadTable| calibrate(table, &options).unwrap().model.fit;
    assert!((fitted(&clean).coefficients - &truth).largest() < 1e-12);
    let spread = Spread::over(800, || {
        let mut noisy = clean.clone();
        noisy.signals += gaussians(random, 30, 3) * 0.01;
        let fit = fitted(&noisy);
        let variances = fit.inverse_gram.diagonal() * fit.residual_covariance.diagonal().transpose();
        let mut errors = (fit.coefficients - &truth).as_slice().to_vec();
        let mut stated = variances.as_slice().to_vec();
        errors.extend(fit.residual_covariance.diagonal().map(f64::sqrt).iter());
        stated.extend([1e-4; 3]);
        (errors, stated)
    });
    spread.agrees_in_the_mean("tared groups");
}

#[test]
fn merged_sessions_do_not_mind_units_order_and_frames() {
    let random = &mut Pcg64Mcg::seed_from_u64(74);
    let truth = sensor(random, 6, 6);
    let mut some = sessions(random, &truth);
    some.iter_mut().for_each(|session| session.signals += gaussians(random, 15, 6) * 0.01);
    let mut frame = DMatrix::zeros(6, 6);
    let rotation = turn(random);
    for k in [0, 3] {
        frame.view_mut((k, k), (3, 3)).copy_from(&rotation);
    }
    let other: Vec<LoadTable> = some
        .iter()
        .rev()
        .map(|session| {
            let order: Vec<usize> = (0..15).rev().collect();
            let loads = session.loads.select_rows(&order) * &frame * 1e3;
            let signals = session.signals.select_rows(&order) * 1e-4;
            LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap()
        })
        .collect();
    let (one, two) = (merged(&some, 1.0), merged(&other, 1e3));
    assert!((frame * two.coefficients * 1e4 - one.coefficients).largest() < 1e-11);
}

/// Bad samples leave the others exact, whatever they are and how few there are to tell the noise from.
#[test]
fn samples_that_agree_are_fitted_exactly() {
    let random = &mut Pcg64Mcg::seed_from_u64(75);
    for _ in 0..20 {
        let truth = sensor(random, 6, 6);
        let loads = gaussians(random, 30, 6);
        let mut signals = &loads * &truth;
        for i in [4, 11, 23] {
            signals[(i, i % 6)] += 3.0;
        }
        let table = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap();
        let method = Method::Ransac { outliers: 0.2, seed: 1 };
        let nominal = Some(vec![1.0; 6]);
        let found =
            calibrate(&table, &Options { method, bias: false, nominal, ..Options::default() }).unwrap();
        assert!((found.model.fit.coefficients - &truth).largest() < 1e-12);
        let named: Vec<&str> = found.report.excluded.iter().map(|sample| sample.sample.as_str()).collect();
        assert_eq!(named, ["sample 5", "sample 12", "sample 24"]);
    }
}

/// Streaming gives what all at once gives, in any units and order.
#[test]
fn streamed_fits_leave_out_what_has_another_length() {
    let mut fit = StreamedFit::new(&[Axis::Fx, Axis::Fz], 3, SignalUnit::Volt, true);
    for (load, signals) in [(&[1.0][..], &[1.0; 3][..]), (&[1.0; 3], &[1.0; 3]), (&[1.0; 2], &[1.0; 2])] {
        assert!(!fit.push(load, signals, 1.0), "{load:?} {signals:?}");
    }
    assert!(fit.push(&[1.0, 2.0], &[1.0; 3], 1.0));
}

#[test]
fn streamed_fits_do_not_mind_units_order_and_frames() {
    let random = &mut Pcg64Mcg::seed_from_u64(76);
    let truth = sensor(random, 6, 6);
    let loads = gaussians(random, 500, 6);
    let signals = &loads * &truth + gaussians(random, 500, 6) * 0.01;
    let rotation = turn(random);
    let mut frame = DMatrix::zeros(6, 6);
    for k in [0, 3] {
        frame.view_mut((k, k), (3, 3)).copy_from(&rotation);
    }
    let fitted = |loads: &DMatrix<f64>, signals: &DMatrix<f64>, nominal: f64, backwards: bool| {
        let mut fit = StreamedFit::new(&Axis::ALL, 6, SignalUnit::Volt, true);
        for i in 0..500 {
            let i = if backwards { 499 - i } else { i };
            let row = |m: &DMatrix<f64>| m.row(i).iter().copied().collect::<Vec<_>>();
            assert!(fit.push(&row(loads), &row(signals), 1.0));
        }
        fit.finish(Some(&[nominal; 6])).unwrap().matrix_and_zero().unwrap()
    };
    let (matrix, zero): (DMatrix<f64>, DVector<f64>) = fitted(&loads, &signals, 1.0, false);
    let (other, offset) = fitted(&(&loads * &frame * 1e3), &(&signals * 1e-4), 1e3, true);
    assert!((other * frame.transpose() * 1e4 - matrix).largest() < 1e-12);
    assert!((offset * 1e4 - zero).largest() < 1e-13);
}

/// Readings of two groups that take turns: each has its own zero, and its own mean.
#[test]
fn groups_may_take_turns() {
    let loads = DMatrix::from_column_slice(6, 1, &[0.0, 0.0, 2.0, 3.0, 0.0, 6.0]);
    let signals = DMatrix::from_column_slice(6, 1, &[1.0, 10.0, 5.0, 16.0, 2.0, 22.0]);
    let mut table = LoadTable::new(&[Axis::Fz], loads, signals, SignalUnit::Volt).unwrap();
    table.groups = vec![7, 2, 7, 2, 7, 2];
    // At rest the one reads 1 V and 2 V, the other 10 V.
    let tared = table.tared_by_group().unwrap();
    assert_eq!(tared.signals.as_slice(), [-0.5, 0.0, 3.5, 6.0, 0.5, 12.0]);
    assert_eq!(tared.loads, table.loads);
    table.weights = Some(vec![1.0, 1.0, 2.0, 1.0, 1.0, 2.0]);
    let centred = table.centred_by_group();
    // Weighted means: 3.25 V and 1 N, 17.5 V and 3.75 N.
    assert_eq!(centred.signals.as_slice(), [-2.25, -7.5, 1.75, -1.5, -1.25, 4.5]);
    assert_eq!(centred.loads.as_slice(), [-1.0, -3.75, 1.0, -0.75, -1.0, 2.25]);
}

/// A load cell of one axis, and any other choice of axes.
#[test]
fn sensors_of_any_axes_are_written() {
    let random = &mut Pcg64Mcg::seed_from_u64(101);
    for axes in [
        &[Axis::Fz][..],
        &[Axis::Fx, Axis::Fy],
        &[Axis::Fx, Axis::Fy, Axis::Tz],
        &[Axis::Fz, Axis::Tx, Axis::Ty, Axis::Tz],
        &Axis::ALL[..5],
    ] {
        let loads = gaussians(random, 30, axes.len());
        let signals =
            &loads * sensor(random, axes.len(), axes.len()) + gaussians(random, 30, axes.len()) * 0.001;
        let table = LoadTable::new(axes, loads, signals, SignalUnit::Volt).unwrap();
        let file = calibrate(&table, &Options::default()).unwrap().to_file().unwrap();
        assert_eq!(file.axes, axes);
        assert_eq!(CalibrationFile::from_toml(&file.to_toml().unwrap()).unwrap(), file);
    }
}

/// A number that is none is named by its sample and its column, wherever it stands.
#[test]
fn numbers_that_are_none_are_named() {
    let good = forces(&DMatrix::identity(4, 3), &DMatrix::identity(4, 5));
    assert_eq!(good.validate(), Ok(()));
    for bad in [f64::NAN, f64::INFINITY] {
        for (axis, name) in ["fx", "fy", "fz"].into_iter().enumerate() {
            let mut table = good.clone();
            table.loads[(2, axis)] = bad;
            let error = table.validate().unwrap_err().to_string().to_lowercase();
            assert!(error.contains(&*table.names.get(2)) && error.contains(name), "{error}");
        }
        let mut table = good.clone();
        table.signals[(3, 4)] = bad;
        let error = table.validate().unwrap_err().to_string();
        assert!(error.contains(&*table.names.get(3)) && error.contains("v5"), "{error}");
    }
}

/// What a fit expects lines of action to be off by is what they are off by, in sessions like those that it was
/// fitted to: pure forces on lines through the touch, gauges with noise.
#[test]
fn lines_are_off_by_what_is_expected() {
    let random = &mut Pcg64Mcg::seed_from_u64(77);
    let (mut found, mut expected) = (0.0, 0.0);
    for _ in 0..40 {
        let matrix = sensor(random, 6, 6);
        let (points, pushes) = (gaussians(random, 60, 3), gaussians(random, 60, 3));
        let loads = DMatrix::from_fn(60, 6, |i, j| {
            let at = |k: usize| (points[(i, k % 3)], pushes[(i, k % 3)]);
            if j < 3 { at(j).1 } else { at(j + 1).0 * at(j + 2).1 - at(j + 2).0 * at(j + 1).1 }
        });
        let signals = &loads * &matrix + gaussians(random, 60, 6) * 1e-3;
        let table = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap();
        let lines = calibrate(&table, &Options::default()).unwrap().report.lines.unwrap();
        assert_eq!(lines.lines, 60);
        found += lines.median_mm.ln() / 40.0;
        expected += lines.expected_mm.unwrap().ln() / 40.0;
    }
    // Residuals of a fit are less than errors, medians less than root mean squares.
    let ratio = (found - expected).exp();
    println!("lines off by {ratio:.2} of what is expected");
    assert!(ratio > 0.5 && ratio < 1.2, "{ratio}");
}

/// Times, temperatures and orientations stay where all sessions have them; weights are 1 where none are said.
#[test]
fn merged_sessions_keep_what_all_of_them_say() {
    let plain = forces(&DMatrix::identity(3, 3), &DMatrix::identity(3, 4));
    let told = |first: f64| LoadTable {
        times: Some(vec![first, first + 1.0, first + 2.0]),
        temperatures: Some(vec![20.0 + first; 3]),
        orientations: Some(vec![[0.0, 0.0, 0.0, 1.0 + first]; 3]),
        weights: Some(vec![2.0 + first; 3]),
        ..plain.clone()
    };
    let both = LoadTable::merged(&[told(0.0), told(5.0)]).unwrap();
    assert_eq!(both.validate(), Ok(()));
    assert_eq!(both.times.unwrap(), [0.0, 1.0, 2.0, 5.0, 6.0, 7.0]);
    assert_eq!(both.temperatures.unwrap(), [20.0, 20.0, 20.0, 25.0, 25.0, 25.0]);
    assert_eq!(both.orientations.unwrap().len(), 6);
    assert_eq!(both.weights.unwrap(), [2.0, 2.0, 2.0, 7.0, 7.0, 7.0]);
    for sessions in [[told(0.0), plain.clone()], [plain.clone(), told(0.0)]] {
        let some = LoadTable::merged(&sessions).unwrap();
        assert_eq!(some.validate(), Ok(()));
        assert_eq!((some.times, some.temperatures, some.orientations), (None, None, None));
        assert_eq!(some.weights.unwrap().iter().sum::<f64>(), 9.0);
    }
    assert_eq!(LoadTable::merged(&[plain.clone(), plain]).unwrap().weights, None);
}

/// A reading at the end of its range says that the load was more: it is told, and not fitted.
#[test]
fn saturated_readings_are_left_out_of_a_fit() {
    let random = &mut Pcg64Mcg::seed_from_u64(12);
    let loads = gaussians(random, 12, 3);
    let whole = forces(&loads, &(&loads * sensor(random, 3, 3)));
    let mut clipped = whole.clone();
    clipped.signals[(3, 1)] = 40.0;
    let options = Options { range: Some([-40.0, 40.0]), nominal: Some(vec![1.0; 3]), ..Options::default() };
    let (found, expected) = (calibrate(&clipped, &options).unwrap(), calibrate(&whole, &options).unwrap());
    assert_eq!((found.report.samples, expected.report.samples), (11, 12));
    assert!(
        found.report.excluded[0].reason.starts_with("gauge 2 saturated: reading 40 "),
        "{}",
        found.report
    );
    let off = found.model.fit.coefficients - expected.model.fit.coefficients;
    assert!(off.amax() < 1e-12, "{off}");
}

/// Sessions with other axes or of another sensor are named for what does not match.
#[test]
fn sessions_that_do_not_match_are_not_merged() {
    let plain = forces(&DMatrix::identity(3, 3), &DMatrix::identity(3, 4));
    let error = |other: LoadTable| LoadTable::merged(&[plain.clone(), other]).unwrap_err();
    let mut axes = plain.axes.clone();
    axes.swap(0, 1);
    let turned = error(LoadTable { axes, ..plain.clone() });
    assert!(matches!(turned, LoadError::WrongLength { field: "axes", .. }), "{turned}");
    let narrow = error(forces(&DMatrix::identity(3, 3), &DMatrix::identity(3, 3)));
    assert!(matches!(narrow, LoadError::WrongLength { field: "signals", found: 3, expected: 4 }), "{narrow}");
    assert_eq!(LoadTable::merged(&[]).unwrap_err(), LoadError::Empty { what: "sessions" });
}

/// A weight of zero leaves a sample out; a negative one is none.
#[test]
fn weights_may_be_zero() {
    let weighed = |least| LoadTable {
        weights: Some(vec![1.0, least, 1.0]),
        ..forces(&DMatrix::identity(3, 3), &DMatrix::identity(3, 4))
    };
    assert_eq!(weighed(0.0).validate(), Ok(()));
    assert!(weighed(-1e-12).validate().unwrap_err().to_string().contains("weight"));
}
