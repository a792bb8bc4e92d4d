//! Linear regression of several responses: the problem, its answer, and plain least squares.

use nalgebra::DMatrix;
use statrs::distribution::{ContinuousCDF as _, StudentsT};
use thiserror::Error;

use crate::linear::{Triangular, Unobserved};

/// The answer of a fit `y ≈ xᵀ Θ`.
///
/// ```
/// use fingertip_calibration::fit::{Fit, least_squares};
/// use fingertip_calibration::nalgebra::DMatrix;
///
/// // 1 V at 0 N and 3.1, 4.9, 7 V at 1, 2, 3 N: about 2 V/N.
/// let design = DMatrix::from_row_slice(4, 2, &[1.0, 0.0, 1.0, 1.0, 1.0, 2.0, 1.0, 3.0]);
/// let fit: Fit = least_squares(&design, &DMatrix::from_column_slice(4, 1, &[1.0, 3.1, 4.9, 7.0]), None)?;
/// assert!((fit.coefficients[1] - 1.98).abs() < 1e-12 && fit.freedom == 2.0);
/// // With two degrees of freedom the interval of 95 % is 4.3 deviations wide to either side.
/// let factor = fit.half_widths(0.95)[1] / fit.deviations()[1];
/// assert!((factor - 4.303).abs() < 1e-3);
/// # Ok::<(), fingertip_calibration::fit::FitError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Θ, regressors × responses.
    pub coefficients: DMatrix<f64>,
    /// `(Σ w x xᵀ)⁻¹`, regressors × regressors.
    pub inverse_gram: DMatrix<f64>,
    /// Covariance of one sample's residuals (of weight 1), responses × responses. With
    /// `inverse_gram` it gives the covariance of the coefficients: entry `(i, j)` with `(k, l)` is
    /// `inverse_gram[i][k] · residual_covariance[j][l]` (`docs/theory/calibration.md#least-squares`).
    pub residual_covariance: DMatrix<f64>,
    /// The covariance of the coefficients where it is no such product (errors that differ from sample to
    /// sample in another way for each response): that of Θ column by column, (regressors · responses) squared.
    /// The product is then the nearest one, and [`deviations`](Self::deviations) are taken from this.
    pub full_covariance: Option<DMatrix<f64>>,
    /// Degrees of freedom behind `residual_covariance`: samples that count, less what the fit used up.
    pub freedom: f64,
    /// By how much each sample counted for each response, in \[0, 1\]: 1 for plain least squares,
    /// less for what a robust fit distrusts.
    pub trust: DMatrix<f64>,
    /// Iterations that an iterative fit took; 1 otherwise.
    pub iterations: usize,
}

impl Fit {
    /// Standard deviation of each coefficient, regressors × responses, in the unit of the coefficient.
    #[must_use]
    pub fn deviations(&self) -> DMatrix<f64> {
        let (k, m) = self.coefficients.shape();
        DMatrix::from_fn(k, m, |i, j| {
            let variance = match &self.full_covariance {
                Some(full) => full[(j * k + i, j * k + i)],
                None => self.inverse_gram[(i, i)] * self.residual_covariance[(j, j)],
            };
            variance.max(0.0).sqrt()
        })
    }

    /// Half the width of the interval around each coefficient that holds the true one with this probability:
    /// [`deviations`](Self::deviations) times the quantile of Student's distribution with
    /// [`freedom`](Self::freedom) (`docs/theory/calibration.md#intervals`). NaN for a probability that is not
    /// between 0 and 1.
    #[must_use]
    pub fn half_widths(&self, probability: f64) -> DMatrix<f64> {
        self.deviations() * student_factor(probability, self.freedom)
    }
}

/// How many standard deviations, estimated with these degrees of freedom, to either side hold the truth with this
/// probability: the quantile of Student's distribution (`docs/theory/calibration.md#intervals`), 1.96 for 95 % and many
/// degrees of freedom. Infinite without a degree of freedom, NaN for a probability that is not between 0 and 1.
#[must_use]
pub fn student_factor(probability: f64, freedom: f64) -> f64 {
    if !(probability > 0.0 && probability < 1.0) {
        return f64::NAN;
    }
    if !(freedom > 0.0) {
        return f64::INFINITY;
    }
    // Beyond this Student's distribution is the normal one to all digits.
    StudentsT::new(0.0, 1.0, freedom.min(1e9))
        .map_or(f64::NAN, |student| student.inverse_cdf(0.5 + 0.5 * probability))
}

/// Why a fit has no answer.
///
/// ```
/// use fingertip_calibration::fit::{FitError, least_squares};
/// use fingertip_calibration::nalgebra::DMatrix;
///
/// // A straight line through two points leaves nothing that would tell its error.
/// let design = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 1.0, 3.0]);
/// let error = least_squares(&design, &DMatrix::from_element(2, 1, 0.2), None).unwrap_err();
/// assert!(matches!(error, FitError::TooFewSamples { samples: 2, .. }), "{error}");
/// // Through twice the same point there are many.
/// let design = DMatrix::from_row_slice(3, 2, &[1.0, 3.0, 1.0, 3.0, 1.0, 3.0]);
/// let error = least_squares(&design, &DMatrix::from_element(3, 1, 0.2), None).unwrap_err();
/// assert!(matches!(error, FitError::Unobserved(_)), "{error}");
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FitError {
    /// The regressors do not determine the coefficients.
    #[error(transparent)]
    Unobserved(#[from] Unobserved),
    /// Not more samples than coefficients, so that nothing can be said of the error.
    #[error("{samples} samples do not determine {coefficients} coefficients and their error")]
    TooFewSamples {
        /// How many samples there are.
        samples: usize,
        /// Coefficients per response.
        coefficients: usize,
    },
    /// A number is NaN or infinite, or a size does not fit.
    #[error("{what} is not finite or has the wrong size")]
    BadInput {
        /// Which argument.
        what: &'static str,
    },
    /// The iteration did not come to rest.
    #[error("no convergence after {iterations} iterations (last relative change {change:e})")]
    NoConvergence {
        /// How many were made.
        iterations: usize,
        /// The last relative change.
        change: f64,
    },
    /// Too few samples agree with each other.
    #[error(
        "only {agreeing} of {samples} samples agree with each other, and {needed} are needed: more of them are bad \
         than was said, or the sensor is not as the model has it"
    )]
    NoConsensus {
        /// Samples that agree with the best model.
        agreeing: usize,
        /// All samples.
        samples: usize,
        /// How many would have been enough.
        needed: usize,
    },
    /// The errors given for the loads are so large that no unique answer exists.
    #[error("the loads vary no more than their errors: total least squares has no unique answer")]
    NotIdentified,
}

/// Checks that design and responses match and are finite.
pub(super) fn check(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    weights: Option<&[f64]>,
) -> Result<(), FitError> {
    let samples = design.nrows();
    let finite = |matrix: &DMatrix<f64>| matrix.iter().all(|x| x.is_finite());
    if design.ncols() == 0 || !finite(design) {
        return Err(FitError::BadInput { what: "the design" });
    }
    if responses.nrows() != samples || responses.ncols() == 0 || !finite(responses) {
        return Err(FitError::BadInput { what: "the matrix of responses" });
    }
    if weights.is_some_and(|w| w.len() != samples || w.iter().any(|x| !(*x >= 0.0 && x.is_finite()))) {
        return Err(FitError::BadInput { what: "the list of weights" });
    }
    Ok(())
}

/// Pushes every row; weights as in [`least_squares`].
pub(super) fn accumulate(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    weight: impl Fn(usize) -> f64,
) -> Triangular {
    let mut triangular = Triangular::new(design.ncols(), responses.ncols());
    let mut x = vec![0.0; design.ncols()];
    let mut y = vec![0.0; responses.ncols()];
    for i in 0..design.nrows() {
        x.iter_mut().zip(design.row(i).iter()).for_each(|(slot, value)| *slot = *value);
        y.iter_mut().zip(responses.row(i).iter()).for_each(|(slot, value)| *slot = *value);
        triangular.push_weighted(&x, &y, weight(i));
    }
    triangular
}

/// Least squares, weighted if weights are given (variance of sample i = residual covariance /
/// weight i), by QR of the weighted rows (`docs/theory/calibration.md#least-squares`).
///
/// `design` is samples × regressors, `responses` samples × responses. Whitening the responses
/// among each other would change nothing, since all have the same regressors (Zellner 1962).
///
/// # Errors
/// [`FitError::Unobserved`] for dependent regressors, [`FitError::TooFewSamples`],
/// [`FitError::BadInput`].
pub fn least_squares(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    weights: Option<&[f64]>,
) -> Result<Fit, FitError> {
    check(design, responses, weights)?;
    let mut triangular = accumulate(design, responses, |i| weights.map_or(1.0, |w| w[i]));
    let factors = triangular.factors();
    let coefficients = factors.coefficients()?;
    let residual_covariance = factors.residual_covariance().ok_or(FitError::TooFewSamples {
        samples: usize::try_from(factors.samples).unwrap_or(usize::MAX),
        coefficients: design.ncols(),
    })?;
    Ok(Fit {
        coefficients,
        inverse_gram: factors.inverse_gram()?,
        residual_covariance,
        full_covariance: None,
        freedom: factors.samples as f64 - design.ncols() as f64,
        trust: DMatrix::from_element(design.nrows(), responses.ncols(), 1.0),
        iterations: 1,
    })
}

#[cfg(test)]
mod tests {
    use super::{FitError, least_squares};
    use crate::fit::testing::{gaussian_matrix, sensor};
    use crate::testing::Largest as _;
    use nalgebra::DMatrix;
    use proptest::prelude::*;
    use rand::SeedableRng as _;

    proptest! {
        #[test]
        fn exact_without_noise(seed in any::<u64>()) {
            let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
            let truth = sensor(&mut random, 7, 8);
            let design = gaussian_matrix(&mut random, 20, 7);
            let weights: Vec<f64> = (0..20).map(|i| 0.1 + f64::from(i)).collect();
            let fit = least_squares(&design, &(&design * &truth), Some(&weights)).unwrap();
            prop_assert!((fit.coefficients - truth).largest() < 1e-12);
        }
    }

    #[test]
    fn bad_input_is_refused() {
        let ones = DMatrix::from_element(3, 2, 1.0);
        assert!(matches!(least_squares(&ones, &ones, None), Err(FitError::Unobserved(_))));
        assert!(matches!(least_squares(&ones, &DMatrix::zeros(4, 1), None), Err(FitError::BadInput { .. })));
        let nan = DMatrix::from_element(3, 2, f64::NAN);
        assert!(matches!(least_squares(&nan, &ones, None), Err(FitError::BadInput { .. })));
        let square = DMatrix::identity(2, 2);
        assert!(matches!(least_squares(&square, &square, None), Err(FitError::TooFewSamples { .. })));
        assert!(matches!(
            least_squares(&ones, &ones, Some(&[1.0, -1.0, 1.0])),
            Err(FitError::BadInput { what: "the list of weights" })
        ));
    }
}
