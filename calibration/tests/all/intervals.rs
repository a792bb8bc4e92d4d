//! The intervals of every regression hold the truth as often as they say.

use fingertip_calibration::fit::{
    FitError, Ransac, gauss_helmert, gauss_helmert_correlated, huber, least_squares, ransac, ridge,
    total_least_squares,
};
use fingertip_calibration::nalgebra::{DMatrix, DVector};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::coverage::{Coverage, LONG, SHORT, judged};
use super::random::{gaussian, gaussians, sensor};
use super::testing::Largest as _;

/// Noise of responses that are correlated with each other.
fn correlated(random: &mut Pcg64Mcg, rows: usize, columns: usize) -> DMatrix<f64> {
    let common = gaussians(random, rows, 1);
    DMatrix::from_fn(rows, columns, |i, _| 0.8 * common[i]) + gaussians(random, rows, columns) * 0.6
}

fn squares(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(81);
    let (truth, design) = (sensor(random, 4, 3), gaussians(random, 12, 4));
    let weights: Vec<f64> = (0..12).map(|i| [4.0, 1.0, 0.0, 0.25][i % 4]).collect();
    let weighted = |noise: DMatrix<f64>| {
        DMatrix::from_fn(12, 3, |i, j| noise[(i, j)] / weights[i].sqrt().max(1e-3)) * 0.1
    };
    Coverage::over(trials, || {
        let signals = &design * &truth + weighted(correlated(random, 12, 3));
        judged(&least_squares(&design, &signals, Some(&weights)).unwrap(), &truth)
    })
    .holds("least squares, 9 of 12 rows count");
    let prior = &truth;
    let precision = DMatrix::from_diagonal(&DVector::from_element(4, 0.25));
    Coverage::over(trials, || {
        let truth = prior + gaussians(random, 4, 3) * 0.2;
        let signals = &design * &truth + weighted(gaussians(random, 12, 3));
        judged(&ridge(&design, &signals, Some(&weights), prior, &precision).unwrap(), &truth)
    })
    .holds("ridge, 9 of 12 rows count");
}

fn robust(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(82);
    for (samples, counted, outliers) in [(40, 20, 0.0), (60, 60, 0.0), (60, 40, 0.05), (150, 150, 0.05)] {
        let (truth, design) = (sensor(random, 3, 2), gaussians(random, samples, 3));
        // Rows of weight zero are wrong by anything.
        let weights: Vec<f64> = (0..samples).map(|i| if i < counted { 1.0 } else { 0.0 }).collect();
        Coverage::over(trials, || {
            let noise = DMatrix::from_fn(samples, 2, |i, _| {
                let wrong = random.random_bool(outliers) || i >= counted;
                gaussian(random) * if wrong { 20.0 } else { 1.0 }
            });
            judged(&huber(&design, &(&design * &truth + noise), Some(&weights)).unwrap(), &truth)
        })
        .holds(&format!("Huber, {counted} of {samples} rows count, {outliers} outliers"));
    }
    let (truth, design) = (sensor(random, 3, 2), gaussians(random, 60, 3));
    let weights: Vec<f64> = (0..60).map(|i| if i < 40 { 1.0 } else { 0.0 }).collect();
    let options = Ransac { outliers: 0.15, ..Ransac::new(vec![4.5; 2]) };
    Coverage::over(trials, || {
        let mut signals = &design * &truth + gaussians(random, 60, 2);
        (40..60).for_each(|i| signals[(i, 0)] += 100.0);
        for i in [3, 17, 31] {
            signals[(i, i % 2)] += 300.0;
        }
        judged(&ransac(&design, &signals, Some(&weights), &options).unwrap(), &truth)
    })
    .holds("RANSAC, 40 of 60 rows count");
}

fn total(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(83);
    for (samples, error, constant) in
        [(40, 0.05, true), (40, 0.25, false), (100, 0.4, false), (100, 0.4, true), (200, 0.5, false)]
    {
        let k = 3 + usize::from(constant);
        let (truth, loads) = (sensor(random, k, 3), gaussians(random, samples, 3));
        let design = if constant { loads.clone().insert_column(3, 1.0) } else { loads.clone() };
        // Twice what was stated: only the ratios count.
        let stated = ([0.5 * error; 3], [0.05; 3]);
        Coverage::over(trials, || {
            let signals = &design * &truth + gaussians(random, samples, 3) * 0.1;
            let uncertain = &loads + gaussians(random, samples, 3) * error;
            judged(
                &total_least_squares(&uncertain, &signals, &stated.0, &stated.1, constant).unwrap(),
                &truth,
            )
        })
        .holds(&format!("total least squares, {samples} loads wrong by {error}, constant: {constant}"));
    }
}

fn unequal(trials: usize) {
    let random = &mut Pcg64Mcg::seed_from_u64(84);
    let (truth, loads) = (sensor(random, 3, 3), gaussians(random, 60, 3));
    type By = fn(usize, usize) -> f64;
    let cases: [(&str, By, By); 5] = [
        ("equal", |_, _| 0.05, |_, _| 0.1),
        ("loads 0.02 or 0.3 by sample", |i, _| [0.02, 0.3][i % 2], |_, _| 0.05),
        ("signals 0.05 or 1 by sample", |_, _| 0.02, |i, _| [0.05, 1.0][i % 2]),
        ("signals 0.05 or 1 by gauge and sample", |_, _| 0.02, |i, j| [0.05, 1.0][(i + j) % 2]),
        ("loads by axis, signals by gauge", |_, j| [0.01, 0.1, 0.3][j], |_, j| [0.3, 0.1, 0.02][j]),
    ];
    for (what, of_loads, of_signals) in cases {
        let errors = DMatrix::from_fn(60, 3, of_loads);
        let noise = DMatrix::from_fn(60, 3, of_signals);
        Coverage::over(trials, || {
            let signals = &loads * &truth + gaussians(random, 60, 3).component_mul(&noise);
            let uncertain = &loads + gaussians(random, 60, 3).component_mul(&errors);
            judged(&gauss_helmert(&uncertain, &signals, &errors, &noise).unwrap(), &truth)
        })
        .holds(&format!("Gauss-Helmert, {what}"));
    }
    // Loads and readings wrong together, otherwise in every sample, and a constant that is exact.
    let truth = sensor(random, 4, 3);
    let design = loads.insert_column(3, 1.0);
    let roots: Vec<DMatrix<f64>> = (0..60)
        .map(|i| {
            let mut root = gaussians(random, 7, 7) * [0.03, 0.15][i % 2];
            root.row_mut(3).fill(0.0);
            root
        })
        .collect();
    let errors: Vec<DMatrix<f64>> = roots.iter().map(|root| root * root.transpose()).collect();
    Coverage::over(trials, || {
        let (mut uncertain, mut signals) = (design.clone(), &design * &truth);
        for (i, root) in roots.iter().enumerate() {
            let error = root * gaussians(random, 7, 1);
            (0..4).for_each(|j| uncertain[(i, j)] += error[j]);
            (0..3).for_each(|j| signals[(i, j)] += error[4 + j]);
        }
        judged(&gauss_helmert_correlated(&uncertain, &signals, &errors).unwrap(), &truth)
    })
    .holds("Gauss-Helmert, correlated errors");
}

#[test]
fn of_least_squares() {
    squares(SHORT);
}

#[test]
fn of_robust_fits() {
    robust(SHORT);
}

#[test]
fn of_total_least_squares() {
    total(SHORT);
}

#[test]
fn of_unequal_and_correlated_errors() {
    unequal(SHORT);
}

#[test]
#[ignore = "long: 2 000 trials of each"]
fn of_all_regressions_in_many_trials() {
    squares(LONG);
    robust(LONG);
    total(LONG);
    unequal(LONG);
}

/// What a row of weight zero says is of no matter: neither to coefficients, nor to their errors, nor to trust.
#[test]
fn rows_of_weight_zero_are_none() {
    let random = &mut Pcg64Mcg::seed_from_u64(85);
    for wrong in [0.0, 1.0, 1e9] {
        let (truth, design) = (sensor(random, 3, 2), gaussians(random, 40, 3));
        let mut signals = &design * &truth + gaussians(random, 40, 2) * 0.1;
        (20..40).for_each(|i| signals[(i, i % 2)] += wrong);
        let weights: Vec<f64> = (0..40).map(|i| if i < 20 { 1.0 + i as f64 } else { 0.0 }).collect();
        let few = (design.rows(0, 20).into_owned(), signals.rows(0, 20).into_owned());
        let options = Ransac { outliers: 0.3, ..Ransac::new(vec![0.5; 2]) };
        for (all, some) in [
            (huber(&design, &signals, Some(&weights)), huber(&few.0, &few.1, Some(&weights[..20]))),
            (
                ransac(&design, &signals, Some(&weights), &options),
                ransac(&few.0, &few.1, Some(&weights[..20]), &options),
            ),
        ] {
            let (all, some) = (all.unwrap(), some.unwrap());
            assert!((&all.coefficients - &some.coefficients).largest() < 1e-12);
            let widths = (&all.half_widths(0.95) - &some.half_widths(0.95)).largest();
            assert!(widths < 1e-9 * some.half_widths(0.95).largest(), "{widths}");
            assert_eq!(all.freedom, some.freedom);
            assert!((all.trust.rows(0, 20) - &some.trust).largest() < 1e-9);
            assert!(all.trust.rows(20, 20).iter().all(|trust| *trust == 1.0));
        }
    }
    let (design, signals) = (gaussians(random, 10, 3), gaussians(random, 10, 1));
    let weights: Vec<f64> = (0..10).map(|i| if i < 3 { 1.0 } else { 0.0 }).collect();
    let few = FitError::TooFewSamples { samples: 3, coefficients: 3 };
    assert_eq!(huber(&design, &signals, Some(&weights)).unwrap_err(), few);
    assert_eq!(ransac(&design, &signals, Some(&weights), &Ransac::new(vec![1.0])).unwrap_err(), few);
}

/// Covariances that are diagonal are deviations; others are refused where they are none.
#[test]
fn covariances_of_single_samples() {
    let random = &mut Pcg64Mcg::seed_from_u64(86);
    let (truth, loads) = (sensor(random, 3, 2), gaussians(random, 30, 3));
    let (errors, noise) =
        (gaussians(random, 30, 3).abs() * 0.1, gaussians(random, 30, 2).abs().add_scalar(0.1));
    let signals = &loads * &truth + gaussians(random, 30, 2).component_mul(&noise);
    let one = gauss_helmert(&loads, &signals, &errors, &noise).unwrap();
    let squared = |i: usize| {
        let of = errors.row(i).iter().chain(noise.row(i).iter()).map(|s| s * s).collect::<Vec<_>>();
        DMatrix::from_diagonal(&DVector::from_vec(of))
    };
    let mut covariances: Vec<_> = (0..30).map(squared).collect();
    let two = gauss_helmert_correlated(&loads, &signals, &covariances).unwrap();
    assert!((&one.coefficients - &two.coefficients).largest() < 1e-13);
    assert!((one.half_widths(0.9) - two.half_widths(0.9)).largest() < 1e-13);
    // The product is near to the whole where it is no product.
    let product = one.residual_covariance.kronecker(&one.inverse_gram);
    let full = one.full_covariance.unwrap();
    assert!((product - &full).norm() < 0.5 * full.norm());
    covariances[7][(0, 1)] = 1.0;
    let refused = FitError::BadInput { what: "the list of covariances" };
    assert_eq!(gauss_helmert_correlated(&loads, &signals, &covariances).unwrap_err(), refused);
    for bad in [DMatrix::zeros(4, 4), DMatrix::from_element(5, 5, f64::NAN), -DMatrix::<f64>::identity(5, 5)]
    {
        covariances[7] = bad;
        assert_eq!(gauss_helmert_correlated(&loads, &signals, &covariances).unwrap_err(), refused);
    }
    covariances[7] = DMatrix::zeros(5, 5);
    assert!(gauss_helmert_correlated(&loads, &signals, &covariances).is_err());
    assert_eq!(gauss_helmert_correlated(&loads, &signals, &covariances[..29]).unwrap_err(), refused);
}

/// A probability that is none gives no width, and few degrees of freedom give wide ones.
#[test]
fn widths_are_those_of_student() {
    let random = &mut Pcg64Mcg::seed_from_u64(87);
    let (design, signals) = (gaussians(random, 4, 2), gaussians(random, 4, 1));
    let fit = least_squares(&design, &signals, None).unwrap();
    assert_eq!(fit.freedom, 2.0);
    // With two degrees of freedom the quantile of 95 % is 4.302 652 729 911 275.
    let ratio = fit.half_widths(0.95).component_div(&fit.deviations());
    assert!(ratio.iter().all(|ratio| (ratio - 4.302_652_729_911_275).abs() < 1e-9), "{ratio}");
    for bad in [0.0, 1.0, -0.5, 1.5, f64::NAN] {
        assert!(fit.half_widths(bad).iter().all(|width| width.is_nan()), "{bad}");
    }
    let none = fingertip_calibration::fit::Fit { freedom: 0.0, ..fit };
    assert!(none.half_widths(0.5).iter().all(|width| width.is_infinite()));
}
