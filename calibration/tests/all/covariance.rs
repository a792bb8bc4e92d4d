//! What every regression says of its own error, against the spread of thousands of them: within 5 %.

use fingertip_calibration::fit::{
    Fit, Ransac, fit_temperature, gauss_helmert, huber, least_squares, ransac, ridge, total_least_squares,
};
use fingertip_calibration::nalgebra::{DMatrix, DVector};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::random::{gaussian, gaussians, sensor};
use super::spread::Spread;
use super::testing::Largest as _;

/// Errors and variances of all coefficients of a fit.
fn judged(fit: &Fit, truth: &DMatrix<f64>) -> (Vec<f64>, Vec<f64>) {
    let variances = fit.inverse_gram.diagonal() * fit.residual_covariance.diagonal().transpose();
    ((&fit.coefficients - truth).as_slice().to_vec(), variances.as_slice().to_vec())
}

#[test]
fn least_squares_with_weights() {
    let random = &mut Pcg64Mcg::seed_from_u64(3);
    let (truth, design) = (sensor(random, 6, 3), gaussians(random, 25, 6));
    let weights: Vec<f64> = (0..25).map(|i| if i % 2 == 0 { 4.0 } else { 1.0 }).collect();
    let spread = Spread::over(20_000, || {
        let noise =
            DMatrix::from_fn(25, 3, |i, j| 0.1 * (j + 1) as f64 * gaussian(random) / weights[i].sqrt());
        judged(&least_squares(&design, &(&design * &truth + noise), Some(&weights)).unwrap(), &truth)
    });
    spread.agrees("least squares");
}

#[test]
fn huber_with_outliers() {
    let random = &mut Pcg64Mcg::seed_from_u64(8);
    for (samples, outliers, trials) in [(60, 0.0, 8_500), (150, 0.05, 8_000)] {
        let (truth, design) = (sensor(random, 3, 2), gaussians(random, samples, 3));
        let spread = Spread::over(trials, || {
            let noise = DMatrix::from_fn(samples, 2, |_, _| {
                gaussian(random) * if random.random_bool(outliers) { 20.0 } else { 1.0 }
            });
            judged(&huber(&design, &(&design * &truth + noise), None).unwrap(), &truth)
        });
        spread.agrees(&format!("Huber, {samples} samples, {outliers} outliers"));
    }
}

#[test]
fn ransac_with_outliers() {
    let random = &mut Pcg64Mcg::seed_from_u64(9);
    let (truth, design) = (sensor(random, 3, 2), gaussians(random, 40, 3));
    let options = Ransac { outliers: 0.15, ..Ransac::new(vec![4.5; 2]) };
    let spread = Spread::over(8_000, || {
        let mut signals = &design * &truth + gaussians(random, 40, 2);
        for i in [3, 17, 31] {
            signals[(i, i % 2)] += 300.0;
        }
        judged(&ransac(&design, &signals, None, &options).unwrap(), &truth)
    });
    spread.agrees("RANSAC");
}

/// Loads that are uncertain by 5 %.
#[test]
fn total_least_squares_and_gauss_helmert() {
    let random = &mut Pcg64Mcg::seed_from_u64(10);
    let (truth, loads) = (sensor(random, 3, 3), gaussians(random, 40, 3));
    let noisy = |random: &mut Pcg64Mcg| {
        let signals = &loads * &truth + gaussians(random, 40, 3) * 0.1;
        (&loads + gaussians(random, 40, 3) * 0.05, signals)
    };
    let spread = Spread::over(12_000, || {
        let (uncertain, signals) = noisy(random);
        let fit = total_least_squares(&uncertain, &signals, &[0.05; 3], &[0.1; 3], false).unwrap();
        judged(&fit, &truth)
    });
    spread.agrees("total least squares");
    let (errors, noise) = (DMatrix::from_element(40, 3, 0.05), DMatrix::from_element(40, 3, 0.1));
    let spread = Spread::over(8_000, || {
        let (uncertain, signals) = noisy(random);
        judged(&gauss_helmert(&uncertain, &signals, &errors, &noise).unwrap(), &truth)
    });
    spread.agrees("Gauss-Helmert");
}

/// Sensors drawn from the prior: the covariance is that of the posterior.
#[test]
fn ridge_of_sensors_from_the_prior() {
    let random = &mut Pcg64Mcg::seed_from_u64(11);
    let (prior, design) = (sensor(random, 4, 2), gaussians(random, 60, 4));
    let noise = 0.3;
    // One direction is hardly loaded.
    let mut design = design;
    design.column_mut(3).scale_mut(0.05);
    let deviations: [f64; 4] = [0.2, 0.1, 0.05, 0.3];
    let precision =
        DMatrix::from_diagonal(&DVector::from_iterator(4, deviations.iter().map(|s| (noise / s).powi(2))));
    let spread = Spread::over(12_000, || {
        let truth = &prior + DMatrix::from_fn(4, 2, |i, _| deviations[i] * gaussian(random));
        let signals = &design * &truth + gaussians(random, 60, 2) * noise;
        judged(&ridge(&design, &signals, None, &prior, &precision).unwrap(), &truth)
    });
    spread.agrees("ridge");
}

#[test]
fn temperature_terms() {
    let random = &mut Pcg64Mcg::seed_from_u64(12);
    let (matrix, loads) = (sensor(random, 1, 3), gaussians(random, 50, 3));
    let celsius: Vec<f64> = (0..50).map(|i| 15.0 + f64::from(i * 7 % 50) * 0.4).collect();
    let truth = [0.3, 0.01, -1e-4, 1e-3];
    let spread = Spread::over(10_000, || {
        let signals = DMatrix::from_fn(50, 1, |i, _| {
            let warmer = celsius[i] - 22.0;
            truth[0]
                + truth[1] * warmer
                + truth[2] * warmer * warmer
                + (1.0 + truth[3] * warmer) * loads.row(i).dot(&matrix.row(0))
                + 0.02 * gaussian(random)
        });
        let fit = fit_temperature(&loads, &signals, None, &celsius, 22.0).unwrap();
        let drift = &fit.temperature;
        let mut errors: Vec<f64> = (0..3).map(|j| fit.matrix[(0, j)] - matrix[(0, j)]).collect();
        errors.extend([
            fit.zero[0] - truth[0],
            drift.zero_drift[0] - truth[1],
            drift.zero_curvature[0] - truth[2],
            drift.gain_drift[0] - truth[3],
        ]);
        (errors, fit.covariances[0].diagonal().as_slice().to_vec())
    });
    spread.agrees("temperature");
}

/// A weight is as many samples: the same as rows and readings times its root.
#[test]
fn weights_of_huber_are_those_of_scaled_rows() {
    let random = &mut Pcg64Mcg::seed_from_u64(17);
    for _ in 0..20 {
        let (truth, design) = (sensor(random, 3, 2), gaussians(random, 30, 3));
        let mut signals = &design * &truth + gaussians(random, 30, 2) * 0.1;
        (0..4).for_each(|i| signals[(7 * i, i % 2)] += 5.0);
        let weights: Vec<f64> = (0..30).map(|_| gaussian(random).exp()).collect();
        let scaled = |matrix: &DMatrix<f64>| {
            DMatrix::from_fn(30, matrix.ncols(), |i, j| matrix[(i, j)] * weights[i].sqrt())
        };
        let weighted = huber(&design, &signals, Some(&weights)).unwrap();
        let plain = huber(&scaled(&design), &scaled(&signals), None).unwrap();
        assert!((weighted.coefficients - plain.coefficients).largest() < 1e-9);
        assert!((weighted.trust - plain.trust).largest() < 1e-8);
        let change = &weighted.residual_covariance - &plain.residual_covariance;
        assert!(change.largest() < 1e-8 * plain.residual_covariance.largest());
        assert!(
            (weighted.inverse_gram - &plain.inverse_gram).largest() < 1e-12 * plain.inverse_gram.largest()
        );
    }
}
