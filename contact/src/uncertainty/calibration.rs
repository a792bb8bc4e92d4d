//! What a calibration leaves uncertain of a wrench.

use fingertip_surfaces::BadShape;
use fingertip_wrench::{Real, Wrench, stored};
use nalgebra::Matrix6;

use crate::uncertainty::is_covariance;

const SHAPE: &str = "uncertainty of a calibration";
const COVARIANCE: &str = "finite, symmetric and without a negative variance";

/// The covariance that the fit of a sensor matrix leaves in the wrenches that are solved by it, in six numbers by six of
/// any number of gauges.
///
/// All entries of a matrix `C` that was fitted by least squares have the covariance `Cov(C_ij, C_kl) = (Σ_V)_ik (G⁻¹)_jl`,
/// with the covariance `Σ_V` of the gauges' residuals and `G = Σ w wᵀ` over the loads `w` of the fit. An error `dC` acts as
/// an error `−C⁺ dC w` of the wrench, so that
///
/// ```text
/// Σ_w = (wᵀ G⁻¹ w) · C⁺ Σ_V C⁺ᵀ
/// ```
///
/// (`docs/theory/calibration.md#least-squares`). It is an error of the calibration: the same in every sample, and not
/// averaged out.
///
/// ```
/// use fingertip_contact::CalibrationUncertainty;
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix6, Vector6};
///
/// // A reading scatters by 0.1 N and 0.1 N·m; the fit had 100 loads of 1 N or 1 N·m on each axis.
/// let uncertainty =
///     CalibrationUncertainty::new(Matrix6::identity() * 0.01, Matrix6::identity() / 100.0)?;
/// let wrench = Wrench::from_components(&Vector6::new(0.0, 0.0, -2.0, 0.0, 0.0, 0.0));
/// // 0.1 N times 2/√100.
/// let covariance: Matrix6<f64> = uncertainty.covariance(&wrench);
/// assert!((covariance[(2, 2)].sqrt() - 0.02).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibrationUncertainty<T: Real> {
    readings: Matrix6<T>,
    loads: Matrix6<T>,
}

impl<T: Real> CalibrationUncertainty<T> {
    /// From the covariance `C⁺ Σ_V C⁺ᵀ` of the wrench of one reading \[N², N²·m, N²·m²\], and the inverse `G⁻¹` of the sum
    /// of `w wᵀ` over the loads of the fit \[1/N², 1/(N²·m), 1/(N²·m²)\].
    ///
    /// # Errors
    /// [`BadShape`] unless both are finite, symmetric and have no negative variance in any direction, but for rounding.
    pub fn new(readings: Matrix6<T>, loads: Matrix6<T>) -> Result<Self, BadShape> {
        BadShape::check(SHAPE, "covariance of a reading", COVARIANCE, is_covariance(&readings))?;
        BadShape::check(SHAPE, "spread of the loads", COVARIANCE, is_covariance(&loads))?;
        Ok(Self { readings, loads })
    }

    /// The covariance `C⁺ Σ_V C⁺ᵀ` of the wrench of one reading.
    #[must_use]
    pub const fn readings(&self) -> &Matrix6<T> {
        &self.readings
    }

    /// The inverse `G⁻¹` of the sum of `w wᵀ` over the loads of the fit.
    #[must_use]
    pub const fn loads(&self) -> &Matrix6<T> {
        &self.loads
    }

    /// Covariance of a wrench that was solved by this calibration, beside that of its noise: grows with the square of the
    /// load, and is zero without one. That of a wrench which is not finite is not finite.
    #[must_use]
    pub fn covariance(&self, wrench: &Wrench<T>) -> Matrix6<T> {
        let w = wrench.components();
        let share = w.dot(&(self.loads * w));
        // Rounding may leave less than nothing; a NaN stays.
        self.readings * if share < T::zero() { T::zero() } else { share }
    }
}

stored! {
    CalibrationUncertainty<T>, [T: Real],
    |uncertainty| {
        readings: Matrix6<T> = uncertainty.readings,
        loads: Matrix6<T> = uncertainty.loads,
    },
    CalibrationUncertainty::new(readings, loads)
}
