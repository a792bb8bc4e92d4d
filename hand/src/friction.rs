//! What friction allows at a contact.

use fingertip_friction::{Coulomb, SoftFingerLimit, UncertainCoulomb};
use fingertip_wrench::Real;

use crate::BadContact;

/// The friction of a contact: its coefficient, and for a soft finger the torque arm.
///
/// ```
/// use fingertip_friction::UncertainCoulomb;
/// use fingertip_hand::ContactFriction;
///
/// // Known to be 0.6 ± 0.05: what is undercut once in a hundred grasps, for a patch of 3 mm.
/// let known = UncertainCoulomb::new(0.6, 0.05, None)?;
/// let friction = ContactFriction::uncertain(&known, 0.01)?.with_arm(1.8e-3)?;
/// assert!((friction.coefficient() - 0.484_f64).abs() < 1e-3 && friction.arm() == 1.8e-3);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactFriction<T> {
    coefficient: T,
    /// Zero for a point contact.
    arm: T,
}

impl<T: Real> ContactFriction<T> {
    /// Of a point contact, which carries no spin torque.
    ///
    /// # Errors
    /// [`BadContact::BadFriction`] unless the coefficient is positive and finite.
    pub fn point(coefficient: T) -> Result<Self, BadContact> {
        let friction = Self { coefficient, arm: T::zero() };
        friction.with_coefficient(coefficient).ok_or(BadContact::BadFriction)
    }

    /// Of a soft finger, with the torque arm `e` \[m\]: the greatest spin torque over the greatest tangential force
    /// (`3πa/16` for Hertz pressure on a patch of radius `a`).
    ///
    /// # Errors
    /// [`BadContact`] unless both are positive and finite.
    pub fn soft(coefficient: T, arm: T) -> Result<Self, BadContact> {
        Self::point(coefficient)?.with_arm(arm)
    }

    /// Of a point contact: the coefficient that is undercut with `probability` only, of one that is known with an
    /// uncertainty.
    ///
    /// # Errors
    /// [`BadContact::NoFriction`] if that coefficient is zero.
    pub fn uncertain(friction: &UncertainCoulomb<T>, probability: f64) -> Result<Self, BadContact> {
        Self::point(friction.quantile(probability)).map_err(|_| BadContact::NoFriction)
    }

    /// The same for a soft finger with this torque arm \[m\].
    ///
    /// # Errors
    /// [`BadContact::BadArm`] unless it is positive and finite.
    pub fn with_arm(self, arm: T) -> Result<Self, BadContact> {
        if arm > T::zero() && arm.is_number() { Ok(Self { arm, ..self }) } else { Err(BadContact::BadArm) }
    }

    /// The coefficient μ.
    #[inline]
    #[must_use]
    pub const fn coefficient(&self) -> T {
        self.coefficient
    }

    /// The torque arm e \[m\]; zero for a point contact.
    #[inline]
    #[must_use]
    pub const fn arm(&self) -> T {
        self.arm
    }

    /// With another coefficient; `None` unless it is positive and finite.
    pub(crate) fn with_coefficient(self, coefficient: T) -> Option<Self> {
        (coefficient > T::zero() && coefficient.is_number()).then_some(Self { coefficient, ..self })
    }
}

impl<T: Real> From<Coulomb<T>> for ContactFriction<T> {
    fn from(limit: Coulomb<T>) -> Self {
        Self { coefficient: limit.coefficient(), arm: T::zero() }
    }
}

impl<T: Real> From<SoftFingerLimit<T>> for ContactFriction<T> {
    fn from(limit: SoftFingerLimit<T>) -> Self {
        Self { coefficient: limit.coefficient(), arm: limit.arm() }
    }
}
