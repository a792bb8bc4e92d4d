//! What fits refuse, and where exactly they begin to.

use fingertip_calibration::Axis;
use fingertip_calibration::calibrate;
use fingertip_calibration::experiment::{Information, plan, plan_after};
use fingertip_calibration::file::SignalUnit;
use fingertip_calibration::fit::{FitError, fit_temperature, gauss_helmert, least_squares, leave_out, ridge};
use fingertip_calibration::in_situ::refine;
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::model::{Curvature, Direction, Method, Options};
use fingertip_calibration::nalgebra::DMatrix;
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::{gaussians, sensor};

const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn is_bad_input<T>(answer: Result<T, FitError>) -> bool {
    matches!(answer, Err(FitError::BadInput { .. }))
}

/// Each entry of a matrix in turn, spoilt.
fn spoilt(matrix: &DMatrix<f64>) -> impl Iterator<Item = DMatrix<f64>> {
    (0..matrix.len()).flat_map(move |i| {
        BAD.into_iter().map(move |bad| {
            let mut matrix = matrix.clone();
            matrix[i] = bad;
            matrix
        })
    })
}

#[test]
fn of_least_squares() {
    let random = &mut Pcg64Mcg::seed_from_u64(95);
    let (design, responses) = (gaussians(random, 5, 2), gaussians(random, 5, 2));
    assert!(least_squares(&design, &responses, Some(&[0.0, 1.0, 1.0, 1.0, 1.0])).is_ok());
    for wrong in spoilt(&design) {
        assert!(is_bad_input(least_squares(&wrong, &responses, None)));
        assert!(is_bad_input(least_squares(&responses, &wrong, None)));
    }
    for weights in [vec![1.0; 4], vec![1.0; 6], vec![1.0, 1.0, -1e-9, 1.0, 1.0]] {
        assert!(is_bad_input(least_squares(&design, &responses, Some(&weights))));
    }
    for bad in BAD {
        assert!(is_bad_input(least_squares(&design, &responses, Some(&[1.0, 1.0, 1.0, 1.0, bad]))));
    }
    assert!(is_bad_input(least_squares(&DMatrix::zeros(5, 0), &responses, None)));
    assert!(is_bad_input(least_squares(&design, &DMatrix::zeros(5, 0), None)));
    // Samples of weight 0 do not count.
    let few = least_squares(&design, &responses, Some(&[1.0, 1.0, 0.0, 0.0, 0.0]));
    assert_eq!(few, Err(FitError::TooFewSamples { samples: 2, coefficients: 2 }));
    assert!(least_squares(&design, &responses, Some(&[1.0, 1.0, 1.0, 0.0, 0.0])).is_ok());
    // A design that is dependent names the direction.
    let mut dependent = design.clone();
    let twice = dependent.column(0) * 2.0;
    dependent.set_column(1, &twice);
    let error = least_squares(&dependent, &responses, None).unwrap_err().to_string();
    // Of unit columns the difference is unobserved.
    assert!(error.starts_with("the loads leave 1 of 2 directions unobserved: "), "{error}");
    assert!(error.contains("0.71 x0") && error.contains("0.71 x1"), "{error}");
    let blind = design.columns(0, 1).into_owned().insert_column(1, 0.0);
    let error = least_squares(&blind, &responses, None).unwrap_err().to_string();
    assert_eq!(error, "the loads leave 1 of 2 directions unobserved: x1");
}

#[test]
fn of_ridge() {
    let random = &mut Pcg64Mcg::seed_from_u64(96);
    let (design, responses, prior) =
        (gaussians(random, 5, 2), gaussians(random, 5, 3), gaussians(random, 2, 3));
    let precision = DMatrix::identity(2, 2);
    let fit =
        |prior: &DMatrix<f64>, precision: &DMatrix<f64>| ridge(&design, &responses, None, prior, precision);
    assert!(fit(&prior, &precision).is_ok());
    for wrong in spoilt(&prior).chain([DMatrix::zeros(3, 2), DMatrix::zeros(2, 2), DMatrix::zeros(1, 3)]) {
        assert!(is_bad_input(fit(&wrong, &precision)));
    }
    for wrong in [DMatrix::identity(3, 3), DMatrix::zeros(2, 2), -&precision, DMatrix::identity(1, 1)] {
        assert!(is_bad_input(fit(&prior, &wrong)));
    }
    // The residuals of data and prior over the number of samples.
    let fit = fit(&prior, &precision).unwrap();
    let left = &responses - &design * &fit.coefficients;
    let pulled = &fit.coefficients - &prior;
    let expected = (left.tr_mul(&left) + pulled.tr_mul(&pulled)) / 5.0;
    let off = (&fit.residual_covariance - &expected).abs();
    assert!(off.iter().all(|off| *off < 1e-13), "{off}");
    assert_eq!((fit.trust, fit.iterations), (DMatrix::from_element(5, 3, 1.0), 1));
}

#[test]
fn of_gauss_helmert() {
    let random = &mut Pcg64Mcg::seed_from_u64(97);
    let (design, responses) = (gaussians(random, 6, 2), gaussians(random, 6, 1));
    let (exact, noise) = (DMatrix::zeros(6, 2), DMatrix::from_element(6, 1, 0.1));
    let fit = |errors: &DMatrix<f64>, noise: &DMatrix<f64>| gauss_helmert(&design, &responses, errors, noise);
    // With exact loads and equal noise it is least squares, but for the noise that is stated.
    let plain = least_squares(&design, &responses, None).unwrap();
    let same = fit(&exact, &noise).unwrap();
    assert!((same.coefficients - &plain.coefficients).iter().all(|off| off.abs() < 1e-12));
    assert!((same.residual_covariance - plain.residual_covariance).iter().all(|off| off.abs() < 1e-12));
    assert!((same.inverse_gram - plain.inverse_gram).iter().all(|off| off.abs() < 1e-12));
    assert!(same.iterations <= 3, "{}", same.iterations);
    for wrong in spoilt(&exact).chain([DMatrix::from_element(6, 2, -1e-9), DMatrix::zeros(5, 2)]) {
        assert!(is_bad_input(fit(&wrong, &noise)));
    }
    for wrong in spoilt(&noise).chain([DMatrix::zeros(6, 1), -&noise, DMatrix::from_element(6, 2, 0.1)]) {
        assert!(is_bad_input(fit(&exact, &wrong)));
    }
}

#[test]
fn of_leaving_out() {
    let random = &mut Pcg64Mcg::seed_from_u64(99);
    let (design, responses) = (gaussians(random, 6, 2), gaussians(random, 6, 2));
    let fit = least_squares(&design, &responses, None).unwrap();
    let tried = |cases: &[usize], trust: (usize, usize)| {
        let mut fit = fit.clone();
        fit.trust = DMatrix::from_element(trust.0, trust.1, 1.0);
        let mut calls = Vec::new();
        leave_out(&design, &responses, None, &fit, cases, |case, members, _| {
            calls.push((case, members.to_vec()))
        })
        .map(|()| calls)
    };
    let calls = tried(&[7, 3, 7, 3, 9, 7], (6, 2)).unwrap();
    assert_eq!(calls, [(3, vec![1, 3]), (7, vec![0, 2, 5]), (9, vec![4])]);
    for (cases, trust) in [(5, (6, 2)), (7, (6, 2)), (6, (5, 2)), (6, (6, 1))] {
        assert!(is_bad_input(tried(&vec![0; cases], trust)));
    }
}

#[test]
fn of_temperatures() {
    let random = &mut Pcg64Mcg::seed_from_u64(100);
    let loads = gaussians(random, 12, 2);
    let signals = &loads * DMatrix::from_element(2, 1, 2.0) + gaussians(random, 12, 1) * 1e-6;
    let celsius: Vec<f64> = (0..12).map(|i| 20.0 + f64::from(i * 5 % 12)).collect();
    let fitted = fit_temperature(&loads, &signals, None, &celsius, 19.0).unwrap();
    // The reference belongs to the range.
    assert_eq!(fitted.temperature.range_celsius, [19.0, 31.0]);
    assert_eq!(
        fit_temperature(&loads, &signals, None, &celsius, 40.0).unwrap().temperature.range_celsius,
        [20.0, 40.0]
    );
    for bad in BAD {
        assert!(fit_temperature(&loads, &signals, None, &celsius, bad).is_err());
        let mut wrong = celsius.clone();
        wrong[5] = bad;
        assert!(fit_temperature(&loads, &signals, None, &wrong, 20.0).is_err());
    }
    assert!(fit_temperature(&loads, &signals, None, &celsius[..11], 20.0).is_err());
    assert!(fit_temperature(&loads, &signals, None, &[20.0; 12], 20.0).is_err());
}

#[test]
fn of_touches() {
    let random = &mut Pcg64Mcg::seed_from_u64(102);
    let start = DMatrix::identity(6, 6);
    let (touches, known) = (gaussians(random, 30, 6), gaussians(random, 6, 6));
    let refined =
        |start: &DMatrix<f64>, touches: &DMatrix<f64>, loads: &DMatrix<f64>, deviations: (f64, f64)| {
            refine(start, touches, deviations.0, &known, loads, deviations.1)
        };
    let good = (1e-2, 1e-2);
    for deviations in
        [(0.0, 1e-2), (1e-2, 0.0), (-1.0, 1e-2), (1e-2, -1.0), (f64::NAN, 1e-2), (1e-2, f64::NAN)]
    {
        assert!(is_bad_input(refined(&start, &touches, &known, deviations)), "{deviations:?}");
    }
    for wrong in [DMatrix::identity(5, 6), DMatrix::identity(6, 7), &start * f64::NAN] {
        assert!(is_bad_input(refined(&wrong, &touches, &known, good)));
    }
    for wrong in [DMatrix::zeros(30, 5), &touches * f64::INFINITY] {
        assert!(is_bad_input(refined(&start, &wrong, &known, good)));
    }
    for wrong in [DMatrix::zeros(5, 6), DMatrix::zeros(6, 5), &known * f64::NAN] {
        assert!(is_bad_input(refined(&start, &touches, &wrong, good)));
    }
}

#[test]
fn of_plans() {
    let candidates = DMatrix::identity(3, 3);
    assert!(plan(&candidates, false, 1.0, 3).is_ok());
    for accuracy in [0.0, -1.0, f64::NAN] {
        assert!(is_bad_input(plan(&candidates, false, accuracy, 3)));
    }
    assert!(is_bad_input(plan(&DMatrix::zeros(0, 3), false, 1.0, 3)));
    for wrong in spoilt(&candidates) {
        assert!(is_bad_input(plan(&wrong, false, 1.0, 3)));
        assert!(is_bad_input(plan_after(&wrong, &candidates, false, 1.0, 3)));
    }
    // One load of each axis has the error of one reading; the third makes the plan whole.
    assert_eq!(
        plan(&candidates, false, 1.0, 2),
        Err(FitError::TooFewSamples { samples: 2, coefficients: 3 })
    );
    assert!(matches!(plan(&candidates, true, 1e-3, 7), Err(FitError::Unobserved(_))));
    let both_ways = DMatrix::from_fn(6, 3, |i, j| if i / 2 == j { 1.0 - 2.0 * (i % 2) as f64 } else { 0.0 });
    assert_eq!(plan(&both_ways, true, 1e-3, 7), Err(FitError::TooFewSamples { samples: 7, coefficients: 4 }));
    let three = plan(&candidates, false, 1.0, 3).unwrap();
    assert_eq!(three.order.len(), 3);
    assert!(three.deviation[1].is_infinite() && (three.deviation[2] - 1.0).abs() < 1e-5, "{three:?}");
    let again = plan(&candidates, false, 0.99 / 2.0_f64.sqrt(), 20).unwrap();
    assert_eq!((again.order.len(), again.deviation.len()), (9, 9));
    let mut information = Information::new(2, false);
    assert!(
        !information.add(&[1.0]) && !information.add(&[1.0, 2.0, 3.0]) && !information.add(&[1.0, f64::NAN])
    );
    assert_eq!((information.variance(&[1.0]), information.variance(&[f64::INFINITY, 0.0])), (None, None));
    assert!(information.add(&[2.0, 0.0]));
    assert!((information.variance(&[2.0, 0.0]).unwrap() - 1.0).abs() < 1e-5);
}

#[test]
fn of_options() {
    let random = &mut Pcg64Mcg::seed_from_u64(101);
    let loads = gaussians(random, 30, 3);
    let signals = &loads * sensor(random, 3, 4) + gaussians(random, 30, 4) * 1e-3;
    let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt).unwrap();
    let error = |options: Options| calibrate(&table, &options).map(|_| ()).unwrap_err().to_string();
    let plain = Options::default();
    for nominal in
        [vec![1.0; 2], vec![1.0; 4], vec![1.0, 0.0, 1.0], vec![1.0, f64::INFINITY, 1.0], vec![-1.0; 3]]
    {
        assert!(error(Options { nominal: Some(nominal), ..plain.clone() }).contains("nominal"));
    }
    let total = |loads: usize, signals: usize| Method::Total {
        load_deviations: vec![1e-3; loads],
        signal_deviations: vec![1e-3; signals],
    };
    assert!(calibrate(&table, &Options { method: total(3, 4), ..plain.clone() }).is_ok());
    for (of_loads, of_signals) in [(2, 4), (3, 3), (4, 4), (3, 5)] {
        error(Options { method: total(of_loads, of_signals), ..plain.clone() });
        let method = Method::GaussHelmert {
            load_deviations: vec![1e-3; of_loads],
            relative: 0.0,
            signal_deviations: vec![1e-3; of_signals],
        };
        error(Options { method, ..plain.clone() });
    }
    let prior = calibrate(&table, &plain).unwrap().to_file().unwrap();
    let with = |prior: &fingertip_calibration::file::CalibrationFile, relative: f64| Options {
        method: Method::Prior { prior: Box::new(prior.clone()), relative },
        ..plain.clone()
    };
    assert!(calibrate(&table, &with(&prior, 0.1)).is_ok());
    for relative in [0.0, -1.0, f64::NAN] {
        error(with(&prior, relative));
    }
    let mut fewer = prior.clone();
    fewer.matrix = fewer.matrix.rows(0, 3).into_owned();
    fewer.zero.truncate(3);
    error(with(&fewer, 0.1));
    // Only signals on loads.
    let helmert = Method::GaussHelmert {
        load_deviations: vec![1e-3; 3],
        relative: 0.0,
        signal_deviations: vec![1e-3; 4],
    };
    for method in [total(3, 4), helmert, with(&prior, 0.1).method] {
        let said = error(Options { method, direction: Direction::LoadsFromSignals, ..plain.clone() });
        assert!(said.contains("the method fits signals from loads only"), "{said}");
    }
    let said = error(Options { curvature: Curvature::Quadratic, ..plain.clone() });
    assert!(said.contains("only loads from signals can be curved"), "{said}");
}

/// A gauge that tells nothing of the load: what drift is a share of nothing, no fit may be made to say.
#[test]
fn of_a_gain_that_cannot_be_told() {
    let random = &mut Pcg64Mcg::seed_from_u64(98);
    let celsius: Vec<f64> = (0..40).map(|i| 2.0 + f64::from(i)).collect();
    let mut refused = 0;
    for _ in 0..30 {
        let (loads, signals) = (gaussians(random, 40, 6), gaussians(random, 40, 1));
        let found = match fit_temperature(&loads, &signals, None, &celsius, 22.0) {
            Ok(found) => found,
            Err(error) => {
                assert!(matches!(error, FitError::NoConvergence { .. }), "{error}");
                refused += 1;
                continue;
            }
        };
        // Where it is found, no change of the drift makes the sum of squares less.
        let (drift, temperature) = (found.temperature.gain_drift[0], &found.temperature);
        let slope: Vec<[f64; 2]> = (0..40)
            .map(|i| {
                let t = celsius[i] - 22.0;
                let load = (found.matrix.row(0) * loads.row(i).transpose())[(0, 0)];
                let zero =
                    found.zero[0] + temperature.zero_drift[0] * t + temperature.zero_curvature[0] * t * t;
                [signals[(i, 0)] - zero - (1.0 + drift * t) * load, t * load]
            })
            .collect();
        let product: f64 = slope.iter().map(|[left, change]| left * change).sum();
        let size: f64 = slope.iter().map(|[left, change]| (left * change).abs()).sum();
        assert!(product.abs() < 1e-9 * size, "{product:e} of {size:e}");
    }
    assert!(refused > 0);
}

/// Only a table with fewer gauges than components is told that gauges are too few.
#[test]
fn gauges_that_are_fewer_than_components_are_told() {
    let random = &mut Pcg64Mcg::seed_from_u64(97);
    for (axes, gauges) in [(3, 2), (3, 3), (3, 5), (6, 4), (6, 6), (6, 8)] {
        let loads = gaussians(random, 40, axes);
        let signals = &loads * sensor(random, axes, gauges);
        let all = if axes == 3 { &Axis::FORCES[..] } else { &Axis::ALL[..] };
        let table = LoadTable::new(all, loads, signals, SignalUnit::Volt).unwrap();
        let said = match calibrate(&table, &Options::default()) {
            Ok(calibration) => calibration.report.to_string(),
            Err(error) => error.to_string(),
        };
        let told = said.contains(&format!("{gauges} gauges cannot tell {axes} components apart"));
        assert_eq!(told, gauges < axes, "{axes} {gauges}: {said}");
        assert!(told || !said.contains("cannot tell"), "{said}");
    }
}

/// What loads or signals do not determine is named by its axes, gauges, their products and the constant, as far as the
/// fit has them.
#[test]
fn what_is_not_determined_is_named() {
    let random = &mut Pcg64Mcg::seed_from_u64(7);
    let axes = [Axis::Fx, Axis::Fy, Axis::Tz];
    let loads = gaussians(random, 30, 3);
    let signals = &loads * sensor(random, 3, 3) + gaussians(random, 30, 3) * 0.01;
    let refused = |loads: &DMatrix<f64>, signals: &DMatrix<f64>, direction, bias, quadratic| {
        let table = LoadTable::new(&axes, loads.clone(), signals.clone(), SignalUnit::Volt).unwrap();
        let curvature = if quadratic { Curvature::Quadratic } else { Curvature::Straight };
        let options =
            Options { direction, bias, curvature, nominal: Some(vec![1.0; 3]), ..Options::default() };
        calibrate(&table, &options).map(|_| ()).unwrap_err().to_string()
    };
    let with = |matrix: &DMatrix<f64>, column: usize, value: &dyn Fn(usize) -> f64| {
        let mut changed = matrix.clone();
        (0..30).for_each(|row| changed[(row, column)] = value(row));
        changed
    };
    // Half of either is the direction in which the two are one.
    let steady = with(&loads, 1, &|_| 1.0);
    let said = refused(&steady, &signals, Direction::SignalsFromLoads, true, false);
    assert!(said.contains("0.71 Fy") && said.contains("0.71 constant"), "{said}");
    let missing = with(&loads, 2, &|row| loads[(row, 0)]);
    let said = refused(&missing, &signals, Direction::SignalsFromLoads, false, false);
    assert!(said.contains("0.71 Fx") && said.contains("0.71 Tz") && !said.contains("constant"), "{said}");
    // A gauge that mirrors another.
    let mirrored = with(&signals, 2, &|row| 1.0 - signals[(row, 0)]);
    let said = refused(&loads, &mirrored, Direction::LoadsFromSignals, true, false);
    assert!(said.contains(" v1") && said.contains(" v3") && said.contains(" constant"), "{said}");
    // A gauge that only changes its sign has a steady square.
    let turning = with(&signals, 1, &|row| if row % 3 == 0 { 1.0 } else { -1.0 });
    let said = refused(&loads, &turning, Direction::LoadsFromSignals, true, true);
    assert!(said.contains("0.71 v2·v2") && said.contains("0.71 constant"), "{said}");
}

/// What is odd in a table is a reason against its calibration: torques and forces in other units, a dead gauge.
#[test]
fn what_is_odd_in_a_table_is_said_of_its_calibration() {
    let random = &mut Pcg64Mcg::seed_from_u64(8);
    // Forces at some centimetres.
    let loads: Vec<f64> = (0..40)
        .flat_map(|i| {
            let angle = f64::from(i);
            let [x, y, z] = [5.0 * angle.sin(), 4.0 * (0.7 * angle).cos(), 6.0 * angle.cos()];
            let [a, b, c] = [0.01 * (2.0 * angle).cos(), 0.02 * angle.sin(), 0.015];
            [x, y, z, b * z - c * y, c * x - a * z, a * y - b * x]
        })
        .collect();
    let loads = DMatrix::from_row_slice(40, 6, &loads);
    let scale = DMatrix::from_diagonal(&[0.1, 0.1, 0.1, 10.0, 10.0, 10.0].to_vec().into());
    let signals = &loads * scale * sensor(random, 6, 7) + gaussians(random, 40, 7) * 1e-4;
    let reasons = |force: f64, torque: f64, dead: bool| {
        let loads = DMatrix::from_fn(40, 6, |i, j| loads[(i, j)] * if j < 3 { force } else { torque });
        let signals = DMatrix::from_fn(40, 7, |i, j| if dead && j == 4 { 0.25 } else { signals[(i, j)] });
        let table = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap();
        let found = calibrate(&table, &Options::default()).unwrap();
        found.to_file().unwrap().quality.reasons.join("; ")
    };
    let sound = reasons(1.0, 1.0, false);
    assert!(!sound.contains("columns of") && !sound.contains("dead") && !sound.contains("kN"), "{sound}");
    for (force, torque, dead, expected) in [
        (1.0, 1e3, false, "N·mm in columns of N·m"),
        (1.0, 1e-3, false, "N·m in columns of N·mm"),
        (1.0, 1.0, true, "gauge 5 is dead: it always reads 0.25"),
        (1e3, 1e3, false, "no fingertip"),
    ] {
        let said = reasons(force, torque, dead);
        assert!(said.contains(expected), "{expected}: {said}");
    }
}
