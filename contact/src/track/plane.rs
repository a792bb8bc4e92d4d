//! The filter in the tangent plane: position and velocity, driven by white acceleration.

use fingertip_surfaces::numeric::vectors::{larger, smaller};
use fingertip_wrench::Real;
use nalgebra::{Matrix2, Vector2};

/// What is known of a contact's position and velocity in its tangent plane, in units in which the acceleration
/// has the density 1 (`docs/theory/contact.md#tracking`). The position is the origin: it is moved on the
/// surface, not here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlaneState<T: Real> {
    pub(super) velocity: Vector2<T>,
    /// Covariance of position with position, of position (rows) with velocity, of velocity.
    pub(super) positions: Matrix2<T>,
    pub(super) mixed: Matrix2<T>,
    pub(super) velocities: Matrix2<T>,
}

/// How a measurement would change what is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weighed<T: Real> {
    /// Inverse of the covariance of the innovation.
    inverse: Matrix2<T>,
    noise: Matrix2<T>,
    innovation: Vector2<T>,
    /// Normalised innovation squared: χ² of two degrees of freedom.
    pub(super) surprise: T,
}

impl<T: Real> PlaneState<T> {
    /// A first measurement: nothing is known of the velocity but that its deviation is 1.
    #[inline]
    pub(super) fn first(noise: &Matrix2<T>) -> Self {
        Self {
            velocity: Vector2::zeros(),
            positions: *noise,
            mixed: Matrix2::zeros(),
            velocities: Matrix2::identity(),
        }
    }

    /// Lets a time pass, zero or more: how far the contact moved. `Q = [t³/3, t²/2; t²/2, t]` of each axis
    /// (Bar-Shalom, Li & Kirubarajan 2001, section 6.2.2).
    #[inline(always)]
    pub(super) fn wait(&mut self, time: T) -> Vector2<T> {
        let half = time * time * T::literal(0.5);
        let third = time * time * time * T::literal(1.0 / 3.0);
        let with_velocity = self.mixed + self.velocities * (time * T::literal(0.5));
        let mut positions = self.positions + (with_velocity + with_velocity.transpose()) * time;
        positions.m11 += third;
        positions.m22 += third;
        // The acceleration alone spreads it so far.
        self.positions = covariance(&positions, [third, third]);
        self.mixed += self.velocities * time;
        self.mixed.m11 += half;
        self.mixed.m22 += half;
        self.velocities.m11 += time;
        self.velocities.m22 += time;
        self.velocity * time
    }

    /// What a measurement says that is this far off. `None` if it and what is known are both certain, or its
    /// numbers are out of range.
    #[inline(always)]
    pub(super) fn weigh(&self, innovation: Vector2<T>, noise: Matrix2<T>) -> Option<Weighed<T>> {
        let s = self.positions + noise;
        let product = s.m11 * s.m22;
        // Of less than full rank but for rounding.
        let least = product * (T::EPSILON * T::literal(4.0));
        let determinant = (product - s.m12 * s.m21).max(least);
        let scale = T::one() / determinant;
        let inverse = Matrix2::new(s.m22, -s.m12, -s.m21, s.m11) * scale;
        let surprise = innovation.dot(&(inverse * innovation));
        (determinant > T::zero() && (scale + surprise + noise.sum()).is_number()).then_some(Weighed {
            inverse,
            noise,
            innovation,
            surprise,
        })
    }

    /// Takes the measurement: how far the position is moved by it.
    ///
    /// With `S = P + R`, the gain is `P S⁻¹`. The new covariance `P − P S⁻¹ P = R S⁻¹ P` is formed as the product,
    /// which has no cancellation.
    #[inline(always)]
    pub(super) fn take(&mut self, weighed: &Weighed<T>) -> Vector2<T> {
        let Weighed { inverse, noise, innovation, .. } = weighed;
        let weighted = inverse * innovation;
        let moved = self.positions * weighted;
        self.velocity += self.mixed.transpose() * weighted;
        let kept = noise * inverse;
        let sharper = kept * self.positions;
        let velocities = self.velocities - self.mixed.transpose() * (inverse * self.mixed);
        self.mixed = kept * self.mixed;
        // No more is left than either of the two says.
        let before = &self.positions;
        let bounds = [smaller(before.m11, noise.m11), smaller(before.m22, noise.m22)];
        self.positions = covariance(&sharper, bounds.map(|bound| bound * T::EPSILON));
        let bounds = [self.velocities.m11, self.velocities.m22];
        self.velocities = covariance(&velocities, bounds.map(|bound| bound * T::EPSILON));
        moved
    }

    /// Whether all of it is a number.
    #[inline]
    pub(super) fn is_number(&self) -> bool {
        (self.velocity.sum() + self.positions.sum() + self.mixed.sum() + self.velocities.sum()).is_number()
    }
}

/// Symmetric, and no direction has a negative variance: where noise in one direction is beyond compare with that in
/// the other, rounding may leave neither. `least` is what each of the variances is at least.
#[inline(always)]
fn covariance<T: Real>(m: &Matrix2<T>, least: [T; 2]) -> Matrix2<T> {
    let [m11, m22] = [larger(m.m11, least[0]), larger(m.m22, least[1])];
    let off = (m.m12 + m.m21) * T::literal(0.5);
    if off * off <= m11 * m22 {
        return Matrix2::new(m11, off, off, m22);
    }
    let most = m11.root() * m22.root();
    let off = larger(-most, smaller(off, most));
    Matrix2::new(m11, off, off, m22)
}
