//! The filter in the tangent plane: position and velocity, driven by white acceleration.

use fingertip_surfaces::numeric::vectors::larger;
use fingertip_wrench::Real;
use nalgebra::{Matrix2, Vector2};

use super::symmetric::Symmetric;

/// What is known of a contact's position and velocity in its tangent plane, in units in which the acceleration
/// has the density 1 (`docs/theory/contact.md#tracking`). The position is the origin: it is moved on the
/// surface, not here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlaneState<T: Real> {
    pub(super) velocity: Vector2<T>,
    /// Covariance of position with position, of position (rows) with velocity, of velocity.
    pub(super) positions: Symmetric<T>,
    pub(super) mixed: Matrix2<T>,
    pub(super) velocities: Symmetric<T>,
}

/// How a measurement would change what is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weighed<T: Real> {
    /// Inverse of the covariance of the innovation, and its product with the innovation.
    inverse: Symmetric<T>,
    weighted: Vector2<T>,
    pub(super) noise: Symmetric<T>,
    /// Normalised innovation squared: χ² of two degrees of freedom.
    pub(super) surprise: T,
}

impl<T: Real> PlaneState<T> {
    /// A first measurement: nothing is known of the velocity but that its deviation is 1.
    pub(super) fn first(noise: Symmetric<T>) -> Self {
        Self {
            velocity: Vector2::zeros(),
            positions: noise,
            mixed: Matrix2::zeros(),
            velocities: Symmetric { xx: T::one(), xy: T::zero(), yy: T::one() },
        }
    }

    /// What is known when a time has passed, zero or more, and how far the contact moved. `Q = [t³/3, t²/2; t²/2, t]` of each axis
    /// (Bar-Shalom, Li & Kirubarajan 2001, section 6.2.2).
    #[inline(always)]
    pub(super) fn wait(&self, time: T) -> (Self, Vector2<T>) {
        let square = time * time;
        let (half, third) = (square * T::literal(0.5), square * time * T::literal(1.0 / 3.0));
        let (p, m, v) = (&self.positions, &self.mixed, &self.velocities);
        let (xx, xy, yy) = (v.xx * time, v.xy * time, v.yy * time);
        let moved = self.velocity * time;
        // The acceleration alone spreads it so far.
        let spread = |variance: T| larger(variance, third);
        let waited = Self {
            velocity: self.velocity,
            positions: Symmetric {
                xx: spread(p.xx + (m.m11 + m.m11 + xx) * time + third),
                xy: p.xy + (m.m12 + m.m21 + xy) * time,
                yy: spread(p.yy + (m.m22 + m.m22 + yy) * time + third),
            },
            mixed: Matrix2::new(m.m11 + xx + half, m.m12 + xy, m.m21 + xy, m.m22 + yy + half),
            velocities: Symmetric { xx: v.xx + time, xy: v.xy, yy: v.yy + time },
        };
        (waited, moved)
    }

    /// What a measurement says that is this far off. `None` if it and what is known are both certain. The surprise of
    /// numbers that are out of range is none.
    #[inline(always)]
    pub(super) fn weigh(&self, innovation: &Vector2<T>, noise: Symmetric<T>) -> Option<Weighed<T>> {
        let p = &self.positions;
        let (xx, xy, yy) = (p.xx + noise.xx, p.xy + noise.xy, p.yy + noise.yy);
        let product = xx * yy;
        // Of less than full rank but for rounding.
        let least = product * (T::EPSILON * T::literal(4.0));
        let mut determinant = product - xy * xy;
        if !(determinant > least) {
            determinant = least_determinant(least)?;
        }
        let scale = T::one() / determinant;
        let inverse = Symmetric { xx: yy * scale, xy: -(xy * scale), yy: xx * scale };
        let weighted = inverse.times(innovation);
        let surprise = innovation.dot(&weighted);
        Some(Weighed { inverse, weighted, noise, surprise })
    }

    /// What is known with the measurement taken, how far the position is moved by it, and whether all is sound: if not,
    /// [`mend`](Self::mend) helps.
    ///
    /// With `S = P + R`, the gain is `P S⁻¹`. The new covariance `P − P S⁻¹ P = R S⁻¹ P` is formed as the product,
    /// which has no cancellation.
    #[inline(always)]
    pub(super) fn with(&self, weighed: &Weighed<T>) -> (Self, Vector2<T>, bool) {
        let Weighed { inverse, weighted, noise, .. } = weighed;
        let (p, m, v) = (self.positions, self.mixed, self.velocities);
        let moved = p.times(weighted);
        let velocity = Vector2::new(
            self.velocity.x + m.m11 * weighted.x + m.m21 * weighted.y,
            self.velocity.y + m.m12 * weighted.x + m.m22 * weighted.y,
        );
        let (i, r) = (inverse, noise);
        // `R S⁻¹`, and `S⁻¹ P_xv`.
        let left = Matrix2::new(
            r.xx * i.xx + r.xy * i.xy,
            r.xx * i.xy + r.xy * i.yy,
            r.xy * i.xx + r.yy * i.xy,
            r.xy * i.xy + r.yy * i.yy,
        );
        let [first, second] = [Vector2::new(m.m11, m.m21), Vector2::new(m.m12, m.m22)];
        let (faster, other) = (i.times(&first), i.times(&second));
        let positions = Symmetric {
            xx: left.m11 * p.xx + left.m12 * p.xy,
            xy: left.m11 * p.xy + left.m12 * p.yy,
            yy: left.m21 * p.xy + left.m22 * p.yy,
        };
        let mixed = left * m;
        let velocities = Symmetric {
            xx: v.xx - first.x * faster.x - first.y * faster.y,
            xy: v.xy - first.x * other.x - first.y * other.y,
            yy: v.yy - second.x * other.x - second.y * other.y,
        };
        let all = (velocity.x + velocity.y)
            + (positions.xx + positions.yy)
            + ((mixed.m11 + mixed.m12) + (mixed.m21 + mixed.m22));
        // No variance of the velocity has grown, and what is mixed of one kind is no more than its variances allow.
        let sound = positions.is_definite() & velocities.is_definite() & all.is_number();
        (Self { velocity, positions, mixed, velocities }, moved, sound)
    }

    /// With variances that are no less than what rounding leaves of these. `None` if a number is none.
    #[cold]
    #[inline(never)]
    pub(super) fn mend(&mut self, positions: [T; 2], velocities: [T; 2]) -> Option<()> {
        if !(self.positions.is_covariance() && self.velocities.is_covariance()) {
            self.positions = self.positions.at_least(positions.map(|bound| bound * T::EPSILON));
            self.velocities = self.velocities.at_least(velocities.map(|bound| bound * T::EPSILON));
        }
        self.is_number().then_some(())
    }

    /// Whether all of it is a number.
    pub(super) fn is_number(&self) -> bool {
        (self.velocity.sum() + self.positions.sum() + self.mixed.sum() + self.velocities.sum()).is_number()
    }
}

/// What a determinant that is less counts as.
#[cold]
#[inline(never)]
fn least_determinant<T: Real>(least: T) -> Option<T> {
    (least > T::zero()).then_some(least)
}
