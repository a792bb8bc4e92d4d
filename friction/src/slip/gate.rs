//! When the friction ratio means anything.

use fingertip_wrench::{ContactForce, Real, stored};

use crate::BadParameter;
use crate::bad_parameter::positive;

/// Standard deviations of the noise of a contact force.
///
/// ```
/// use fingertip_friction::ForceNoise;
///
/// let noise = ForceNoise::isotropic(0.01)?; // N
/// // The ratio of 2 N is known to half a percent, that of 0.1 N to a tenth.
/// assert!(noise.ratio_deviation(2.0, 0.3) < 0.006 && noise.ratio_deviation(0.1, 0.3) > 0.1_f64);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceNoise<T> {
    /// Of the normal force \[N\].
    pub normal: T,
    /// Of each component of the tangential force \[N\].
    pub tangential: T,
}

impl<T: Real> ForceNoise<T> {
    /// The same noise on every component \[N\].
    ///
    /// # Errors
    /// [`BadParameter`] unless it is positive and finite.
    pub fn isotropic(deviation: T) -> Result<Self, BadParameter> {
        Self { normal: deviation, tangential: deviation }.checked()
    }

    pub(crate) fn checked(self) -> Result<Self, BadParameter> {
        positive(self.normal, "noise of the normal force")?;
        positive(self.tangential, "noise of the tangential force")?;
        Ok(self)
    }

    /// Standard deviation of the friction ratio at normal force `normal` and ratio `ratio`:
    /// `√(σ_t² + R²σ_n²)/N` (`docs/theory/friction.md#friction-ratio`, first order).
    #[inline]
    #[must_use]
    pub fn ratio_deviation(&self, normal: T, ratio: T) -> T {
        let scaled = ratio * self.normal;
        (self.tangential * self.tangential + scaled * scaled).root() / normal
    }
}

/// Lets a sample through only when the normal force stands well above its noise.
///
/// ```
/// use fingertip_friction::{ForceNoise, NormalForceGate};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.01)?);
/// assert!((gate.least() - 0.1_f64).abs() < 1e-12);
/// assert_eq!(gate.ratio(&ContactForce::new(0.05, Vector3::x() * 0.02, 0.0)), None); // too light to be judged
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalForceGate<T> {
    least: T,
}

impl<T: Real> NormalForceGate<T> {
    /// Ten standard deviations of the normal force: below that the ratio is biased by more than
    /// 1 % and its noise is no longer Gaussian (`docs/theory/friction.md#friction-ratio`).
    #[inline]
    #[must_use]
    pub fn from_noise(noise: &ForceNoise<T>) -> Self {
        Self { least: noise.normal * T::literal(10.0) }
    }

    /// The least normal force that passes \[N\].
    #[inline]
    #[must_use]
    pub const fn least(&self) -> T {
        self.least
    }

    /// The friction ratio of a sample that passes.
    #[inline]
    #[must_use]
    pub fn ratio(&self, force: &ContactForce<T>) -> Option<T> {
        if force.normal > self.least { force.friction_ratio() } else { None }
    }
}

stored! {
    ForceNoise<T>, [T: Real],
    |noise| { normal: T = noise.normal, tangential: T = noise.tangential },
    Self { normal, tangential }.checked()
}

stored! {
    NormalForceGate<T>, [T: Real],
    |gate| { least: T = gate.least },
    positive(least, "least normal force").map(|least| Self { least })
}
