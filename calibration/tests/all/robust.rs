//! Robust fits and the test for outliers, against the equations that their answers must obey.

use fingertip_calibration::fit::{HUBER_THRESHOLD, gauss_helmert, huber};
use fingertip_calibration::loads::Names;
use fingertip_calibration::nalgebra::{DMatrix, DVector};
use fingertip_calibration::report::outliers;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::random::{gaussian, gaussians};
use super::testing::Largest as _;

/// `Σ w ψ(r) x = 0` with ψ linear within the threshold and constant beyond; the scale is the median over that of
/// Gaussian noise, mended for the coefficients; and Huber's own covariance.
#[test]
fn hubers_answer_obeys_hubers_equations() {
    let random = &mut Pcg64Mcg::seed_from_u64(211);
    for round in 0..20 {
        let (n, k) = ([9, 15][round % 2], 3);
        let (x, truth) = (gaussians(random, n, k), gaussians(random, k, 2));
        let noise =
            DMatrix::from_fn(n, 2, |_, _| gaussian(random) * if random.random_bool(0.2) { 8.0 } else { 1.0 });
        let y = &x * truth + noise * 0.1;
        let weights: Option<Vec<f64>> =
            (round % 4 > 1).then(|| (0..n).map(|_| gaussian(random).exp()).collect());
        let root = |i: usize| weights.as_ref().map_or(1.0, |w| w[i]).sqrt();
        let fit = huber(&x, &y, weights.as_deref()).unwrap();
        let left = &y - &x * &fit.coefficients;
        let (mut psi, mut gain) = (DMatrix::zeros(n, 2), [0.0; 2]);
        for j in 0..2 {
            let sizes: Vec<f64> = (0..n).map(|i| left[(i, j)].abs() * root(i)).collect();
            let mut sorted = sizes.clone();
            sorted.sort_by(f64::total_cmp);
            // Half of all Gaussian numbers are within 0.674 49.
            let scale = sorted[n / 2] / 0.674_489_750_196_082 * (n as f64 / (n - k) as f64).sqrt();
            let limit = HUBER_THRESHOLD * scale;
            for i in 0..n {
                let trust = (limit / sizes[i]).min(1.0);
                assert!((fit.trust[(i, j)] - trust).abs() < 1e-7, "{round}: {} {trust}", fit.trust[(i, j)]);
                psi[(i, j)] = (left[(i, j)] * root(i)).clamp(-limit, limit);
            }
            let inside = sizes.iter().filter(|size| **size <= limit).count() as f64 / n as f64;
            gain[j] = (1.0 + k as f64 / n as f64 * (1.0 - inside) / inside) / inside;
        }
        let pull =
            DMatrix::from_fn(k, 2, |c, j| (0..n).map(|i| x[(i, c)] * root(i) * psi[(i, j)]).sum::<f64>());
        assert!(pull.largest() < 1e-7, "{round}: {pull}");
        let mut covariance = psi.transpose() * &psi / (n - k) as f64;
        (0..4).for_each(|e| covariance[e] *= gain[e % 2] * gain[e / 2]);
        assert!((&fit.residual_covariance - &covariance).largest() < 1e-6 * covariance.largest(), "{round}");
    }
}

/// Chance that a number of Student's distribution of `freedom` degrees is beyond ±t, by the sums of sines and cosines
/// (Abramowitz & Stegun 26.7.3 and 26.7.4).
fn beyond(t: f64, freedom: usize) -> f64 {
    let (sin, cos) = (t / (freedom as f64).sqrt()).atan().sin_cos();
    let odd = freedom % 2 == 1;
    let (mut term, mut sum) = if odd { (cos, 0.0) } else { (1.0, 0.0) };
    let mut power = usize::from(odd);
    while power + 2 <= freedom {
        sum += term;
        power += 2;
        term *= cos * cos * (power - 1) as f64 / power as f64;
    }
    let within = if odd { core::f64::consts::FRAC_2_PI * (sin.asin() + sin * sum) } else { sin * sum };
    1.0 - within
}

#[test]
fn the_oracle_is_students_distribution() {
    // Tables: 12.706, 4.303, 2.571 and 2.228 are exceeded in 5 % of all cases.
    for (t, freedom) in [(12.706, 1), (4.303, 2), (3.182, 3), (2.776, 4), (2.571, 5), (2.228, 10)] {
        assert!((beyond(t, freedom) - 0.05).abs() < 1e-4, "{freedom}: {}", beyond(t, freedom));
    }
}

/// How far a sample is from what the others say, in deviations of that difference.
fn off(x: &DMatrix<f64>, y: &DVector<f64>, weights: &[f64], others: &[usize], i: usize) -> f64 {
    let w = DMatrix::from_diagonal(&DVector::from_iterator(others.len(), others.iter().map(|o| weights[*o])));
    let (x_others, y_others) = (x.select_rows(others), y.select_rows(others));
    let inverse = (x_others.transpose() * &w * &x_others).try_inverse().unwrap();
    let theta = &inverse * x_others.transpose() * &w * &y_others;
    let left = &y_others - &x_others * &theta;
    let variance = (left.transpose() * w * &left)[(0, 0)] / (others.len() - x.ncols()) as f64;
    let row = x.row(i);
    (y[i] - (row * theta)[(0, 0)])
        / (variance * (1.0 / weights[i] + (row * inverse * row.transpose())[(0, 0)])).sqrt()
}

/// Rosner's test step by step: of the samples that are left, the one that the others foretell worst is taken out, up
/// to a fifth of them; the last one beyond the level decides.
#[test]
fn outliers_are_those_that_the_others_do_not_foretell() {
    let random = &mut Pcg64Mcg::seed_from_u64(212);
    let mut named = [0; 4];
    for round in 0..60 {
        let (n, k) = (10 + round % 8, 1 + round % 3);
        let x = gaussians(random, n, k);
        let mut y = &x * gaussians(random, k, 2) + gaussians(random, n, 2) * 0.01;
        for _ in 0..round % 4 {
            y[(random.random_range(0..n), random.random_range(0..2))] += 0.1 * (1.0 + gaussian(random).abs());
        }
        let weights: Option<Vec<f64>> =
            (round % 2 == 1).then(|| (0..n).map(|_| gaussian(random).exp()).collect());
        let w = weights.clone().unwrap_or_else(|| vec![1.0; n]);
        let mut left: Vec<usize> = (0..n).collect();
        let (mut expected, mut significant) = (Vec::new(), 0);
        for _ in 0..n / 5 {
            let (mut worst, mut at) = (0.0, (0, 0));
            for i in left.clone() {
                let others: Vec<usize> = left.iter().copied().filter(|o| *o != i).collect();
                for j in 0..2 {
                    let t = off(&x, &y.column(j).into_owned(), &w, &others, i).abs();
                    if t > worst {
                        (worst, at) = (t, (i, j));
                    }
                }
            }
            let chance = (beyond(worst, left.len() - 1 - k) * (2 * left.len()) as f64).min(1.0);
            left.retain(|i| *i != at.0);
            expected.push((at, worst, chance));
            if chance < 0.01 {
                significant = expected.len();
            }
        }
        let found = outliers(&x, &y, weights.as_deref(), &Names::default(), &[]);
        assert_eq!(found.len(), significant, "{round}: {expected:?}");
        named[significant] += 1;
        for (one, ((i, j), t, chance)) in found.iter().zip(expected) {
            assert_eq!((one.index, &one.response), (i, &format!("response {j}")), "{round}");
            assert!((one.deviations / t - 1.0).abs() < 1e-6, "{round}: {one:?} {t}");
            assert!((one.chance - chance).abs() < 1e-6 * chance + 1e-12, "{round}: {one:?} {chance}");
        }
    }
    assert!(named[..3].iter().all(|count| *count > 3), "{named:?}");
}

/// Readings without noise and without a zero: what rounding makes of the zero does not settle, and need not.
#[test]
fn a_coefficient_of_rounding_size_keeps_no_fit_from_its_end() {
    let random = &mut Pcg64Mcg::seed_from_u64(213);
    for unit in [1e-9, 1.0, 1e9] {
        for _ in 0..10 {
            let (loads, truth) = (gaussians(random, 12, 3) * 0.1, gaussians(random, 3, 2) * unit);
            // No gauge sees the third load, nor is there a constant.
            let truth = DMatrix::from_fn(4, 2, |i, j| if i < 2 { truth[(i, j)] } else { 0.0 });
            let design = loads.insert_column(3, 1.0);
            let errors = DMatrix::from_fn(12, 4, |_, j| if j < 3 { 1e-3 } else { 0.0 });
            let noise = DMatrix::from_element(12, 2, 1e-3 * unit);
            let fit = gauss_helmert(&design, &(&design * &truth), &errors, &noise).unwrap();
            assert!(
                (fit.coefficients - truth).largest() < 1e-12 * unit && fit.iterations < 10,
                "{}",
                fit.iterations
            );
        }
    }
}
