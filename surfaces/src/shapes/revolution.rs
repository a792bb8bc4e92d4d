//! Surfaces of revolution from a profile curve.

use core::marker::PhantomData;

#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::profile::{Knot, exactly_at, fit, patch_at, pieces};
use crate::numeric::closest::by_search;
use crate::numeric::quadratic::roots;
use crate::numeric::roots::bisected;
use crate::numeric::twofold::Twofold;
use crate::numeric::vectors::{foot, hypotenuse, length, unit_or};
use crate::{ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, Patch};

/// A solid of revolution around the z axis; [`Posed`](crate::Posed) puts it elsewhere.
///
/// Between the points of its profile, the *square* of the radius is a quadratic spline in z with
/// a continuous slope (one more knot in the middle of each interval, Schumaker 1983). Each piece is
/// a quadric: crossings are found in closed form, none is missed; spheres, ellipsoids, paraboloids,
/// hyperboloids of revolution and cylinders are reproduced exactly from any of their points.
///
/// Where the profile ends with a radius that is not zero, a flat end closes the solid; it is not
/// active, since that is where a fingertip is held.
///
/// ```
/// use fingertip_surfaces::Revolution;
///
/// // A gel tip, millimetres measured with a caliper: height over the mount, diameter.
/// let tip = Revolution::from_profile([
///     [0.000_f64, 0.0080],
///     [0.004, 0.0080],
///     [0.008, 0.0074],
///     [0.012, 0.0052],
///     [0.014, 0.0],
/// ])?;
/// # let _ = tip;
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Revolution<T: Real, K> {
    knots: K,
    scalar: PhantomData<T>,
}

impl<T: Real, const N: usize> Revolution<T, [Knot<T>; N]> {
    /// From points `[z, radius]` \[m\] of the profile, z ascending.
    ///
    /// # Errors
    /// [`BadShape`] unless there are two points at least, all finite, with z ascending and the
    /// radius positive (zero is allowed at either end), and the curve through them keeps clear of
    /// the axis.
    pub fn from_profile(points: [[T; 2]; N]) -> Result<Self, BadShape> {
        let mut knots = points.map(Knot::at);
        fit(&mut knots)?;
        let mut exact = points.map(|point| Knot::at(point.map(Real::to_f64)));
        if fit(&mut exact).is_ok() {
            knots.iter_mut().zip(&exact).for_each(|(knot, exact)| knot.complete(exact));
        }
        Ok(Self { knots, scalar: PhantomData })
    }
}

#[cfg(feature = "alloc")]
impl<T: Real> Revolution<T, Vec<Knot<T>>> {
    /// As [`from_profile`](Revolution::from_profile), for any number of points.
    ///
    /// # Errors
    /// As there.
    pub fn from_points(points: &[[T; 2]]) -> Result<Self, BadShape> {
        let mut knots: Vec<_> = points.iter().map(|point| Knot::at(*point)).collect();
        fit(&mut knots)?;
        let mut exact: Vec<_> = points.iter().map(|point| Knot::at(point.map(Real::to_f64))).collect();
        if fit(&mut exact).is_ok() {
            knots.iter_mut().zip(&exact).for_each(|(knot, exact)| knot.complete(exact));
        }
        Ok(Self { knots, scalar: PhantomData })
    }
}

impl<T: Real, K: AsRef<[Knot<T>]>> Revolution<T, K> {
    /// The points of the profile.
    #[inline]
    #[must_use]
    pub fn knots(&self) -> &[Knot<T>] {
        self.knots.as_ref()
    }

    fn ends(&self) -> Option<(Knot<T>, Knot<T>)> {
        Some((*self.knots().first()?, *self.knots().last()?))
    }

    /// Squared radius at a height, with its first and second derivative; straight beyond the ends.
    pub(crate) fn profile(&self, z: T) -> [T; 3] {
        let mut found = None;
        for piece in pieces(self.knots()) {
            if z < piece.low && found.is_some() {
                break;
            }
            found = Some(piece);
        }
        let Some(piece) = found else { return [T::zero(); 3] };
        let near = z.max(piece.low).min(piece.high);
        let slope = piece.slope_at(near);
        let bend = if z == near { piece.curvature + piece.curvature } else { T::zero() };
        [piece.squared_at(near) + slope * (z - near), slope, bend]
    }

    /// `true` if the radius is a concave function of the height: on each piece,
    /// `2ρ²(ρ²)″ ≤ ((ρ²)′)²`, of which both sides differ by a constant.
    pub(crate) fn is_convex(&self) -> bool {
        pieces(self.knots()).all(|piece| {
            let four = T::literal(4.0);
            let (rise, bend) = (piece.slope * piece.slope, four * piece.squared * piece.curvature);
            bend <= rise + (bend.abs() + rise) * T::EPSILON * T::literal(16.0)
        })
    }

    pub(crate) fn bounds(&self) -> (Vector3<T>, T) {
        let (low, high) = self.ends().map_or((T::zero(), T::zero()), |(a, b)| (a.z, b.z));
        let half = (high - low) * T::literal(0.5);
        // The spline may bulge over its knots: by its slope, at most.
        let squared = pieces(self.knots()).fold(T::zero(), |greatest, piece| {
            let bulge = (piece.slope.abs() + (piece.high - piece.low) * piece.curvature.abs())
                * (piece.high - piece.low);
            greatest.max(piece.squared + bulge)
        });
        let centre = Vector3::new(T::zero(), T::zero(), low + half);
        (centre, hypotenuse(half, squared.root()) * T::literal(1.001))
    }

    /// Outward normal of the side where the profile passes `z`.
    fn side_normal(&self, x: T, y: T, z: T) -> Vector3<T> {
        let mut found = Vector3::z();
        for piece in pieces(self.knots()) {
            found = Vector3::new(x, y, -piece.slope_at(z.max(piece.low).min(piece.high)) * T::literal(0.5));
            if z <= piece.high {
                break;
            }
        }
        unit_or(&found, Vector3::z)
    }

    /// The part of the side at a height, to the last digit.
    pub(crate) fn patch_at(&self, z: T) -> Option<Patch> {
        patch_at(self.knots(), z)
    }

    fn inside(&self, radius: T, z: T) -> bool {
        pieces(self.knots())
            .any(|piece| z > piece.low && z <= piece.high && radius * radius < piece.squared_at(z))
    }

    /// Distance from the closest point of the profile, `false` if that is on a flat end.
    fn distance(&self, point: &Vector3<T>) -> (Distance<T>, bool) {
        let radius = hypotenuse(point.x, point.y);
        let z = point.z;
        let outward = unit_or(&Vector3::new(point.x, point.y, T::zero()), Vector3::x);
        let far = |r: T, h: T| hypotenuse(radius - r, z - h);
        let half = T::literal(0.5);
        let mut best: Option<(T, T, T, bool)> = None;
        let mut keep = |distance: T, r: T, h: T, active: bool| {
            if best.is_none_or(|(least, ..)| distance < least) {
                best = Some((distance, r, h, active));
            }
        };
        // On each piece, where the distance stops falling (from either side of its middle).
        for piece in pieces(self.knots()) {
            let radius_at = |h: T| piece.squared_at(h).max(T::zero()).root();
            let falls = |h: T| {
                let r = radius_at(h);
                (radius - r) * piece.slope_at(h) * half + (z - h) * r > T::zero()
            };
            let middle = (piece.low + piece.high) * half;
            for (low, high) in [(piece.low, middle), (middle, piece.high)] {
                let h = if falls(low) == falls(high) {
                    if falls(low) { high } else { low }
                } else {
                    bisected(low, high, falls)
                };
                keep(far(radius_at(h), h), radius_at(h), h, true);
            }
        }
        if let Some((low, high)) = self.ends() {
            for end in [low, high] {
                if end.radius > T::zero() && radius < end.radius {
                    keep((z - end.z).abs(), radius, end.z, false);
                }
            }
        }
        let (distance, r, h, active) = best.unwrap_or((T::zero(), T::zero(), T::zero(), true));
        let away = outward * (radius - r) + Vector3::z() * (z - h);
        let side = || self.side_normal(outward.x * r, outward.y * r, h);
        if self.inside(radius, z) {
            return (Distance { distance: -distance, normal: unit_or(&-away, side) }, active);
        }
        (Distance { distance, normal: unit_or(&away, side) }, active)
    }
}

impl<T: Real, K: AsRef<[Knot<T>]>> ActiveSurface<T> for Revolution<T, K> {
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let (centre, reach) = self.bounds();
        let (offset, along) = foot(line, &centre);
        let left = reach * reach - offset.norm_squared();
        if !(left > T::zero()) {
            return;
        }
        let (start, direction) = (centre + offset, line.direction);
        let reach = left.root();
        let mut report = |t: T, end: Option<Vector3<T>>| {
            let point = start + direction * t;
            let normal = end.unwrap_or_else(|| self.side_normal(point.x, point.y, point.z));
            visit(Crossing { along: along + t, point, normal, active: end.is_none() });
        };
        // How far outside the line is at a height, as seen from both pieces that meet there.
        let at_height = |z: T| (z - start.z) / direction.z;
        let excess_at = |t: T, squared: T| {
            let (x, y) = (start.x + direction.x * t, start.y + direction.y * t);
            x * x + y * y - squared
        };
        for piece in pieces(self.knots()) {
            let (low, high) = if direction.z == T::zero() {
                if !(piece.low <= start.z && start.z < piece.high) {
                    continue;
                }
                ((-reach, None), (reach, None))
            } else {
                let below = (at_height(piece.low), Some(piece.squared));
                let above = (at_height(piece.high), Some(piece.squared_above));
                let (first, last) = if direction.z > T::zero() { (below, above) } else { (above, below) };
                (
                    if first.0 >= -reach { first } else { (-reach, None) },
                    if last.0 <= reach { last } else { (reach, None) },
                )
            };
            if !(low.0 < high.0) {
                continue;
            }
            let outside = |(t, squared): (T, Option<T>)| {
                excess_at(t, squared.unwrap_or_else(|| piece.squared_at(start.z + direction.z * t)))
                    >= T::zero()
            };
            let middle = (low.0 + high.0) * T::literal(0.5);
            let m = start + direction * middle;
            let a = direction.x * direction.x + direction.y * direction.y
                - piece.curvature * direction.z * direction.z;
            let b =
                m.x * direction.x + m.y * direction.y - piece.slope_at(m.z) * direction.z * T::literal(0.5);
            let c = m.x * m.x + m.y * m.y - piece.squared_at(m.z);
            let ends = roots(a, b, c).map(|ends| ends.map(|t| t + middle));
            let within = |t: &T| *t > low.0 && *t < high.0;
            if outside(low) != outside(high) {
                // Exactly one: the root within, or what rounding left of it.
                let t = ends
                    .and_then(|ends| ends.into_iter().find(within))
                    .or(ends.and_then(|ends| ends.into_iter().find(|t| t.is_number())))
                    .unwrap_or(middle);
                report(t.max(low.0).min(high.0), None);
            } else if let Some([first, second]) = ends
                && within(&first)
                && within(&second)
            {
                report(first, None);
                report(second, None);
            }
        }
        if let (Some((bottom, top)), true) = (self.ends(), direction.z != T::zero()) {
            for (end, normal) in [(bottom, -Vector3::z()), (top, Vector3::z())] {
                let t = at_height(end.z);
                if t.abs() <= reach && excess_at(t, end.radius * end.radius) < T::zero() {
                    report(t, Some(normal));
                }
            }
        }
    }

    /// By a bounded search along the line, which takes microseconds. The gap is exact but for rounding
    /// where one place of the line is nearest by more than 1/256 of the radius of
    /// a ball around the solid; otherwise another place, at most that much nearer, may be missed. The
    /// distance of a place from the profile is the least of one candidate per half of every piece: of a
    /// piece that bends inward more than a circle about the place, the nearest point may be missed.
    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T> {
        let (centre, reach) = self.bounds();
        let found = by_search(line, &centre, reach, |point| self.distance(point).0);
        let active = self.distance(&found.point).1;
        ClosestApproach { active, ..found }
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        let (found, active) = self.distance(point);
        if active { self.side_normal(point.x, point.y, point.z) } else { found.normal }
    }

    /// Outside the side, on which the active part lies.
    fn outside_by(&self, point: &Vector3<T>) -> T {
        let Some([squared, slope]) = exactly_at(self.knots(), point.z) else { return T::zero() };
        let [x, y] = [point.x, point.y].map(Twofold::new);
        let excess = x.squared().plus(y.squared()).minus(squared).value();
        let outside = excess / length(&Vector3::new(point.x + point.x, point.y + point.y, slope.value()));
        // At a tip there is no telling.
        if outside.is_number() { outside } else { T::zero() }
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        self.inside(hypotenuse(point.x, point.y), point.z)
    }
}

/// In files, a list of points `[z, radius]`.
#[cfg(feature = "serde")]
mod files {
    use core::fmt;
    use core::marker::PhantomData;

    use fingertip_wrench::Real;
    use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
    use serde::ser::{Serialize, SerializeStruct, Serializer};

    #[cfg(feature = "alloc")]
    use super::Vec;
    use super::{Knot, Revolution};

    struct Points<'a, T: Real>(&'a [Knot<T>]);

    impl<T: Real + Serialize> Serialize for Points<'_, T> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            serializer.collect_seq(self.0.iter().map(Knot::point))
        }
    }

    impl<T: Real + Serialize, K: AsRef<[Knot<T>]>> Serialize for Revolution<T, K> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let mut parts = serializer.serialize_struct("Revolution", 1)?;
            parts.serialize_field("profile_m", &Points(self.knots()))?;
            parts.end()
        }
    }

    struct Array<T, const N: usize>([[T; 2]; N]);

    impl<'de, T: Real + Deserialize<'de>, const N: usize> Deserialize<'de> for Array<T, N> {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            struct Collect<T, const N: usize>(PhantomData<T>);
            impl<'de, T: Real + Deserialize<'de>, const N: usize> Visitor<'de> for Collect<T, N> {
                type Value = Array<T, N>;
                fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                    write!(formatter, "{N} points [z, radius]")
                }
                fn visit_seq<A: SeqAccess<'de>>(self, mut points: A) -> Result<Self::Value, A::Error> {
                    let mut found = [[T::zero(); 2]; N];
                    for (k, point) in found.iter_mut().enumerate() {
                        *point = points.next_element()?.ok_or_else(|| Error::invalid_length(k, &self))?;
                    }
                    if points.next_element::<[T; 2]>()?.is_some() {
                        return Err(Error::invalid_length(N + 1, &self));
                    }
                    Ok(Array(found))
                }
            }
            deserializer.deserialize_seq(Collect(PhantomData))
        }
    }

    #[derive(serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Parts<P> {
        profile_m: P,
    }

    impl<'de, T: Real + Deserialize<'de>, const N: usize> Deserialize<'de> for Revolution<T, [Knot<T>; N]> {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let parts = Parts::<Array<T, N>>::deserialize(deserializer)?;
            Self::from_profile(parts.profile_m.0).map_err(Error::custom)
        }
    }

    #[cfg(feature = "alloc")]
    impl<'de, T: Real + Deserialize<'de>> Deserialize<'de> for Revolution<T, Vec<Knot<T>>> {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let parts = Parts::<Vec<[T; 2]>>::deserialize(deserializer)?;
            Self::from_points(&parts.profile_m).map_err(Error::custom)
        }
    }
}
