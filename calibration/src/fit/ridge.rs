//! Least squares with a prior.

use nalgebra::DMatrix;

use super::regression::{accumulate, check};
use super::{Fit, FitError};

/// The maximum a posteriori estimate with a Gaussian prior: `Θ = (XᵀX + Λ)⁻¹ (XᵀY + ΛΘ₀)`
/// (`docs/theory/calibration.md#prior-knowledge`), computed by QR of the rows of the data with those of
/// `Λ^{1/2} [I | Θ₀]` below.
///
/// `precision` Λ is symmetric positive definite, the inverse covariance of the prior in units of
/// the residual variance: `σ² Σ₀⁻¹`. With `Λ = λ I` and Θ₀ = 0 it is ridge regression. Directions
/// that the data do not observe stay at the prior.
///
/// `inverse_gram` is `(XᵀX + Λ)⁻¹`: the covariance of the posterior.
///
/// # Errors
/// [`FitError::BadInput`] if sizes do not match or Λ is not positive definite.
pub fn ridge(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    weights: Option<&[f64]>,
    prior: &DMatrix<f64>,
    precision: &DMatrix<f64>,
) -> Result<Fit, FitError> {
    check(design, responses, weights)?;
    let (samples, k) = design.shape();
    let m = responses.ncols();
    if prior.shape() != (k, m) || prior.iter().any(|x| !x.is_finite()) {
        return Err(FitError::BadInput { what: "the prior" });
    }
    let factor = (precision.shape() == (k, k))
        .then(|| precision.clone().cholesky())
        .flatten()
        .ok_or(FitError::BadInput { what: "the precision of the prior" })?;
    let root = factor.l().transpose();
    let target = &root * prior;
    let mut triangular = accumulate(design, responses, |i| weights.map_or(1.0, |w| w[i]));
    for i in 0..k {
        let x: Vec<f64> = root.row(i).iter().copied().collect();
        let y: Vec<f64> = target.row(i).iter().copied().collect();
        triangular.push(&x, &y);
    }
    let factors = triangular.factors();
    let coefficients = factors.coefficients()?;
    // The prior's k rows pay for the k coefficients: what is left is the number of samples that count.
    let counted = weights.map_or(samples, |w| w.iter().filter(|weight| **weight > 0.0).count());
    let residual_covariance = factors.residual.transpose() * &factors.residual / counted.max(1) as f64;
    Ok(Fit {
        coefficients,
        inverse_gram: factors.inverse_gram()?,
        residual_covariance,
        full_covariance: None,
        freedom: counted as f64,
        trust: DMatrix::from_element(samples, m, 1.0),
        iterations: 1,
    })
}

#[cfg(test)]
mod tests {
    use super::ridge;
    use crate::fit::least_squares;
    use crate::fit::testing::{gaussian_matrix, sensor};
    use crate::testing::Largest as _;
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    #[test]
    fn formula_and_limits() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(4);
        let (truth, prior) = (sensor(&mut random, 6, 6), sensor(&mut random, 6, 6));
        let design = gaussian_matrix(&mut random, 30, 6);
        let responses = &design * &truth + gaussian_matrix(&mut random, 30, 6) * 0.1;
        let half = gaussian_matrix(&mut random, 6, 6);
        let precision = &half * half.transpose() + DMatrix::identity(6, 6);
        let fit = ridge(&design, &responses, None, &prior, &precision).unwrap();
        // The normal equations: a fair oracle while all is well conditioned.
        let left = design.transpose() * &design + &precision;
        let right = design.transpose() * &responses + &precision * &prior;
        assert!((left * fit.coefficients - right).largest() < 1e-11);
        let weak = ridge(&design, &responses, None, &prior, &(&precision * 1e-14)).unwrap();
        let plain = least_squares(&design, &responses, None).unwrap();
        assert!((weak.coefficients - plain.coefficients).largest() < 1e-12);
        let exact = ridge(&design, &(&design * &prior), None, &prior, &precision).unwrap();
        assert!((exact.coefficients - &prior).largest() < 1e-13);
        assert!(ridge(&design, &responses, None, &prior, &-precision).is_err());
    }

    #[test]
    fn unobserved_directions_stay_at_the_prior() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(8);
        let (truth, prior) = (sensor(&mut random, 6, 6), sensor(&mut random, 6, 6));
        let mut design = gaussian_matrix(&mut random, 30, 6);
        design.column_mut(4).fill(0.0);
        let fit = ridge(&design, &(&design * truth), None, &prior, &DMatrix::identity(6, 6)).unwrap();
        assert!((fit.coefficients.row(4) - prior.row(4)).largest() < 4.0 * f64::EPSILON);
    }
}
