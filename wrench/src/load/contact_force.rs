//! What friction needs to know of a contact.

use nalgebra::Vector3;

use crate::{Real, TangentialForce};

/// The force of one contact, split at its tangent plane: the bridge from contact to friction.
///
/// It has no point and no surface, so that friction models can be used without them.
///
/// ```
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// // An object presses with 2 N on a surface whose normal is z, and drags with 0.3 N along x.
/// let force = ContactForce::split(&Vector3::new(0.3, 0.0, -2.0), &Vector3::z(), 0.0);
/// assert_eq!(force.normal, 2.0);
/// assert_eq!(force.tangential.vector(), Vector3::new(0.3, 0.0, 0.0));
/// assert_eq!(force.friction_ratio(), Some(0.15));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct ContactForce<T: Real> {
    /// Normal force \[N\], positive when pressing.
    pub normal: T,
    /// Tangential force on the fingertip \[N\], in the frame of the contact's wrench.
    pub tangential: TangentialForce<T>,
    /// Spin torque on the fingertip about the outward normal \[N·m\]; zero for a point contact.
    pub spin: T,
}

impl<T: Real> ContactForce<T> {
    /// From its parts: normal force \[N\], a force in the tangent plane \[N\], and spin torque \[N·m\].
    #[inline]
    #[must_use]
    pub fn new(normal: T, tangential: Vector3<T>, spin: T) -> Self {
        Self { normal, tangential: tangential.into(), spin }
    }

    /// Splits a force at the tangent plane with outward unit normal `normal`.
    #[inline]
    #[must_use]
    pub fn split(force: &Vector3<T>, normal: &Vector3<T>, spin: T) -> Self {
        let along = force.dot(normal);
        Self::new(-along, force - normal * along, spin)
    }

    /// No force.
    #[inline]
    #[must_use]
    pub fn zero() -> Self {
        Self { normal: T::zero(), tangential: TangentialForce::zero(), spin: T::zero() }
    }

    /// Magnitude of the tangential force \[N\].
    #[inline]
    #[must_use]
    pub const fn tangential_magnitude(&self) -> T {
        self.tangential.magnitude()
    }

    /// The friction ratio `|f_t|/f_n` (the paper's R_nt); `None` unless the contact presses and
    /// the ratio is a finite number.
    #[inline]
    #[must_use]
    pub fn friction_ratio(&self) -> Option<T> {
        if self.normal > T::zero() {
            let ratio = self.tangential_magnitude() / self.normal;
            ratio.is_number().then_some(ratio)
        } else {
            None
        }
    }

    /// `true` if no component is NaN or infinite.
    #[inline]
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.normal.is_number() && self.spin.is_number() && self.tangential.iter().all(|x| x.is_number())
    }
}
