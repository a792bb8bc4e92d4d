//! Least squares that outliers cannot spoil.

use nalgebra::DMatrix;

use super::regression::{accumulate, check};
use super::{Fit, FitError, least_squares};

/// Residuals beyond this number of standard deviations count linearly instead of squared: 95 % efficiency
/// for Gaussian noise (Huber 1964).
pub const HUBER_THRESHOLD: f64 = 1.345;

/// Median absolute deviation to standard deviation, for Gaussian noise.
const MAD_TO_DEVIATION: f64 = 1.482_602_218_505_602;

const MOST_ITERATIONS: usize = 500;

/// Huber's M-estimate, each response on its own, by iteratively reweighted least squares with the
/// median absolute deviation as scale (`docs/theory/calibration.md#robust-fits`; Huber 1981, chapter 7).
///
/// The residual covariance is Huber's, `K² Σψ² / (n−k) / (mean ψ')²` with his correction for finite
/// samples `K = 1 + (k/n) (1−m)/m`, m = mean ψ' the share of residuals within the threshold (Huber 1981,
/// section 7.6; Street, Carroll & Ruppert 1988), so that `inverse_gram ⊗ residual_covariance` is again the
/// covariance of the coefficients. `trust` holds the weight of each sample in each response.
///
/// Samples of weight zero are none: they enter neither scale nor counts, and their trust is 1.
///
/// # Errors
/// As [`least_squares`], and [`FitError::NoConvergence`].
pub fn huber(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    weights: Option<&[f64]>,
) -> Result<Fit, FitError> {
    check(design, responses, weights)?;
    let mut fit = least_squares(design, responses, weights)?;
    let regressors = design.ncols();
    let weight = |i: usize| weights.map_or(1.0, |w| w[i]);
    let root = |i: usize| weight(i).sqrt();
    let counted: Vec<usize> = (0..design.nrows()).filter(|i| weight(*i) > 0.0).collect();
    let samples = counted.len();
    let mut psi = DMatrix::zeros(design.nrows(), responses.ncols());
    let mut mean_slope = vec![1.0; responses.ncols()];
    for j in 0..responses.ncols() {
        let response = responses.columns(j, 1).into_owned();
        // What rounding leaves of an exact fit is no scale.
        let floor = f64::EPSILON * response.amax() * samples as f64;
        let mut theta = fit.coefficients.columns(j, 1).into_owned();
        let mut change = f64::INFINITY;
        for iteration in 1..=MOST_ITERATIONS {
            let residuals = &response - design * &theta;
            let scale = deviation(counted.iter().map(|i| residuals[*i] * root(*i)), regressors).max(floor);
            let trust = |i: usize| {
                let size = (residuals[i] * root(i)).abs() / scale;
                if size <= HUBER_THRESHOLD || scale <= 0.0 { 1.0 } else { HUBER_THRESHOLD / size }
            };
            for i in counted.iter().copied() {
                fit.trust[(i, j)] = trust(i);
                psi[(i, j)] = residuals[i] * root(i) * trust(i);
            }
            let inside = counted.iter().filter(|i| trust(**i) >= 1.0).count() as f64 / samples as f64;
            mean_slope[j] = inside.max(1.0 / samples as f64);
            fit.iterations = fit.iterations.max(iteration);
            let mut triangular = accumulate(design, &response, |i| weight(i) * trust(i));
            let next = triangular.factors().coefficients()?;
            change = (&next - &theta).amax() / next.amax().max(f64::MIN_POSITIVE);
            theta = next;
            // The change of one step is a fraction of what is left; the statistical error of the
            // coefficients is many orders above this.
            if change < 1e-10 {
                break;
            }
        }
        if !(change < 1e-6) {
            return Err(FitError::NoConvergence { iterations: MOST_ITERATIONS, change });
        }
        fit.coefficients.set_column(j, &theta.column(0));
    }
    let freedom = samples.saturating_sub(regressors).max(1) as f64;
    // K / mean ψ' of each response.
    let gain: Vec<f64> = mean_slope
        .iter()
        .map(|slope| (1.0 + regressors as f64 / samples as f64 * (1.0 - slope) / slope) / slope)
        .collect();
    fit.residual_covariance = DMatrix::from_fn(responses.ncols(), responses.ncols(), |i, j| {
        psi.column(i).dot(&psi.column(j)) / freedom * gain[i] * gain[j]
    });
    Ok(fit)
}

/// Standard deviation of the bulk: the scaled median absolute residual, with the correction n/(n−k)
/// of the degrees of freedom that the fit has used up.
pub(crate) fn deviation(residuals: impl Iterator<Item = f64>, regressors: usize) -> f64 {
    let mut sizes: Vec<f64> = residuals.map(f64::abs).collect();
    let samples = sizes.len();
    if samples == 0 {
        return 0.0;
    }
    let middle = samples / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    let freedom = samples.saturating_sub(regressors).max(1) as f64;
    MAD_TO_DEVIATION * *median * (samples as f64 / freedom).sqrt()
}

#[cfg(test)]
mod tests {
    use super::huber;
    use crate::fit::least_squares;
    use crate::fit::testing::{gaussian_matrix, sensor};
    use crate::testing::Largest as _;
    use rand::{RngExt as _, SeedableRng as _};

    #[test]
    fn exact_without_noise() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(5);
        let truth = sensor(&mut random, 7, 6);
        let design = gaussian_matrix(&mut random, 40, 7);
        let fit = huber(&design, &(&design * &truth), None).unwrap();
        assert!((fit.coefficients - truth).largest() < 1e-13);
    }

    /// A tenth of the readings off by 300 standard deviations: within twice the error of the fit
    /// to the clean data, in the mean square over many sensors.
    #[test]
    fn outliers_cost_less_than_a_factor_of_two() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(6);
        let (mut robust, mut clean, mut spoilt) = (0.0, 0.0, 0.0);
        for _ in 0..200 {
            let truth = sensor(&mut random, 7, 6);
            let design = gaussian_matrix(&mut random, 100, 7);
            let good = &design * &truth + gaussian_matrix(&mut random, 100, 6) * 0.01;
            let mut bad = good.clone();
            for j in 0..6 {
                for i in 0..10 {
                    bad[((17 * j + 7 * i) % 100, j)] += if random.random_bool(0.5) { 3.0 } else { -3.0 };
                }
            }
            let error = |fit: super::Fit| (fit.coefficients - &truth).norm_squared();
            robust += error(huber(&design, &bad, None).unwrap());
            clean += error(least_squares(&design, &good, None).unwrap());
            spoilt += error(least_squares(&design, &bad, None).unwrap());
        }
        assert!(robust < 4.0 * clean, "{}", (robust / clean).sqrt());
        assert!(spoilt > 1000.0 * clean);
    }

    /// Of several responses, as many steps are told as the slowest takes.
    #[test]
    fn the_steps_are_those_of_the_slowest_response() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(7);
        let truth = sensor(&mut random, 7, 3);
        let design = gaussian_matrix(&mut random, 60, 7);
        let mut responses = &design * &truth;
        for i in 0..60 {
            responses[(i, 1)] += 0.01 * random.random_range(-1.0..1.0);
            responses[(i, 2)] += if i % 7 == 0 { 3.0 } else { 0.01 * random.random_range(-1.0..1.0) };
        }
        let steps = |first: usize, count: usize| {
            huber(&design, &responses.columns(first, count).into_owned(), None).unwrap().iterations
        };
        let each = [0, 1, 2].map(|response| steps(response, 1));
        assert_eq!(steps(0, 3), each.into_iter().max().unwrap());
        assert!(each[0] < each[2], "{each:?}");
    }
}
