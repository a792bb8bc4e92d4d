//! What friction needs to know of a contact.

use nalgebra::Vector3;

use crate::Real;
use crate::largest::largest;

/// The force of one contact, split at its tangent plane: the bridge from contact to friction.
///
/// It has no point and no surface, so that friction models can be used without them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct ContactForce<T: Real> {
    /// Normal force \[N\], positive when pressing.
    pub normal: T,
    /// Tangential force on the fingertip \[N\], a vector in the tangent plane, in the frame of the
    /// contact's wrench.
    pub tangential: Vector3<T>,
    /// Spin torque on the fingertip about the outward normal \[N·m\]; zero for a point contact.
    pub spin: T,
}

impl<T: Real> ContactForce<T> {
    /// Splits a force at the tangent plane with outward unit normal `normal`.
    #[inline]
    #[must_use]
    pub fn split(force: &Vector3<T>, normal: &Vector3<T>, spin: T) -> Self {
        let along = force.dot(normal);
        Self { normal: -along, tangential: force - normal * along, spin }
    }

    /// No force.
    #[inline]
    #[must_use]
    pub fn zero() -> Self {
        Self { normal: T::zero(), tangential: Vector3::zeros(), spin: T::zero() }
    }

    /// Magnitude of the tangential force \[N\], without over- or underflow.
    #[inline]
    #[must_use]
    pub fn tangential_magnitude(&self) -> T {
        let squared = self.tangential.norm_squared();
        // Before the branch, so that those who ask twice, as friction and a detector do, share it.
        let root = squared.root();
        // Above ν/ε², ν being the least normal number, no square that counts has underflowed.
        if (squared >= T::LEAST_NORMAL / (T::EPSILON * T::EPSILON)) & (squared <= T::GREATEST) {
            root
        } else {
            // By value: a force whose address is taken has to be written to memory.
            let [x, y, z] = self.tangential.into();
            scaled_length(x, y, z)
        }
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

/// The Euclidean length of a vector that may be very short, very long, zero, or no vector of numbers:
/// without over- or underflow between, which the root of the sum of squares has.
///
/// Kept out of line, for the few vectors that need it.
#[cold]
#[inline(never)]
pub fn scaled_length<T: Real>(x: T, y: T, z: T) -> T {
    let v = Vector3::new(x, y, z);
    let scale = largest(&v).normalising_factor();
    (v * scale).norm_squared().root() / scale
}
