//! The torus.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::numeric::closest::by_search;
use crate::numeric::roots::bracketed;
use crate::numeric::vectors::{foot, hypotenuse, is_finite, unit_or};
use crate::serde_parts::serde_parts;
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

    /// Where the distance from the surface may change its direction along the line: the extrema of
    /// the quartic `t⁴ + c₂t² + c₁t + c₀` whose roots are the crossings (its cubic term is zero since
    /// `t` counts from the foot point), ascending; unused places repeat the last.
    fn extrema(&self, start: &Vector3<T>, direction: &Vector3<T>) -> [T; 3] {
        let two = T::one() + T::one();
        let squared = self.ring_radius * self.ring_radius;
        let alpha = start.norm_squared() + squared - self.tube_radius * self.tube_radius;
        let a = direction.x * direction.x + direction.y * direction.y;
        let b = start.x * direction.x + start.y * direction.y;
        // Half of F′(t)/2 = 2t³ + 2p·t + 2q.
        let p = alpha - two * squared * a;
        let q = -two * squared * b;
        let f = |t: T| (t * (t * t + p) + q, T::literal(3.0) * t * t + p);
        // All real roots lie within Cauchy's bound.
        let bound = T::one() + p.abs().max(q.abs());
        if p >= T::zero() {
            let only = bracketed(-bound, bound, f);
            return [only; 3];
        }
        let turn = (-p / T::literal(3.0)).root();
        let (high, low) = (f(-turn).0, f(turn).0);
        match (high > T::zero(), low < T::zero()) {
            (true, true) => {
                [bracketed(-bound, -turn, f), bracketed(-turn, turn, f), bracketed(turn, bound, f)]
            }
            (true, false) => [bracketed(-bound, -turn, f); 3],
            _ => [bracketed(turn, bound, f); 3],
        }
    }
}

impl<T: Real> ActiveSurface<T> for Torus<T> {
    /// Up to four crossings, each bracketed between extrema of the quartic (theory 10.3) and then
    /// found on the distance itself, which loses no digits.
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let scale = T::one() / self.ring_radius;
        let unit = Self { ring_radius: T::one(), tube_radius: self.tube_radius * scale };
        let (from_centre, along) = foot(line, &Vector3::zeros());
        let start = from_centre * scale;
        let outer = T::one() + unit.tube_radius;
        let squared = outer * outer - start.norm_squared();
        if !(squared >= T::zero()) {
            return;
        }
        let distance = |t: T| {
            let found = unit.signed_distance(&(start + line.direction * t));
            (found.distance, found.normal.dot(&line.direction))
        };
        let reach = squared.root() + T::EPSILON * T::literal(64.0) + T::literal(0.01);
        let [first, second, third] = unit.extrema(&start, &line.direction);
        let mut low = -reach;
        let mut at_low = distance(low).0;
        for high in [first, second, third, reach] {
            let high = high.max(low).min(reach);
            let at_high = distance(high).0;
            if (at_low < T::zero()) != (at_high < T::zero()) {
                let t = bracketed(low, high, distance);
                let point = start + line.direction * t;
                visit(Crossing {
                    along: along + t * self.ring_radius,
                    point: point * self.ring_radius,
                    normal: unit.normal(&point),
                    active: true,
                });
            }
            (low, at_low) = (high, at_high);
        }
    }

    /// By a search: the gap may be too large by 1/64 of the solid's reach where two places of the line
    /// are nearly equally near.
    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T> {
        let (centre, reach) = self.bounds();
        by_search(line, &centre, reach, |point| self.signed_distance(point))
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

serde_parts!(Torus {
    ring_radius_m: T = |torus: &Torus<T>| torus.ring_radius,
    tube_radius_m: T = |torus: &Torus<T>| torus.tube_radius,
} => |parts| Torus::new(parts.ring_radius_m, parts.tube_radius_m));
