//! Least squares with errors in the loads that differ from sample to sample.

use nalgebra::{DMatrix, DVector};

use super::regression::check;
use super::{Fit, FitError, least_squares};
use crate::linear::Triangular;

const MOST_ITERATIONS: usize = 200;

/// The Gauss-Helmert model: `y = Θᵀ (x + e) + noise`, with standard deviations of the errors `e`
/// and of the noise given for every sample (`docs/theory/calibration.md#errors-in-the-loads`; Helmert 1907;
/// Neitzel 2010 for why the loads must be adjusted in the iteration).
///
/// `design` is samples × regressors, `design_deviations` the same shape (0 for a regressor that is
/// exact, such as the constant), `response_deviations` samples × responses, positive. The maximum
/// of the likelihood over coefficients *and* true loads, by Gauss-Newton on
/// `r = y − Θᵀx`, `W = (Σ_y + Θᵀ Σ_x Θ)⁻¹`, with the adjusted loads `x̂ = x + Σ_x Θ W r` as
/// regressors; using `x` itself would give back the bias of least squares.
///
/// The `residual_covariance` is the mean over the samples of `Σ_y + Θᵀ Σ_x Θ`, scaled by what the
/// residuals say of it; with `inverse_gram` an approximation to the covariance.
///
/// # Errors
/// As [`least_squares`], and [`FitError::NoConvergence`].
pub fn gauss_helmert(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    design_deviations: &DMatrix<f64>,
    response_deviations: &DMatrix<f64>,
) -> Result<Fit, FitError> {
    check(design, responses, None)?;
    let (samples, k) = design.shape();
    let m = responses.ncols();
    if design_deviations.shape() != design.shape()
        || design_deviations.iter().any(|s| !(*s >= 0.0 && s.is_finite()))
        || response_deviations.shape() != responses.shape()
        || response_deviations.iter().any(|s| !(*s > 0.0 && s.is_finite()))
    {
        return Err(FitError::BadInput { what: "the matrix of standard deviations" });
    }
    let start = least_squares(design, responses, None)?;
    let mut theta = start.coefficients;
    // Relative to each coefficient's own size, so that units do not matter; or to what makes a ten-thousandth of the
    // readings, since what is smaller may be rounding, which never settles.
    let least = 1e-4 * responses.amax();
    let size: Vec<f64> = (theta.row_iter().zip(design.column_iter()))
        .map(|(row, loads)| row.amax().max(least / loads.amax()).max(f64::MIN_POSITIVE))
        .collect();
    let mut change = f64::INFINITY;
    for iteration in 1..=MOST_ITERATIONS {
        let mut triangular = Triangular::new(k * m, 1);
        let mut gram = Triangular::new(k, 1);
        let mut misfit = 0.0;
        let mut mean_covariance = DMatrix::zeros(m, m);
        for i in 0..samples {
            let x: DVector<f64> = design.row(i).transpose();
            let variances = design_deviations.row(i).transpose().map(|s| s * s);
            let residual: DVector<f64> = responses.row(i).transpose() - theta.transpose() * &x;
            let weighted_theta = DMatrix::from_diagonal(&variances) * &theta;
            let mut covariance = theta.transpose() * &weighted_theta;
            for j in 0..m {
                covariance[(j, j)] += response_deviations[(i, j)].powi(2);
            }
            mean_covariance += &covariance / samples as f64;
            let Some(factor) = covariance.cholesky() else {
                return Err(FitError::BadInput { what: "the matrix of standard deviations" });
            };
            let adjusted = &x + &weighted_theta * factor.solve(&residual);
            let root = factor.l();
            let mut white = residual.clone();
            root.solve_lower_triangular_mut(&mut white);
            misfit += white.norm_squared();
            gram.push(adjusted.as_slice(), &[0.0]);
            let mut inverse_root = DMatrix::identity(m, m);
            root.solve_lower_triangular_mut(&mut inverse_root);
            for row in 0..m {
                let line: Vec<f64> = (0..m)
                    .flat_map(|j| adjusted.iter().map(move |x| (x, j)))
                    .map(|(x, j)| inverse_root[(row, j)] * x)
                    .collect();
                triangular.push(&line, &[white[row]]);
            }
        }
        let step = triangular.factors().coefficients()?;
        let step = DMatrix::from_column_slice(k, m, step.as_slice());
        theta += &step;
        change = step.row_iter().zip(&size).map(|(row, size)| row.amax() / size).fold(0.0, f64::max);
        if change < 1e-12 || (iteration > 20 && change < 1e-9) {
            let freedom = (samples * m).saturating_sub(k * m).max(1) as f64;
            return Ok(Fit {
                coefficients: theta,
                inverse_gram: gram.factors().inverse_gram()?,
                residual_covariance: mean_covariance * (misfit / freedom),
                trust: DMatrix::from_element(samples, m, 1.0),
                iterations: iteration,
            });
        }
    }
    Err(FitError::NoConvergence { iterations: MOST_ITERATIONS, change })
}

#[cfg(test)]
mod tests {
    use super::gauss_helmert;
    use crate::fit::testing::{gaussian, gaussian_matrix, sensor};
    use crate::fit::{least_squares, total_least_squares};
    use crate::testing::Largest as _;
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    #[test]
    fn equals_total_least_squares_where_errors_are_alike() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(4);
        let truth = sensor(&mut random, 4, 3);
        let loads = gaussian_matrix(&mut random, 200, 3) + gaussian_matrix(&mut random, 200, 3) * 0.1;
        let design = loads.clone().insert_column(3, 1.0);
        let responses = &design * &truth + gaussian_matrix(&mut random, 200, 3) * 0.2;
        let total = total_least_squares(&loads, &responses, &[0.1; 3], &[0.2; 3], true).unwrap();
        let mut deviations = DMatrix::from_element(200, 4, 0.1);
        deviations.column_mut(3).fill(0.0);
        let fit =
            gauss_helmert(&design, &responses, &deviations, &DMatrix::from_element(200, 3, 0.2)).unwrap();
        assert!((fit.coefficients - total.coefficients).largest() < 1e-9);
    }

    #[test]
    fn better_than_either_where_errors_differ() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(5);
        let (mut with, mut without) = (0.0, 0.0);
        for _ in 0..10 {
            let truth = sensor(&mut random, 3, 3);
            let loads = gaussian_matrix(&mut random, 300, 3);
            let deviations = DMatrix::from_fn(300, 3, |i, _| if i % 2 == 0 { 0.02 } else { 0.8 });
            let responses = &loads * &truth + gaussian_matrix(&mut random, 300, 3) * 0.02;
            let design = loads + deviations.map(|s| s * gaussian(&mut random));
            let fit = gauss_helmert(&design, &responses, &deviations, &DMatrix::from_element(300, 3, 0.02))
                .unwrap();
            with += (fit.coefficients - &truth).norm_squared();
            without +=
                (least_squares(&design, &responses, None).unwrap().coefficients - &truth).norm_squared();
        }
        assert!(with * 400.0 < without, "{with:e} {without:e}");
    }

    #[test]
    fn exact_without_noise() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(6);
        let truth = sensor(&mut random, 6, 6);
        let design = gaussian_matrix(&mut random, 20, 6);
        let deviations = DMatrix::from_fn(20, 6, |i, j| 0.01 * (1 + i + j) as f64);
        let fit = gauss_helmert(&design, &(&design * &truth), &deviations, &deviations).unwrap();
        assert!((fit.coefficients - truth).largest() < 1e-12);
    }
}
