//! Least squares with errors in the loads too.

use nalgebra::{DMatrix, DVector};

use super::errors_in_both::with_noise_of_regressors;
use super::regression::{accumulate, check};
use super::{Fit, FitError};
use crate::linear::{Singular, Triangular};

/// Total least squares of `y = xᵀΘ (+ constant)` where the regressors have errors of standard
/// deviation `regressor_deviations` and the responses of `response_deviations`, both independent
/// (`docs/theory/calibration.md#errors-in-the-loads`; Van Huffel & Vandewalle 1991).
///
/// Columns are divided by their deviations, an exact constant column is projected out first, and
/// the right singular vectors of the smallest singular values give the answer; a QR accumulator
/// reduces the data before, so that this streams. Ordinary least squares would attenuate: it tends
/// to `C (I + Σ_e Σ_P⁻¹)⁻¹`.
///
/// With `constant`, the last row of the coefficients is the constant. The deviations count in their ratios; how
/// large they are together is taken from the residuals. The covariance is the first order one,
/// `inverse_gram` being `A⁻¹(A + nP)A⁻¹` with `A` the loads' own part of `Σ xxᵀ` and `P` what is not known of an
/// adjusted load (Fuller 1987, section 4.1).
///
/// # Errors
/// [`FitError::NotIdentified`] if the loads vary no more than their errors; as
/// [`super::least_squares`] otherwise.
pub fn total_least_squares(
    regressors: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    regressor_deviations: &[f64],
    response_deviations: &[f64],
    constant: bool,
) -> Result<Fit, FitError> {
    check(regressors, responses, None)?;
    let (samples, k) = regressors.shape();
    let m = responses.ncols();
    let positive =
        |list: &[f64], length| list.len() == length && list.iter().all(|x| *x > 0.0 && x.is_finite());
    if !positive(regressor_deviations, k) || !positive(response_deviations, m) {
        return Err(FitError::BadInput { what: "the list of standard deviations" });
    }
    if samples <= k + usize::from(constant) {
        return Err(FitError::TooFewSamples { samples, coefficients: k + usize::from(constant) });
    }
    let lead = usize::from(constant);
    let mut triangular = Triangular::new(lead, k + m);
    let mut row = vec![0.0; k + m];
    for i in 0..samples {
        let values =
            regressors.row(i).iter().zip(regressor_deviations).map(|(x, s)| x / s).collect::<Vec<_>>();
        row[..k].copy_from_slice(&values);
        for (slot, (y, s)) in row[k..].iter_mut().zip(responses.row(i).iter().zip(response_deviations)) {
            *slot = y / s;
        }
        triangular.push(&[1.0][..lead], &row);
    }
    let factors = triangular.factors();
    let singular = Singular::new(&factors.residual).ok_or(FitError::BadInput { what: "the data" })?;
    // The answer is unique if the k-th singular value stands clear of the next.
    let gap = singular.values[k - 1] - singular.values[k];
    if !(gap > 1e3 * f64::EPSILON * singular.values[0]) {
        return Err(FitError::NotIdentified);
    }
    let null = singular.right.columns(k, m);
    let (top, bottom) = (null.rows(0, k), null.rows(k, m).into_owned());
    let inverse = bottom.full_piv_lu().try_inverse().ok_or(FitError::NotIdentified)?;
    let scaled = -(top * inverse);
    let mut coefficients = DMatrix::zeros(k + lead, m);
    for i in 0..k {
        for j in 0..m {
            coefficients[(i, j)] = scaled[(i, j)] * response_deviations[j] / regressor_deviations[i];
        }
    }
    if constant {
        let means = regressors.row_mean();
        let row = responses.row_mean() - means * coefficients.rows(0, k);
        coefficients.set_row(k, &row);
    }
    let mut design = regressors.clone();
    if constant {
        design = design.insert_column(k, 1.0);
    }
    let residuals = responses - &design * &coefficients;
    let residual_covariance = residuals.transpose() * &residuals / (samples - k - lead) as f64;
    let freedom = (samples - k - lead) as f64;
    // What the residuals tell of each load: x̂ = x + Σ_e Θ W r, with W = (Σ_V + Θᵀ Σ_e Θ)⁻¹.
    let squares = |list: &[f64]| DVector::from_iterator(list.len(), list.iter().map(|s| s * s));
    let mut of_loads = DMatrix::zeros(k + lead, k + lead);
    of_loads.view_mut((0, 0), (k, k)).set_diagonal(&squares(regressor_deviations));
    let carried = &of_loads * &coefficients;
    let of_readings = DMatrix::from_diagonal(&squares(response_deviations));
    let weight = (of_readings + coefficients.tr_mul(&carried))
        .cholesky()
        .ok_or(FitError::BadInput { what: "the list of standard deviations" })?
        .inverse();
    let variance = (&residuals * &weight).component_mul(&residuals).sum() / (freedom * m as f64);
    let adjusted = design + &residuals * &weight * carried.transpose();
    let left = (of_loads - &carried * &weight * carried.transpose()) * variance;
    let factors = accumulate(&adjusted, responses, |_| 1.0).factors();
    Ok(Fit {
        coefficients,
        inverse_gram: with_noise_of_regressors(&factors.inverse_root()?, &(left * samples as f64))?,
        residual_covariance,
        full_covariance: None,
        freedom,
        trust: DMatrix::from_element(samples, m, 1.0),
        iterations: 1,
    })
}

#[cfg(test)]
mod tests {
    use super::total_least_squares;
    use crate::fit::testing::{gaussian_matrix, sensor};
    use crate::fit::{FitError, least_squares};
    use crate::testing::Largest as _;
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    #[test]
    fn exact_without_noise() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(2);
        let truth = sensor(&mut random, 7, 8);
        let loads = gaussian_matrix(&mut random, 30, 6);
        let responses = loads.clone().insert_column(6, 1.0) * &truth;
        let fit = total_least_squares(&loads, &responses, &[0.1; 6], &[0.2; 8], true).unwrap();
        assert!((fit.coefficients - truth).largest() < 1e-12);
    }

    /// The attenuation of least squares, as the formula has it, and none in total least squares.
    #[test]
    fn consistent_where_least_squares_is_biased() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(9);
        let samples = 40_000;
        let truth = sensor(&mut random, 6, 6);
        let loads = gaussian_matrix(&mut random, samples, 6);
        let responses = &loads * &truth + gaussian_matrix(&mut random, samples, 6) * 0.1;
        let deviations = [0.5, 0.1, 0.2, 0.3, 0.4, 0.1];
        let errors = DMatrix::from_fn(samples, 6, |_, j| deviations[j]).component_mul(&gaussian_matrix(
            &mut random,
            samples,
            6,
        ));
        let uncertain = loads + errors;
        let total = total_least_squares(&uncertain, &responses, &deviations, &[0.1; 6], false).unwrap();
        assert!((total.coefficients - &truth).largest() < 0.03 * truth.largest());
        let plain = least_squares(&uncertain, &responses, None).unwrap().coefficients;
        let attenuated = DMatrix::from_fn(6, 6, |i, j| truth[(i, j)] / (1.0 + deviations[i] * deviations[i]));
        assert!((&plain - attenuated).largest() < 0.02 * truth.largest());
        assert!((plain - &truth).largest() > 0.15 * truth.largest());
    }

    /// One load and one gauge, both with errors: of a load that reads `x̂` after its adjustment the variance
    /// `σx²σy²/(σy² + b²σx²)` is left, so that `Σx̂²` is by so much for each sample above `S = Σx²` of the true loads, and
    /// the coefficient has `(S + n·left)/S²` (Fuller 1987, section 1.3).
    #[test]
    fn what_is_left_of_the_errors_of_loads_counts_in_the_error_of_the_fit() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(21);
        let samples = 20_000;
        let loads = gaussian_matrix(&mut random, samples, 1);
        for (slope, of_load, of_reading) in [(1.0, 0.5, 0.5), (-2.0, 0.4, 1.5), (0.3, 0.7, 0.1)] {
            let read = |random: &mut _, size: f64| gaussian_matrix(random, samples, 1) * size;
            let uncertain = &loads + read(&mut random, of_load);
            let responses = &loads * slope + read(&mut random, of_reading);
            let fit = total_least_squares(&uncertain, &responses, &[of_load], &[of_reading], false).unwrap();
            let [vx, vy] = [of_load, of_reading].map(|deviation: f64| deviation * deviation);
            let left = samples as f64 * vx * vy / (vy + slope * slope * vx);
            let sum = loads.norm_squared();
            let ratio = fit.inverse_gram[(0, 0)] * sum * sum / (sum + left);
            assert!((ratio - 1.0).abs() < 0.05, "{slope} {of_load} {of_reading}: {ratio}");
        }
    }

    /// Loads that are as good as exact leave least squares: the same coefficients, and the same statement of
    /// their errors, with as many degrees of freedom.
    #[test]
    fn least_squares_are_the_limit_of_exact_loads() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(12);
        for (constant, samples) in [(false, 4), (true, 5), (false, 9), (true, 9)] {
            let loads = gaussian_matrix(&mut random, samples, 3);
            let design = if constant { loads.clone().insert_column(3, 1.0) } else { loads.clone() };
            let truth = sensor(&mut random, design.ncols(), 2);
            let responses = &design * truth + gaussian_matrix(&mut random, samples, 2) * 0.1;
            let total = total_least_squares(&loads, &responses, &[1e-8; 3], &[0.1; 2], constant).unwrap();
            let plain = least_squares(&design, &responses, None).unwrap();
            // Of the order of the errors of the loads over those of the responses, squared, and of rounding,
            // both times the condition of few random loads.
            let near = |a: &DMatrix<f64>, b: &DMatrix<f64>| (a - b).largest() <= 1e-9 * b.largest();
            assert!(near(&total.coefficients, &plain.coefficients), "{samples}");
            assert!(near(&total.residual_covariance, &plain.residual_covariance), "{samples}");
            assert!(near(&total.inverse_gram, &plain.inverse_gram), "{samples}");
            assert_eq!((total.trust, total.iterations), (plain.trust, 1));
            let fewer =
                (loads.rows(1, samples - 1).into_owned(), responses.rows(1, samples - 1).into_owned());
            let fewer = total_least_squares(&fewer.0, &fewer.1, &[1e-8; 3], &[0.1; 2], constant);
            assert_eq!(fewer.is_ok(), samples == 9);
        }
    }

    #[test]
    fn no_more_variation_than_error_is_refused() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(9);
        let loads = DMatrix::from_fn(20, 2, |i, _| i as f64);
        let responses = gaussian_matrix(&mut random, 20, 2);
        let answer = total_least_squares(&loads, &responses, &[1.0; 2], &[0.0; 2], false);
        assert!(matches!(answer, Err(FitError::BadInput { .. })));
        for wrong in [f64::NAN, f64::INFINITY, -1.0] {
            let answer = total_least_squares(&loads, &responses, &[1.0, wrong], &[1.0; 2], false);
            assert!(matches!(answer, Err(FitError::BadInput { .. })), "{wrong}");
        }
        for (regressors, responding) in [(1, 2), (2, 3)] {
            let (regressors, responding) = (vec![1.0; regressors], vec![1.0; responding]);
            let answer = total_least_squares(&loads, &responses, &regressors, &responding, false);
            assert!(matches!(answer, Err(FitError::BadInput { .. })));
        }
        let zero = DMatrix::zeros(20, 2);
        let answer = total_least_squares(&zero, &zero, &[1.0; 2], &[1.0; 2], false);
        assert_eq!(answer.unwrap_err(), FitError::NotIdentified);
    }
}
