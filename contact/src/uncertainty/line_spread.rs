//! How sure the line is on which a point contact lies.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::WrenchSpread;
use crate::Contact;

/// What is across the force of a point contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Across<T: Real> {
    /// The force in units of the pressing force, `l = f/(f·n)`.
    leaning: Vector3<T>,
    /// `1/|l|²`.
    part: T,
    /// `1/(f·n)`.
    pub(super) inverse: T,
    pub(super) pitch: T,
}

impl<T: Real> Across<T> {
    #[inline(always)]
    pub(super) fn new(force: &Vector3<T>, normal: &Vector3<T>, torque: &Vector3<T>) -> Self {
        let inverse = T::one() / force.dot(normal);
        // No square leaves the range.
        let leaning = force * inverse;
        let part = T::one() / leaning.norm_squared();
        Self { leaning, part, inverse, pitch: leaning.dot(torque) * (inverse * part) }
    }

    /// A vector less its part along the force: `dp = f·(dm − c × df − p df)/|f|²` takes that.
    #[inline(always)]
    pub(super) fn of(&self, e: &Vector3<T>) -> Vector3<T> {
        e - self.leaning * (self.leaning.dot(e) * self.part)
    }
}

/// How noise spreads the place where the line of a point contact meets the tangent plane, in whatever tangents of it.
///
/// With `b = dm − c × df − p df` and what is across the force of the two tangents `a₁` and `a₂` it is
/// `(−a₂·b, a₁·b)/(f·n)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LineSpread<T: Real> {
    across: Across<T>,
    /// The covariance `xx, xy, xz, yy, yz, zz` of `b`.
    torque: [T; 6],
    /// `1/(f·n)²`.
    stretch: T,
}

impl<T: Real> LineSpread<T> {
    /// Of a contact that [`PointContact`](crate::PointContact) found in a wrench. Where the force grazes, it is no number.
    #[inline(always)]
    pub(crate) fn new(contact: &Contact<T>, wrench: &Wrench<T>, spread: &WrenchSpread<'_, T>) -> Self {
        let across = Across::new(&contact.force, &contact.normal, &wrench.torque());
        let torque = spread.torque_beside(&contact.point, across.pitch);
        Self { across, torque, stretch: across.inverse * across.inverse }
    }

    /// No less than the sum of the two variances along whatever tangents, as what is across the force of a unit vector is
    /// not longer. A number if all is.
    #[cfg(feature = "track")]
    #[inline(always)]
    pub(crate) fn most(&self) -> T {
        let [xx, _, _, yy, _, zz] = self.torque;
        let most = (xx + yy + zz) * self.stretch;
        most + most
    }

    /// The covariances along two tangents, times a scale: first with first, first with second, second with second \[m²\].
    #[inline(always)]
    pub(crate) fn along(&self, [e1, e2]: &[Vector3<T>; 2], scale: T) -> [T; 3] {
        let [c11, c12, c22] = congruence(&self.torque, &[self.across.of(e1), self.across.of(e2)]);
        let stretch = self.stretch * scale;
        [c22 * stretch, -(c12 * stretch), c11 * stretch]
    }
}

/// `aᵀMa`, `aᵀMb`, `bᵀMb` of a symmetric matrix `xx, xy, xz, yy, yz, zz`.
#[inline(always)]
pub(super) fn congruence<T: Real>(&[xx, xy, xz, yy, yz, zz]: &[T; 6], [a, b]: &[Vector3<T>; 2]) -> [T; 3] {
    let with = |e: &Vector3<T>| {
        Vector3::new(
            xx * e.x + xy * e.y + xz * e.z,
            xy * e.x + yy * e.y + yz * e.z,
            xz * e.x + yz * e.y + zz * e.z,
        )
    };
    let (with_a, with_b) = (with(a), with(b));
    [a.dot(&with_a), a.dot(&with_b), b.dot(&with_b)]
}
