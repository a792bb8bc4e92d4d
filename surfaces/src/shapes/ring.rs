//! A ring, and where a line comes near to it or crosses the tube around it.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::numeric::roots::{bracketed_from, first_of_convex};
use crate::numeric::vectors::unit_or;

/// A line seen from a ring of radius 1 about the z axis, positions counting from the foot point.
///
/// Half the slope of the squared distance from the ring is `g(t) = t − ρ′(t)`, where `ρ = |x, y|`. It is
/// concave before the place where the line passes the axis and convex after it, negative at −1 and
/// positive at 1. So the distance has a least value on either side of that place at most, which Newton's
/// method finds coming from ±1 and cannot overstep, and on one of the sides at least.
#[derive(Clone, Copy)]
pub(super) struct RingLine<T: Real> {
    pub(super) start: Vector3<T>,
    direction: Vector3<T>,
    /// `(ρ·ρ′)(0)`; negative if the line still approaches the axis.
    leaving: T,
    /// `ρ³·ρ″`, the same all along the line.
    turning: T,
}

impl<T: Real> RingLine<T> {
    pub(super) fn new(start: Vector3<T>, direction: Vector3<T>) -> Self {
        let swept = start.x * direction.y - start.y * direction.x;
        let leaving = start.x * direction.x + start.y * direction.y;
        Self { start, direction, leaving, turning: swept * swept }
    }

    fn reversed(&self) -> Self {
        Self { direction: -self.direction, leaving: -self.leaving, ..*self }
    }

    #[inline]
    pub(super) fn at(&self, t: T) -> Vector3<T> {
        self.start + self.direction * t
    }

    /// `1/ρ`, or much if the point is on the axis, `ρ − 1` and `ρ′`.
    #[inline]
    fn radial(&self, point: &Vector3<T>) -> (T, T, T) {
        let rho = (point.x * point.x + point.y * point.y).root();
        let inverse = T::one() / rho.max(T::LEAST_NORMAL.root().root());
        let along = point.x * self.direction.x + point.y * self.direction.y;
        (inverse, rho - T::one(), along * inverse)
    }

    /// `g` and its slope.
    #[inline]
    fn lean(&self, t: T) -> (T, T) {
        let (inverse, _, drift) = self.radial(&self.at(t));
        (t - drift, T::one() - self.turning * inverse * inverse * inverse)
    }

    /// By how much the squared distance from the ring exceeds a square, and its slope.
    #[inline]
    pub(super) fn excess(&self, t: T, squared: T) -> (T, T) {
        let point = self.at(t);
        let (_, beyond, drift) = self.radial(&point);
        let slope = beyond * drift + point.z * self.direction.z;
        (beyond * beyond + point.z * point.z - squared, slope + slope)
    }

    /// Where the line comes nearest to the ring before it passes the axis, if it does not come ever
    /// nearer.
    #[inline(never)]
    fn nearest_before_axis(&self) -> Option<T> {
        first_of_convex(-T::one(), T::one(), |t| {
            let (inverse, _, drift) = self.radial(&self.at(t));
            if drift > T::zero() {
                // Past the axis, and no such place was overstepped.
                return (T::one(), T::zero());
            }
            (drift - t, self.turning * inverse * inverse * inverse - T::one())
        })
    }

    /// The places where the distance from the ring is least, one or two, in ascending order.
    pub(super) fn nearest(&self) -> (T, Option<T>) {
        let steepness = self.direction.x * self.direction.x + self.direction.y * self.direction.y;
        let turns = self.turning < steepness * steepness * steepness;
        let before = (turns || self.leaving <= T::zero()).then(|| self.nearest_before_axis()).flatten();
        let after = (turns || self.leaving > T::zero())
            .then(|| self.reversed().nearest_before_axis())
            .flatten()
            .map(|t| -t);
        match (before, after) {
            (Some(first), Some(second)) if first < second => (first, Some(second)),
            (Some(only), _) | (_, Some(only)) => (only, None),
            // Within rounding of the place where the line passes the axis, and of the foot point.
            (None, None) => (T::zero(), None),
        }
    }

    /// Where the distance is greatest between the two places where it is least: on the side of the
    /// axis on which `g`, which is `t` at the axis, still has to fall to zero.
    fn farthest_between(&self, first: T, second: T) -> T {
        let steepness = self.direction.x * self.direction.x + self.direction.y * self.direction.y;
        let at_axis = (-self.leaving / steepness).max(first).min(second);
        let sign = T::one().copysign(at_axis);
        let found = first_of_convex(at_axis, sign, |t| {
            let (lean, slope) = self.lean(t);
            (lean * sign, slope * sign)
        });
        found.unwrap_or(at_axis)
    }

    /// Where the line leaves the tube of this radius, going from a place inside to one outside.
    ///
    /// `g` nowhere rises faster than `t`, so that the square of the distance is below its least value by
    /// no more than the square of the way: a guess that is not outside.
    #[inline(never)]
    fn out_of_tube(&self, inside: T, outside: T, excess: T, tube: T) -> T {
        let squared = tube * tube;
        let reached = (-excess).root().min((outside - inside).abs()).copysign(outside - inside);
        // Signs do not depend on rounding beyond what the coordinates have of it.
        let noise = tube * T::EPSILON;
        bracketed_from(inside + reached, inside, outside, noise, |t| self.excess(t, squared))
    }

    /// Calls `visit` at up to four places where the line crosses the tube of this radius.
    pub(super) fn crossings(&self, tube: T, mut visit: impl FnMut(T)) {
        let outer = T::one() + tube;
        let left = outer * outer - self.start.norm_squared();
        if !(left >= T::zero()) {
            return;
        }
        let squared = tube * tube;
        let excess = |t: T| self.excess(t, squared).0;
        // Slightly farther than any crossing can be.
        let reach = left.root() + T::EPSILON * T::literal(64.0) + T::literal(0.01);
        let (first, second) = self.nearest();
        let at_first = excess(first);
        let Some((second, at_second)) = second.map(|t| (t, excess(t))) else {
            if at_first < T::zero() {
                visit(self.out_of_tube(first, -reach, at_first, tube));
                visit(self.out_of_tube(first, reach, at_first, tube));
            }
            return;
        };
        let (in_first, in_second) = (at_first < T::zero(), at_second < T::zero());
        let middle = if in_first && in_second {
            let middle = self.farthest_between(first, second);
            if excess(middle) < T::zero() {
                visit(self.out_of_tube(first, -reach, at_first, tube));
                visit(self.out_of_tube(second, reach, at_second, tube));
                return;
            }
            [middle; 2]
        } else {
            [second, first]
        };
        let [after_first, before_second] = middle;
        if in_first {
            visit(self.out_of_tube(first, -reach, at_first, tube));
            visit(self.out_of_tube(first, after_first, at_first, tube));
        }
        if in_second {
            visit(self.out_of_tube(second, before_second, at_second, tube));
            visit(self.out_of_tube(second, reach, at_second, tube));
        }
    }

    /// Outward unit normal of the tube around the ring at one of its points.
    pub(super) fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        let (inverse, beyond, _) = self.radial(point);
        let across = beyond * inverse;
        let normal = Vector3::new(point.x * across, point.y * across, point.z);
        let squared = normal.norm_squared();
        if squared > T::EPSILON * T::EPSILON {
            normal / squared.root()
        } else {
            unit_or(&normal, || unit_or(&Vector3::new(point.x, point.y, T::zero()), Vector3::x))
        }
    }
}
