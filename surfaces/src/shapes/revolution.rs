//! Surfaces of revolution from a profile curve.

use core::marker::PhantomData;

#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use fingertip_wrench::{Line, Real};
use nalgebra::{Matrix3, Vector3};

use super::profile::{Knot, Profile, ProfileInDouble, exactly_at, fit, local_surface_at, pieces};
use super::sight::Sight;
use crate::numeric::twofold::Twofold;
use crate::numeric::vectors::{hypotenuse, is_finite, length, unit_or};
use crate::shortcuts::entry_near;
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Extent, Level, LineInDouble, LocalSurface, Shortcuts,
    SmoothSurface, Topology,
};

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
/// In files, a list of points `[z, radius]`.
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
/// // At 8 mm it is 7.4 mm thick, which is half a millimetre between these two.
/// use fingertip_surfaces::ActiveSurface;
/// use nalgebra::Vector3;
/// assert!(tip.contains(&Vector3::new(0.0069, 0.0, 0.008)));
/// assert!(!tip.contains(&Vector3::new(0.0, 0.0079, 0.008)));
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
}

impl<T: Real, K: Profile<T>> Revolution<T, K> {
    #[inline]
    pub(super) const fn profile(&self) -> &K {
        &self.knots
    }

    /// The same in double precision.
    #[doc(hidden)]
    pub fn in_double(&self) -> Revolution<f64, ProfileInDouble<'_, T, K>> {
        Revolution { knots: ProfileInDouble::new(&self.knots), scalar: PhantomData }
    }

    pub(super) fn ends(&self) -> Option<(Knot<T>, Knot<T>)> {
        let mut knots = self.profile().knots();
        let bottom = knots.next()?;
        Some((bottom, knots.last().unwrap_or(bottom)))
    }

    /// From which height to which the profile goes \[m\].
    #[doc(hidden)]
    #[must_use]
    pub fn heights(&self) -> Option<[T; 2]> {
        self.ends().map(|(bottom, top)| [bottom.z, top.z])
    }

    /// Squared radius at a height, with its first and second derivative; straight beyond the ends.
    pub(crate) fn profile_at(&self, z: T) -> [T; 3] {
        let mut found = None;
        for piece in pieces(self.profile()) {
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
        pieces(self.profile()).all(|piece| {
            let four = T::literal(4.0);
            let (rise, bend) = (piece.slope * piece.slope, four * piece.squared * piece.curvature);
            bend <= rise + (bend.abs() + rise) * T::EPSILON * T::literal(16.0)
        })
    }

    pub(crate) fn bounds(&self) -> (Vector3<T>, T) {
        let (low, high) = self.ends().map_or((T::zero(), T::zero()), |(a, b)| (a.z, b.z));
        let half = (high - low) * T::literal(0.5);
        // The spline may bulge over its knots: by its slope, at most.
        let squared = pieces(self.profile()).fold(T::zero(), |greatest, piece| {
            let bulge = (piece.slope.abs() + (piece.high - piece.low) * piece.curvature.abs())
                * (piece.high - piece.low);
            greatest.max(piece.squared + bulge)
        });
        let centre = Vector3::new(T::zero(), T::zero(), low + half);
        (centre, hypotenuse(half, squared.root()) * T::literal(1.001))
    }

    /// Outward normal of the side where the profile passes `z`.
    pub(super) fn side_normal(&self, x: T, y: T, z: T) -> Vector3<T> {
        let mut found = Vector3::z();
        for piece in pieces(self.profile()) {
            found = Vector3::new(x, y, -piece.slope_at(z.max(piece.low).min(piece.high)) * T::literal(0.5));
            if z <= piece.high {
                break;
            }
        }
        unit_or(&found, Vector3::z)
    }

    /// The part of the side at a height, to the last digit.
    #[doc(hidden)]
    pub fn local_surface_at(&self, z: T) -> Option<LocalSurface> {
        local_surface_at(self.profile(), z)
    }

    fn inside(&self, radius: T, z: T) -> bool {
        pieces(self.profile())
            .any(|piece| z > piece.low && z <= piece.high && radius * radius < piece.squared_at(z))
    }
}

impl<T: Real, K: Profile<T>> ActiveSurface<T> for Revolution<T, K> {
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        self.each_crossing(line, &mut visit);
    }

    /// The nearest of all places that can be: each piece of the side is a quadric, on whose outline the
    /// stretches that have a nearest place each are known in closed form; rims and tips are looked at
    /// besides. None is missed, and the gap is exact but for rounding. The work is bounded: per interval
    /// of the profile five steps of Newton's method on average, and at most 59 for any of 270 000 lines tried.
    ///
    /// Of a line that crosses the surface, the gap is zero and the point the nearest one of its outline.
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let (centre, reach) = self.bounds();
        let mut sight = Sight::new(line, &centre, reach);
        let mut all = pieces(self.profile()).map(|piece| sight.seen(&piece));
        if let Some(first) = all.next() {
            let last = all.last().unwrap_or(first);
            sight.rim(first.low, first.squared.root(), first.slope, -T::one());
            sight.rim(last.high, last.squared_above.root(), last.slope_above, T::one());
        }
        for piece in pieces(self.profile()) {
            sight.side(&sight.seen(&piece));
        }
        let (gap, point, normal) = sight.nearest().unwrap_or_else(|| (T::zero(), centre, Vector3::z()));
        let mut crosses = false;
        self.crossings(line, |_| crosses = true);
        let gap = if crosses { T::zero() } else { gap.max(T::zero()).min(T::GREATEST) };
        let point = if is_finite(&point) { point } else { centre };
        Some(ClosestApproach { gap, point, normal, active: true })
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        let radius = hypotenuse(point.x, point.y);
        let [squared, slope, _] = self.profile_at(point.z);
        let from_side = ((radius * radius - squared) / hypotenuse(radius + radius, slope)).abs();
        let on = |end: &Knot<T>| radius < end.radius && (point.z - end.z).abs() < from_side;
        let Some((bottom, top)) = self.ends() else { return Vector3::z() };
        let is_lower = (point.z - bottom.z).abs() < (point.z - top.z).abs();
        let (end, outward) = if is_lower { (bottom, -Vector3::z()) } else { (top, Vector3::z()) };
        if on(&end) { outward } else { self.side_normal(point.x, point.y, point.z) }
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        self.inside(hypotenuse(point.x, point.y), point.z)
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real, K: Profile<T>> Shortcuts<T> for Revolution<T, K> {
    /// Outside the side, on which the active part lies.
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let Some([squared, slope]) = exactly_at(self.profile(), point.z) else { return T::zero() };
        let [x, y] = [point.x, point.y].map(Twofold::new);
        let excess = x.squared().plus(y.squared()).minus(squared).value();
        let outside = excess / length(&Vector3::new(point.x + point.x, point.y + point.y, slope.value()));
        // At a tip there is no telling.
        if outside.is_number() { outside } else { T::zero() }
    }

    fn posed_entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        entry_near(&self.in_double(), line, near)
    }
}

/// `x² + y² − ρ²(z)`, piece by piece; beyond the ends of the profile `ρ²` goes on straight, which
/// keeps a convex profile convex. The curvature jumps where pieces meet; the flat ends are not part
/// of the level function.
impl<T: Real, K: Profile<T>> SmoothSurface<T> for Revolution<T, K> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let [squared, slope, curvature] = self.profile_at(point.z);
        let two = T::one() + T::one();
        Level {
            value: point.x * point.x + point.y * point.y - squared,
            gradient: Vector3::new(two * point.x, two * point.y, -slope),
            hessian: Matrix3::from_diagonal(&Vector3::new(two, two, -curvature)),
        }
    }

    fn extent(&self) -> Extent<T> {
        let (centre, radius) = self.bounds();
        Extent { centre, radius }
    }

    fn topology(&self) -> Topology {
        if self.is_convex() { Topology::Convex } else { Topology::Unknown }
    }
}

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
