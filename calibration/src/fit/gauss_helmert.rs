//! Least squares with errors in the loads that differ from sample to sample.

use nalgebra::{DMatrix, DVector};

use super::errors_in_both::with_noise_of_regressors;
use super::regression::check;
use super::{Fit, FitError, least_squares};
use crate::linear::Triangular;

const MOST_ITERATIONS: usize = 200;

/// The errors of one sample: covariances of its regressors, of its regressors with its responses, of its responses.
struct Errors {
    loads: DMatrix<f64>,
    mixed: DMatrix<f64>,
    readings: DMatrix<f64>,
}

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
/// The deviations count in their ratios: how large they are together is taken from the residuals.
/// `full_covariance` is that of the coefficients, `σ² M⁻¹GM⁻¹` with `G = Σ W ⊗ x̂x̂ᵀ` and M what is left of it
/// without the noise of `x̂`. `residual_covariance` is the mean over the samples of `Σ_y + Θᵀ Σ_x Θ`, in the same
/// scale, and `inverse_gram` makes the product with it the nearest one to `full_covariance`.
///
/// # Errors
/// As [`least_squares`], [`FitError::NoConvergence`], and [`FitError::NotIdentified`] if the loads vary no more
/// than their errors.
pub fn gauss_helmert(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    design_deviations: &DMatrix<f64>,
    response_deviations: &DMatrix<f64>,
) -> Result<Fit, FitError> {
    check(design, responses, None)?;
    if design_deviations.shape() != design.shape()
        || design_deviations.iter().any(|s| !(*s >= 0.0 && s.is_finite()))
        || response_deviations.shape() != responses.shape()
        || response_deviations.iter().any(|s| !(*s > 0.0 && s.is_finite()))
    {
        return Err(FitError::BadInput { what: "the matrix of standard deviations" });
    }
    solve(design, responses, |i| uncorrelated(design_deviations, response_deviations, i))
}

/// [`gauss_helmert`] with errors that are correlated within a sample: of loads with each other (a weight that is
/// wrong is wrong in force and torque alike), of readings, and of both.
///
/// `errors` holds a covariance for each sample, (regressors + responses) squared, regressors first; zero rows
/// and columns for a regressor that is exact. Between samples errors are independent.
///
/// # Errors
/// As [`gauss_helmert`]; [`FitError::BadInput`] for a covariance of another size, that is not finite or not
/// symmetric, or that leaves some combination of readings without an error.
pub fn gauss_helmert_correlated(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    errors: &[DMatrix<f64>],
) -> Result<Fit, FitError> {
    check(design, responses, None)?;
    let (k, m) = (design.ncols(), responses.ncols());
    let bad = |covariance: &DMatrix<f64>| {
        covariance.shape() != (k + m, k + m)
            || covariance.iter().any(|x| !x.is_finite())
            || (covariance - covariance.transpose()).amax() > 1e-9 * covariance.amax()
            || covariance.diagonal().iter().any(|variance| *variance < 0.0)
    };
    if errors.len() != design.nrows() || errors.iter().any(bad) {
        return Err(FitError::BadInput { what: "the list of covariances" });
    }
    solve(design, responses, |i| Errors {
        loads: errors[i].view((0, 0), (k, k)).into_owned(),
        mixed: errors[i].view((0, k), (k, m)).into_owned(),
        readings: errors[i].view((k, k), (m, m)).into_owned(),
    })
}

/// [`gauss_helmert`] where an error of a regressor has a fixed part and a share of the regressor itself.
///
/// It is the true load that the share is of. Taken of the stated one it would be small where the error made the load
/// small, and such samples would count too much: a bias of some twice the share squared. So the shares are taken of
/// the adjusted loads, and the fit is made anew until these stay.
///
/// # Errors
/// As [`gauss_helmert`].
pub(crate) fn gauss_helmert_of_shares(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    (fixed, share): (&DMatrix<f64>, &DMatrix<f64>),
    response_deviations: &DMatrix<f64>,
) -> Result<Fit, FitError> {
    /// A change of the deviations by a hundred-thousandth moves coefficients by far less than their errors.
    const SETTLED: f64 = 1e-5;
    const MOST_ROUNDS: usize = 30;
    let deviations = |loads: &DMatrix<f64>| {
        fixed.zip_zip_map(share, loads, |fixed, share, load| fixed.hypot(share * load))
    };
    let mut stated = deviations(design);
    let mut fit = gauss_helmert(design, responses, &stated, response_deviations)?;
    if share.iter().all(|share| *share == 0.0) {
        return Ok(fit);
    }
    let size = stated.amax();
    for _ in 0..MOST_ROUNDS {
        let next = deviations(&adjusted(design, responses, &fit.coefficients, &stated, response_deviations)?);
        let change = (&next - &stated).amax();
        stated = next;
        fit = gauss_helmert(design, responses, &stated, response_deviations)?;
        if change <= SETTLED * size {
            break;
        }
    }
    Ok(fit)
}

/// The adjusted loads `x + Σ_x Θ W r` of all samples.
fn adjusted(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    theta: &DMatrix<f64>,
    design_deviations: &DMatrix<f64>,
    response_deviations: &DMatrix<f64>,
) -> Result<DMatrix<f64>, FitError> {
    let mut loads = design.clone();
    for i in 0..design.nrows() {
        let errors = uncorrelated(design_deviations, response_deviations, i);
        let one = Adjusted::new(design.row(i).transpose(), responses.row(i).transpose(), theta, errors)?;
        loads.set_row(i, &one.load.transpose());
    }
    Ok(loads)
}

/// Errors that are not correlated, by their deviations in row `i`.
fn uncorrelated(design_deviations: &DMatrix<f64>, response_deviations: &DMatrix<f64>, i: usize) -> Errors {
    let squared = |row: nalgebra::DMatrixView<'_, f64>| {
        DMatrix::from_diagonal(&DVector::from_iterator(row.len(), row.iter().map(|s| s * s)))
    };
    Errors {
        loads: squared(design_deviations.rows(i, 1).as_view()),
        mixed: DMatrix::zeros(design_deviations.ncols(), response_deviations.ncols()),
        readings: squared(response_deviations.rows(i, 1).as_view()),
    }
}

/// One sample with its load adjusted to its reading.
struct Adjusted {
    /// `x + (Σ_xΘ − Σ_xy) W r`.
    load: DVector<f64>,
    /// `r = y − Θᵀx`.
    residual: DVector<f64>,
    /// `W⁻¹`, and its triangle.
    covariance: DMatrix<f64>,
    root: DMatrix<f64>,
    /// `Σ_xΘ − Σ_xy`.
    carried: DMatrix<f64>,
    /// `Σ_x`.
    loads: DMatrix<f64>,
}

impl Adjusted {
    fn new(x: DVector<f64>, y: DVector<f64>, theta: &DMatrix<f64>, errors: Errors) -> Result<Self, FitError> {
        let Errors { loads, mixed, readings } = errors;
        let residual = y - theta.tr_mul(&x);
        // Covariances of the residual, and of minus the error of the load with it.
        let carried = &loads * theta - &mixed;
        let covariance = readings - mixed.tr_mul(theta) + theta.tr_mul(&carried);
        let factor = covariance
            .clone()
            .cholesky()
            .ok_or(FitError::BadInput { what: "the matrix of standard deviations" })?;
        let load = x + &carried * factor.solve(&residual);
        Ok(Self { load, residual, covariance, root: factor.l(), carried, loads })
    }
}

fn solve(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    errors: impl Fn(usize) -> Errors,
) -> Result<Fit, FitError> {
    let (k, m) = (design.ncols(), responses.ncols());
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
        let sums = Sums::new(design, responses, &theta, &errors)?;
        let Sums { mut triangular, misfit, .. } = sums;
        let factors = triangular.factors();
        let step = factors.coefficients()?;
        let step = DMatrix::from_column_slice(k, m, step.as_slice());
        theta += &step;
        change = step.row_iter().zip(&size).map(|(row, size)| row.amax() / size).fold(0.0, f64::max);
        if change < 1e-12 || (iteration > 20 && change < 1e-9) {
            let freedom = (design.nrows() * m).saturating_sub(k * m).max(1) as f64;
            let variance = misfit / freedom;
            let full = with_noise_of_regressors(&factors.inverse_root()?, &(sums.noise * variance))?;
            return Ok(Fit {
                coefficients: theta,
                inverse_gram: nearest_gram(&full, &sums.covariance, k)?,
                residual_covariance: sums.covariance * variance,
                full_covariance: Some(full * variance),
                freedom,
                trust: DMatrix::from_element(design.nrows(), m, 1.0),
                iterations: iteration,
            });
        }
    }
    Err(FitError::NoConvergence { iterations: MOST_ITERATIONS, change })
}

/// What one step and the covariance need of all samples.
struct Sums {
    /// Whitened residuals on the adjusted loads.
    triangular: Triangular,
    /// `Σ rᵀWr`.
    misfit: f64,
    /// The mean of `W⁻¹`.
    covariance: DMatrix<f64>,
    /// `Σ W ⊗ P`, with P the covariance of an adjusted load.
    noise: DMatrix<f64>,
}

impl Sums {
    fn new(
        design: &DMatrix<f64>,
        responses: &DMatrix<f64>,
        theta: &DMatrix<f64>,
        errors: impl Fn(usize) -> Errors,
    ) -> Result<Self, FitError> {
        let ((samples, k), m) = (design.shape(), responses.ncols());
        let mut triangular = Triangular::new(k * m, 1);
        let (mut misfit, mut mean) = (0.0, DMatrix::zeros(m, m));
        let mut noise = DMatrix::zeros(k * m, k * m);
        for i in 0..samples {
            let (x, y) = (design.row(i).transpose(), responses.row(i).transpose());
            let one = Adjusted::new(x, y, theta, errors(i))?;
            let Adjusted { load: adjusted, mut residual, covariance, root, carried, loads } = one;
            mean += &covariance / samples as f64;
            root.solve_lower_triangular_mut(&mut residual);
            misfit += residual.norm_squared();
            let mut inverse_root = DMatrix::identity(m, m);
            root.solve_lower_triangular_mut(&mut inverse_root);
            for row in 0..m {
                let line: Vec<f64> = (0..m)
                    .flat_map(|j| adjusted.iter().map(move |x| (x, j)))
                    .map(|(x, j)| inverse_root[(row, j)] * x)
                    .collect();
                triangular.push(&line, &[residual[row]]);
            }
            let weight = inverse_root.tr_mul(&inverse_root);
            noise += weight.kronecker(&(loads - &carried * &weight * carried.transpose()));
        }
        Ok(Self { triangular, misfit, covariance: mean, noise })
    }
}

/// The matrix whose product with the covariance of the residuals comes nearest to the covariance of all coefficients:
/// its mean over the responses, in units of that covariance.
fn nearest_gram(full: &DMatrix<f64>, residual: &DMatrix<f64>, k: usize) -> Result<DMatrix<f64>, FitError> {
    let m = residual.nrows();
    let inverse = residual
        .clone()
        .cholesky()
        .ok_or(FitError::BadInput { what: "the matrix of standard deviations" })?
        .inverse();
    Ok(DMatrix::from_fn(k, k, |i, p| {
        let terms = (0..m).flat_map(|j| (0..m).map(move |l| (j, l)));
        terms.map(|(j, l)| full[(j * k + i, l * k + p)] * inverse[(l, j)]).sum::<f64>() / m as f64
    }))
}

#[cfg(test)]
mod tests {
    use super::{Errors, Sums, gauss_helmert};
    use crate::fit::testing::{gaussian, gaussian_matrix, sensor};
    use crate::fit::{least_squares, total_least_squares};
    use crate::testing::Largest as _;
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    /// What is regressed on may be exact; what is read is not.
    #[test]
    fn a_reading_without_an_error_is_refused() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(6);
        let design = gaussian_matrix(&mut random, 12, 2);
        let responses = &design * sensor(&mut random, 2, 3);
        let exact = DMatrix::zeros(12, 2);
        let mut deviations = DMatrix::repeat(12, 3, 0.1);
        assert!(gauss_helmert(&design, &responses, &exact, &deviations).is_ok());
        for bad in [0.0, -0.1, f64::NAN, f64::INFINITY] {
            deviations[(7, 1)] = bad;
            assert!(gauss_helmert(&design, &responses, &exact, &deviations).is_err(), "{bad}");
        }
    }

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

    /// One load and one reading: an adjusted load has the variance of the weighted mean of the load and of what the reading says
    /// of it, `σ_x²σ_y²/(σ_y² + θ²σ_x²)`.
    #[test]
    fn the_noise_of_an_adjusted_load_is_that_of_a_weighted_mean() {
        let one = |value: f64| DMatrix::from_element(1, 1, value);
        let (theta, of_load, of_reading) = (3.0, 0.04, 0.25);
        let errors = |_| Errors { loads: one(of_load), mixed: one(0.0), readings: one(of_reading) };
        let sums = Sums::new(&one(2.0), &one(7.0), &one(theta), errors).unwrap();
        let residual = of_reading + theta * theta * of_load;
        assert!((sums.covariance[(0, 0)] / residual - 1.0).abs() < 1e-12, "{}", sums.covariance);
        let expected = of_load * of_reading / residual / residual;
        assert!((sums.noise[(0, 0)] / expected - 1.0).abs() < 1e-12, "{}", sums.noise);
        assert!((sums.misfit * residual - 1.0).abs() < 1e-12, "{}", sums.misfit);
    }
}
