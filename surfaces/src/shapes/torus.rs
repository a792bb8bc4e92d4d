//! The torus.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::Vector3;

use crate::numeric::closest::from_distance;
use crate::numeric::roots::{bracketed_from, first_of_convex};
use crate::numeric::vectors::{foot, hypotenuse, is_finite, unit_or};
use crate::{ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, SignedDistance};

/// A ring around the z axis; [`Posed`](crate::Posed) puts it elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus<T: Real> {
    ring_radius: T,
    tube_radius: T,
}

impl<T: Real> Torus<T> {
    /// From the radius of the circle in the middle of the tube and the radius of the tube \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless both are positive finite lengths and the tube is the thinner one.
    pub fn new(ring_radius: T, tube_radius: T) -> Result<Self, BadShape> {
        BadShape::check_length("torus", "ring radius", ring_radius)?;
        BadShape::check_length("torus", "tube radius", tube_radius)?;
        BadShape::check("torus", "tube radius", "less than the ring radius", tube_radius < ring_radius)?;
        Ok(Self { ring_radius, tube_radius })
    }

    /// Radius of the circle in the middle of the tube \[m\].
    #[inline]
    #[must_use]
    pub const fn ring_radius(&self) -> T {
        self.ring_radius
    }

    /// Radius of the tube \[m\].
    #[inline]
    #[must_use]
    pub const fn tube_radius(&self) -> T {
        self.tube_radius
    }

    /// The line in units of the ring's radius, and the position of its foot point \[m\].
    #[inline]
    fn seen(&self, line: &Line<T>) -> (RingLine<T>, T) {
        let (from_centre, along) = foot(line, &Vector3::zeros());
        (RingLine::new(from_centre / self.ring_radius, line.direction), along)
    }
}

/// A line seen from a ring of radius 1 about the z axis, positions counting from the foot point.
///
/// Half the slope of the squared distance from the ring is `g(t) = t − ρ′(t)`, where `ρ = |x, y|`. It is
/// concave before the place where the line passes the axis and convex after it, negative at −1 and
/// positive at 1. So the distance has a least value on either side of that place at most, which Newton's
/// method finds coming from ±1 and cannot overstep, and on one of the sides at least.
#[derive(Clone, Copy)]
struct RingLine<T: Real> {
    start: Vector3<T>,
    direction: Vector3<T>,
    /// `(ρ·ρ′)(0)`; negative if the line still approaches the axis.
    leaving: T,
    /// `ρ³·ρ″`, the same all along the line.
    turning: T,
}

impl<T: Real> RingLine<T> {
    fn new(start: Vector3<T>, direction: Vector3<T>) -> Self {
        let swept = start.x * direction.y - start.y * direction.x;
        let leaving = start.x * direction.x + start.y * direction.y;
        Self { start, direction, leaving, turning: swept * swept }
    }

    fn reversed(&self) -> Self {
        Self { direction: -self.direction, leaving: -self.leaving, ..*self }
    }

    #[inline]
    fn at(&self, t: T) -> Vector3<T> {
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
    fn excess(&self, t: T, squared: T) -> (T, T) {
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
    fn nearest(&self) -> (T, Option<T>) {
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
    fn crossings(&self, tube: T, mut visit: impl FnMut(T)) {
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
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
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

impl<T: Real> ActiveSurface<T> for Torus<T> {
    /// Up to four crossings, each bracketed between extrema of the distance from the ring (theory 10.3).
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let (seen, along) = self.seen(line);
        seen.crossings(self.tube_radius / self.ring_radius, |t| {
            let point = seen.at(t);
            visit(Crossing {
                along: along + t * self.ring_radius,
                point: point * self.ring_radius,
                normal: seen.normal(&point),
                active: true,
            });
        });
    }

    /// The nearer of the two places at most where the distance from the ring is least.
    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T> {
        let (seen, _) = self.seen(line);
        // From farther away the ring is a point but for rounding.
        let near = seen.start.amax() < T::one() / T::EPSILON;
        let along = if near {
            let (first, second) = seen.nearest();
            let squared = |t: T| seen.excess(t, T::zero()).0;
            second.filter(|second| squared(*second) < squared(first)).unwrap_or(first)
        } else {
            T::zero()
        };
        let point = seen.at(along) * self.ring_radius;
        let point = if is_finite(&point) { point } else { Vector3::zeros() };
        from_distance(&point, self.signed_distance(&point))
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.signed_distance(point).normal
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        self.signed_distance(point).distance < T::zero()
    }
}

impl<T: Real> SignedDistance<T> for Torus<T> {
    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T> {
        let point = if is_finite(point) { *point } else { Vector3::repeat(T::GREATEST.root()) };
        let outward = unit_or(&Vector3::new(point.x, point.y, T::zero()), Vector3::x);
        let beyond_ring = hypotenuse(point.x, point.y) - self.ring_radius;
        let normal = unit_or(&(outward * beyond_ring + Vector3::z() * point.z), || outward);
        Distance { distance: hypotenuse(beyond_ring, point.z) - self.tube_radius, normal }
    }

    fn bounds(&self) -> (Vector3<T>, T) {
        (Vector3::zeros(), self.ring_radius + self.tube_radius)
    }
}

stored! {
    Torus<T>, [T: Real],
    |torus| {
        ring_radius_m: T = torus.ring_radius,
        tube_radius_m: T = torus.tube_radius,
    },
    Torus::new(ring_radius_m, tube_radius_m)
}

#[cfg(test)]
mod tests {
    use super::Torus;
    use crate::{ActiveSurface, SignedDistance};
    use fingertip_wrench::Line;
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// By dense samples: none is nearer than the closest approach, and one nearly as near.
    fn nothing_is_nearer(line: &Line<f64>) {
        let torus = Torus::new(1.0, 0.01).unwrap();
        let found = torus.closest_approach(line);
        let at_foot = -line.point.dot(&line.direction);
        let least = (-2000..=2000)
            .map(|k| torus.signed_distance(&line.at(at_foot + f64::from(k) * 1e-3)).distance)
            .fold(f64::INFINITY, f64::min);
        // The nearest sample is half a step aside at most.
        assert!(
            found.gap <= least.max(0.0) + 1e-12 && found.gap >= least - 5e-4,
            "{line:?} {found:?} {least}"
        );
    }

    #[test]
    fn closest_approaches_are_the_least() {
        let mut random = Pcg64Mcg::seed_from_u64(5);
        for k in 0..400 {
            let mut any = |reach: f64| Vector3::from_fn(|_, _| random.random_range(-reach..reach));
            let (mut point, mut direction) = (any(1.3), any(1.0));
            // In the plane of the ring, along the axis, through it, through the centre.
            match k % 8 {
                0 => (point.z, direction.z) = (0.1, 0.0),
                1 => (direction.x, direction.y) = (0.0, 0.0),
                2 => (point.x, point.y) = (0.0, 0.0),
                3 => point = Vector3::zeros(),
                4 => (point.x, direction.x) = (0.0, 0.0),
                _ => {}
            }
            nothing_is_nearer(&Line { point, direction: direction.normalize() });
        }
        for axis in [Vector3::x(), Vector3::z()] {
            nothing_is_nearer(&Line { point: Vector3::zeros(), direction: axis });
        }
    }
}
