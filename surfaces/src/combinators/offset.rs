//! The parallel surface.

use fingertip_wrench::{Line, Real};
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::numeric::closest::{by_search, from_distance, to_convex};
use crate::numeric::roots::{all_of_lipschitz, first_of_convex};
use crate::numeric::twofold::{Twofold, difference, dot_with};
use crate::numeric::vectors::{foot, tangents};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Corner, Crossing, Distance, Extent, Level, Shortcuts,
    SignedDistance, SmoothSurface, Topology, hessian_by_differences,
};

/// All points at one distance from a shape: outside it (a skin put over a fingertip), or inside
/// (a skin pressed in; `docs/theory/surfaces.md#parallel-surfaces`). Unlike a shape with larger semi-axes it
/// has the same thickness everywhere.
///
/// Outside a convex shape it is convex and smooth. Inside, it ends where it would fold over itself.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Ellipsoid, Offset};
/// use nalgebra::Vector3;
///
/// // A skin of 2 mm over an ellipsoid.
/// let tip = Offset::new(Ellipsoid::new(Vector3::new(0.008, 0.010, 0.015))?, 0.002)?;
/// assert!(tip.contains(&Vector3::new(0.0099, 0.0, 0.0)) && !tip.contains(&Vector3::new(0.0101, 0.0, 0.0)));
/// assert!(tip.contains(&Vector3::new(0.0, 0.0, 0.0169)) && !tip.contains(&Vector3::new(0.0, 0.0, 0.0171)));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset<T: Real, S> {
    surface: S,
    distance: T,
}

impl<T: Real, S: SignedDistance<T>> Offset<T, S> {
    /// At a distance \[m\] outside `surface`, or inside if negative.
    ///
    /// # Errors
    /// [`BadShape`] unless the distance is finite and leaves something of the shape's bounds.
    pub fn new(surface: S, distance: T) -> Result<Self, BadShape> {
        let (_, radius) = surface.bounds();
        BadShape::check("parallel surface", "distance", "finite", distance.is_number())?;
        BadShape::check_length("parallel surface", "size left", radius + distance)?;
        Ok(Self { surface, distance })
    }
}

impl<T: Real, S> Offset<T, S> {
    /// The surface that it is parallel to.
    #[inline]
    #[must_use]
    pub const fn inner(&self) -> &S {
        &self.surface
    }

    /// The distance from it \[m\], positive outside.
    #[inline]
    #[must_use]
    pub const fn distance(&self) -> T {
        self.distance
    }
}

impl<T: Real, S: SignedDistance<T>> ActiveSurface<T> for Offset<T, S> {
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let (centre, radius) = self.bounds();
        let (offset, along) = foot(line, &centre);
        let scaled = offset / radius;
        let squared = T::literal(1.001) - scaled.norm_squared();
        if !(squared > T::zero()) {
            return;
        }
        let reach = squared.root() * radius;
        let start = centre + offset;
        let distance = |t: T| {
            let found = self.signed_distance(&(start + line.direction * t));
            (found.distance, found.normal.dot(&line.direction))
        };
        let mut report = |t: T| {
            let point = start + line.direction * t;
            visit(Crossing { along: along + t, point, normal: self.normal(&point), active: true });
        };
        if S::CONVEX {
            let entry = first_of_convex(-reach, T::one(), distance);
            let exit = first_of_convex(reach, -T::one(), distance);
            if let (Some(entry), Some(exit)) = (entry, exit) {
                report(entry);
                report(exit);
            }
        } else {
            all_of_lipschitz(-reach, reach, T::one(), |t| distance(t).0, distance, report);
        }
    }

    /// Outside a shape as exact as that of the shape itself, which has the same place nearest to the line;
    /// inside a convex one exact but for rounding. Inside another one by a bounded search along the line,
    /// in which a place that is nearer by at most 1/256 of the bounds' radius may be missed.
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let (centre, reach) = self.bounds();
        if S::CONVEX {
            Some(to_convex(line, &centre, reach, |point| self.signed_distance(point)))
        } else if self.distance >= T::zero() {
            let nearest = self.surface.closest_approach(line)?.point - line.point;
            let place = line.at(nearest.dot(&line.direction));
            Some(from_distance(&place, self.signed_distance(&place)))
        } else {
            Some(by_search(line, &centre, reach, |point| self.signed_distance(point)))
        }
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.surface.signed_distance(point).normal
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        self.signed_distance(point).distance < T::zero()
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

/// A parallel surface has no entry in closed form, whatever the inner one has.
impl<T: Real, S: SignedDistance<T>> Shortcuts<T> for Offset<T, S> {
    const CLOSED_CONVEX: bool = S::CONVEX;

    /// How far it is from the distance to a point of the inner surface, and that point from where it should be.
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let normal = self.normal(point);
        let foot = point - normal * self.distance;
        let apart = dot_with(difference(point, &foot), &normal);
        apart.minus(Twofold::new(self.distance)).value() + self.surface.shortcuts().surface_residual(&foot)
    }
}

impl<T: Real, S: SignedDistance<T>> SignedDistance<T> for Offset<T, S> {
    const CONVEX: bool = S::CONVEX;

    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T> {
        let found = self.surface.signed_distance(point);
        Distance { distance: found.distance - self.distance, ..found }
    }

    fn bounds(&self) -> (Vector3<T>, T) {
        let (centre, radius) = self.surface.bounds();
        (centre, radius + self.distance)
    }
}

/// In files, the surface and the distance.
/// The distance, with the curvature of the parallel surface, `W/(1 + δW)` at the distance `δ` over
/// a point of the inner surface with the shape operator `W`; over an edge or a tip, which the offset makes
/// round, from differences of the normal.
impl<T: Real, S: SmoothSurface<T> + SignedDistance<T>> SmoothSurface<T> for Offset<T, S> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let Distance { distance, normal } = self.inner().signed_distance(point);
        let (e1, e2) = tangents(&normal);
        let foot = point - normal * distance;
        let bend = self.inner().bend(&foot, &normal, [&e1, &e2]);
        let hessian = match (Matrix2::identity() + bend * distance).try_inverse() {
            Some(spread) if bend.sum().is_number() => {
                let bend = bend * spread;
                (e1 * bend.m11 + e2 * bend.m21) * e1.transpose()
                    + (e1 * bend.m12 + e2 * bend.m22) * e2.transpose()
            }
            // Around an edge or a tip of the inner surface.
            Some(_) if distance > T::zero() => match self.inner().corner(&foot, &normal) {
                Some(Corner::Edge { direction, bend }) => {
                    let across = normal.cross(&direction);
                    direction * direction.transpose() * (bend / (T::one() + bend * distance))
                        + across * across.transpose() / distance
                }
                Some(Corner::Tip) => (Matrix3::identity() - normal * normal.transpose()) / distance,
                None => {
                    let step = distance * T::EPSILON.cube_root();
                    hessian_by_differences(point, step, |p| self.inner().signed_distance(p).normal)
                }
            },
            _ => Matrix3::zeros(),
        };
        Level { value: distance - self.distance(), gradient: normal, hessian }
    }

    fn extent(&self) -> Extent<T> {
        let (centre, radius) = self.bounds();
        Extent { centre, radius }
    }

    fn topology(&self) -> Topology {
        if S::CONVEX { Topology::Convex } else { self.inner().topology() }
    }
}

#[cfg(feature = "serde")]
mod files {
    use fingertip_wrench::Real;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    use super::Offset;
    use crate::SignedDistance;

    #[derive(Serialize)]
    struct Written<'a, T, S> {
        distance_m: T,
        surface: &'a S,
    }

    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Read<T, S> {
        distance_m: T,
        surface: S,
    }

    impl<T: Real + Serialize, S: Serialize> Serialize for Offset<T, S> {
        fn serialize<W: Serializer>(&self, serializer: W) -> Result<W::Ok, W::Error> {
            Written { distance_m: self.distance, surface: &self.surface }.serialize(serializer)
        }
    }

    impl<'de, T, S> Deserialize<'de> for Offset<T, S>
    where
        T: Real + Deserialize<'de>,
        S: SignedDistance<T> + Deserialize<'de>,
    {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let Read { distance_m, surface } = Read::<T, S>::deserialize(deserializer)?;
            Self::new(surface, distance_m).map_err(Error::custom)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Offset;
    use crate::{ActiveSurface, Torus};
    use fingertip_wrench::Line;
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};

    /// The parallel surface of a torus is one with a thicker tube.
    #[test]
    fn closest_approaches_outside_a_torus_are_those_of_a_thicker_one() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(11);
        let (thick, parallel) = (
            Torus::<f64>::new(1.0, 0.375).unwrap(),
            Offset::new(Torus::new(1.0, 0.25).unwrap(), 0.125).unwrap(),
        );
        let mut missing = 0;
        for _ in 0..2000 {
            let mut any = || Vector3::from_fn(|_, _| random.random_range(-1.5..1.5));
            let line = Line { point: any(), direction: any().normalize() };
            let (found, expected) =
                (parallel.closest_approach(&line).unwrap(), thick.closest_approach(&line).unwrap());
            assert!(
                (found.gap - expected.gap).abs() <= 8.0 * f64::EPSILON,
                "{line:?} {found:?} {expected:?}"
            );
            if expected.gap > 0.0 {
                missing += 1;
                assert!((found.point - expected.point).norm() < 1e-12 && found.active);
            }
        }
        assert!(missing > 500, "{missing}");
    }
}
