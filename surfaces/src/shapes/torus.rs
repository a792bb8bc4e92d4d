//! The torus.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::Vector3;

use super::ring::RingLine;
use crate::numeric::closest::from_distance;
use crate::numeric::twofold::Twofold;
use crate::numeric::vectors::{foot, hypotenuse, is_finite, unit_or};
use crate::shortcuts::{LineInDouble, entry_near};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, Extent, Level, Shortcuts, SignedDistance,
    SmoothSurface, Topology,
};

/// A ring around the z axis; [`Posed`](crate::Posed) puts it elsewhere.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Torus};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // A ring of 20 mm, its tube 3 mm in radius.
/// let ring = Torus::new(0.02, 0.003)?;
/// let line = Line { point: Vector3::new(-0.05, 0.0, 0.0), direction: Vector3::x() };
/// let mut places = Vec::new();
/// ring.crossings(&line, |crossing| places.push(crossing.point.x));
/// places.sort_by(f64::total_cmp);
/// for (found, expected) in places.iter().zip([-0.023, -0.017, 0.017, 0.023]) {
///     assert!((found - expected).abs() < 1e-15);
/// }
/// assert_eq!(places.len(), 4);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
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

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<Torus<f64>> {
        Torus::new(self.ring_radius.to_f64(), self.tube_radius.to_f64()).ok()
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

impl<T: Real> Torus<T> {
    /// Compiled once, not once for each caller: a call through a pointer costs little beside what is done here.
    fn each_crossing(&self, line: &Line<T>, visit: &mut dyn FnMut(Crossing<T>)) {
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
}

impl<T: Real> ActiveSurface<T> for Torus<T> {
    /// Up to four crossings, each bracketed between extrema of the distance from the ring
    /// (`docs/theory/surfaces.md#torus`).
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        self.each_crossing(line, &mut visit);
    }

    /// The nearer of the two places at most where the distance from the ring is least.
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
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
        Some(from_distance(&point, self.signed_distance(&point)))
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.signed_distance(point).normal
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        self.signed_distance(point).distance < T::zero()
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Torus<T> {
    /// A thin tube is bent sharply one way.
    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        entry_near(&self.in_double()?, line, near)
    }

    /// The distance from the ring less the radius of the tube, in units of the ring's.
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let unit = self.ring_radius.normalising_factor();
        let [x, y, z] = [point.x, point.y, point.z].map(|x| Twofold::new(x * unit));
        let radial = x.squared().plus(y.squared()).root();
        let beyond = radial.minus(Twofold::new(self.ring_radius * unit));
        let distance = beyond.squared().plus(z.squared()).root();
        distance.minus(Twofold::new(self.tube_radius * unit)).value() / unit
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

impl<T: Real> SmoothSurface<T> for Torus<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let radial = hypotenuse(point.x, point.y);
        let outward = unit_or(&Vector3::new(point.x, point.y, T::zero()), Vector3::x);
        let beyond = radial - self.ring_radius();
        let tube = hypotenuse(beyond, point.z);
        let normal = unit_or(&(outward * beyond + Vector3::z() * point.z), || outward);
        let around = Vector3::new(-outward.y, outward.x, T::zero());
        let along = around.cross(&normal);
        // Curvature across the tube, and around the ring.
        let hessian =
            along * along.transpose() / tube + around * around.transpose() * (normal.dot(&outward) / radial);
        Level { value: tube - self.tube_radius(), gradient: normal, hessian }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: Vector3::zeros(), radius: self.ring_radius() + self.tube_radius() }
    }

    fn topology(&self) -> Topology {
        Topology::Closed { euler_characteristic: 0 }
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
        let found = torus.closest_approach(line).unwrap();
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
