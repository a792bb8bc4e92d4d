//! The tangential part of a contact force.

use core::ops::Deref;

use nalgebra::Vector3;

use crate::Real;
use crate::largest::largest;

/// A tangential force \[N\]: a vector in the tangent plane, and its magnitude, found once.
///
/// Friction models and slip detectors all ask for the magnitude, and the way to a contact may know it
/// sooner and better than the vector does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        from = "Vector3<T>",
        into = "Vector3<T>",
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
pub struct TangentialForce<T: Real> {
    vector: Vector3<T>,
    magnitude: T,
}

impl<T: Real> TangentialForce<T> {
    /// Of a vector \[N\], whose length is found without over- or underflow; NaN if a component is.
    #[inline]
    #[must_use]
    pub fn new(vector: Vector3<T>) -> Self {
        let squared = vector.norm_squared();
        let root = squared.root();
        // Above ν/ε², ν being the least normal number, no square that counts has underflowed.
        let magnitude = if (squared >= T::LEAST_NORMAL / (T::EPSILON * T::EPSILON)) & (squared <= T::GREATEST)
        {
            root
        } else {
            // By value: a force whose address is taken has to be written to memory.
            let [x, y, z] = vector.into();
            scaled_length(x, y, z)
        };
        Self { vector, magnitude }
    }

    /// Of a vector whose length is known from elsewhere \[N\]: it must be that, but for rounding.
    #[inline]
    #[must_use]
    pub const fn of_magnitude(vector: Vector3<T>, magnitude: T) -> Self {
        Self { vector, magnitude }
    }

    /// None.
    #[inline]
    #[must_use]
    pub fn zero() -> Self {
        Self { vector: Vector3::zeros(), magnitude: T::zero() }
    }

    /// So many times as large; against its direction if `factor` is negative.
    #[inline]
    #[must_use]
    pub fn scaled(&self, factor: T) -> Self {
        Self { vector: self.vector * factor, magnitude: self.magnitude * factor.abs() }
    }

    /// The vector \[N\].
    #[inline]
    #[must_use]
    pub const fn vector(&self) -> Vector3<T> {
        self.vector
    }

    /// Its length \[N\].
    #[inline]
    #[must_use]
    pub const fn magnitude(&self) -> T {
        self.magnitude
    }
}

impl<T: Real> From<Vector3<T>> for TangentialForce<T> {
    #[inline]
    fn from(vector: Vector3<T>) -> Self {
        Self::new(vector)
    }
}

impl<T: Real> From<TangentialForce<T>> for Vector3<T> {
    #[inline]
    fn from(force: TangentialForce<T>) -> Self {
        force.vector
    }
}

impl<T: Real> Deref for TangentialForce<T> {
    type Target = Vector3<T>;

    #[inline]
    fn deref(&self) -> &Vector3<T> {
        &self.vector
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
