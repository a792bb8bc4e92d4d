//! A point of the interior.

use fingertip_wrench::Real;
use nalgebra::Vector4;

use crate::grip::cone::tail;

/// A point of the interior: forces and their dual, the slack of each half-space and its price.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interior<T: Real, const ROWS: usize> {
    pub(crate) y: Vector4<T>,
    pub(crate) z: Vector4<T>,
    pub(crate) rows: [Pair<T>; ROWS],
}

/// A slack and its price.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair<T> {
    pub(crate) slack: T,
    pub(crate) price: T,
}

/// `(first, 0, 0, 0)`.
#[inline]
pub(crate) fn unit<T: Real>(first: T) -> Vector4<T> {
    Vector4::new(first, T::zero(), T::zero(), T::zero())
}

impl<T: Real, const ROWS: usize> Interior<T, ROWS> {
    /// The middle of everything.
    pub(crate) fn middle() -> Self {
        let one = Pair { slack: T::one(), price: T::one() };
        Self { y: unit(T::one()), z: unit(T::one()), rows: [one; ROWS] }
    }

    /// Whether all is finite and inside, as rounding may have it otherwise.
    #[inline]
    pub(crate) fn is_inside(&self) -> bool {
        let cone = |v: &Vector4<T>| v.x > tail(v) && v.x.is_number();
        let positive = |x: T| x > T::zero() && x.is_number();
        cone(&self.y)
            && cone(&self.z)
            && self.rows.iter().all(|row| positive(row.slack) && positive(row.price))
    }

    /// This share of it and the rest of another.
    #[inline]
    pub(crate) fn mix(&mut self, other: &Self, share: T, rest: T) {
        self.y = self.y * share + other.y * rest;
        self.z = self.z * share + other.z * rest;
        for (row, other) in self.rows.iter_mut().zip(&other.rows) {
            row.slack = row.slack * share + other.slack * rest;
            row.price = row.price * share + other.price * rest;
        }
    }

    /// Multiplies all by a factor.
    #[inline]
    pub(crate) fn scale(&mut self, factor: T) {
        self.y *= factor;
        self.z *= factor;
        for row in &mut self.rows {
            row.slack *= factor;
            row.price *= factor;
        }
    }
}
