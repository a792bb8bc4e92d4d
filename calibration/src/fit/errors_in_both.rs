//! The covariance of a fit whose regressors have errors too.

use nalgebra::DMatrix;

use super::FitError;

/// Beyond this share of noise in some combination of the regressors the first order no longer tells the errors of
/// the fit: found by trying it, on shapes and sensors, down to where the intervals no longer held.
const MOST_NOISE: f64 = 0.7;

/// Covariance of coefficients, but for the variance of weight one, where the regressors were adjusted:
/// `M⁻¹ G M⁻¹` with `G = Σ X̂ᵀWX̂` of the adjusted regressors and `M = G − N`, what is left of it without
/// their noise `N` (`docs/theory/calibration.md#errors-in-the-loads`; Fuller 1987, section 3.1).
///
/// `root` is R⁻¹ of the triangle `G = RᵀR` (k × k), `noise` is N (k × k, symmetric). With `T = R⁻ᵀNR⁻¹` the
/// answer is `R⁻¹(I − T)⁻²R⁻ᵀ`, so that nothing is lost where N is small.
///
/// # Errors
/// [`FitError::NotIdentified`] if an eigenvalue of T, the share of noise in a combination of the regressors, is
/// above 0.7 or not finite.
pub(crate) fn with_noise_of_regressors(
    root: &DMatrix<f64>,
    noise: &DMatrix<f64>,
) -> Result<DMatrix<f64>, FitError> {
    let share = root.transpose() * noise * root;
    if share.iter().any(|x| !x.is_finite()) {
        return Err(FitError::NotIdentified);
    }
    let eigen = ((&share + share.transpose()) * 0.5).symmetric_eigen();
    if !eigen.eigenvalues.iter().all(|share| *share < MOST_NOISE) {
        return Err(FitError::NotIdentified);
    }
    let mut spread = root * eigen.eigenvectors;
    for (mut column, share) in spread.column_iter_mut().zip(eigen.eigenvalues.iter()) {
        column /= 1.0 - share.max(0.0);
    }
    Ok(&spread * spread.transpose())
}

#[cfg(test)]
mod tests {
    use super::with_noise_of_regressors;
    use crate::fit::FitError;
    use crate::fit::testing::gaussian_matrix;
    use crate::testing::Largest as _;
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    /// The formula by inverses, which are fair while all is well conditioned.
    #[test]
    fn formula_and_refusals() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        for _ in 0..50 {
            let rows = gaussian_matrix(&mut random, 12, 4);
            let gram = rows.transpose() * &rows;
            let some = gaussian_matrix(&mut random, 4, 2);
            let noise = &some * some.transpose() * 0.05;
            let upper = gram.clone().cholesky().unwrap().l().transpose();
            let root = upper.try_inverse().unwrap();
            let Ok(found) = with_noise_of_regressors(&root, &noise) else { continue };
            let left = (&gram - &noise).try_inverse().unwrap();
            let expected = &left * &gram * &left;
            assert!((&found - &expected).largest() < 1e-10 * expected.largest());
            let none = with_noise_of_regressors(&root, &DMatrix::zeros(4, 4)).unwrap();
            assert!((none * &gram - DMatrix::identity(4, 4)).largest() < 1e-11);
            for bad in [&gram * 0.95, &gram * f64::NAN, &gram * f64::INFINITY] {
                assert_eq!(with_noise_of_regressors(&root, &bad).unwrap_err(), FitError::NotIdentified);
            }
        }
    }
}
