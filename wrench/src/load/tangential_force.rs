//! The tangential part of a contact force.

use core::ops::Deref;

use nalgebra::Vector3;

use crate::Real;
use crate::scalar::largest::largest;

/// A tangential force \[N\]: a vector in the tangent plane, and its magnitude, found once.
///
/// Friction models and slip detectors all ask for the magnitude, and the way to a contact may know it
/// sooner and better than the vector does.
///
/// ```
/// use fingertip_wrench::TangentialForce;
/// use nalgebra::Vector3;
///
/// let force = TangentialForce::new(Vector3::new(0.3, 0.4, 0.0));
/// assert_eq!(force.magnitude(), 0.5);
/// assert_eq!(force.scaled(-2.0).vector(), Vector3::new(-0.6, -0.8, 0.0));
/// assert_eq!(force.scaled(-2.0).magnitude(), 1.0);
/// ```
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
        // Above ν/ε, ν being the least normal number, a square that has underflowed to nothing would not have
        // counted.
        let magnitude = if (squared >= T::LEAST_NORMAL / T::EPSILON) & (squared <= T::GREATEST) {
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

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::TangentialForce;
    use crate::Real;

    #[test]
    fn extremes_have_a_length() {
        let nan = f64::NAN;
        for (vector, length) in [
            (Vector3::zeros(), 0.0),
            (Vector3::new(0.0, -5e-324, 0.0), 5e-324),
            (Vector3::new(3e-320, 4e-320, 0.0), 5e-320),
            (Vector3::new(3e307, 0.0, -4e307), 5e307),
            (Vector3::new(0.0, 0.0, f64::MAX), f64::MAX),
        ] {
            let force = TangentialForce::new(vector);
            assert!((force.magnitude() - length).abs() <= 1e-15 * length, "{force:?}");
            assert_eq!(force.vector(), vector);
        }
        assert!(TangentialForce::new(Vector3::new(0.0, nan, 0.0)).magnitude().is_nan());
        assert!(!TangentialForce::new(Vector3::new(f64::NEG_INFINITY, 0.0, 0.0)).magnitude().is_finite());
    }

    fn is_the_length<T: Real>(vector: [f64; 3], power: i32, factor: f64) {
        let scale = T::literal(2.0).powi(power);
        let vector = Vector3::from(vector).map(|x| T::literal(x) * scale);
        let force = TangentialForce::from(vector);
        let [x, y, z] = vector.map(|x| (x / scale).to_f64()).into();
        let length = x.hypot(y).hypot(z);
        // What is subnormal is known to the last place there.
        let place = (T::LEAST_NORMAL * T::EPSILON / scale).to_f64();
        let close = |found: T, wanted: f64| {
            let found = (found / scale).to_f64();
            assert!(
                (found - wanted).abs() <= 4.0 * T::EPSILON.to_f64() * wanted + 4.0 * place,
                "{force:?}: {found} {wanted}"
            );
        };
        close(force.magnitude(), length);
        let factor = T::literal(factor);
        let scaled = force.scaled(factor);
        close(scaled.magnitude(), length * factor.to_f64().abs());
        assert_eq!(scaled.vector(), vector * factor);
    }

    proptest! {
        #[test]
        fn magnitudes_are_lengths(vector: [i16; 3], power in -110..105_i32, factor in -4.0..4.0_f64) {
            // From where squares underflow to where they overflow.
            is_the_length::<f32>(vector.map(f64::from), power, factor);
            is_the_length::<f64>(vector.map(f64::from), power * 9, factor);
        }
    }
}
