//! Surfaces of revolution from a profile curve.

use core::marker::PhantomData;

#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::numeric::closest::by_search;
use crate::numeric::quadratic::roots;
use crate::numeric::roots::bisected;
use crate::numeric::twofold::Twofold;
use crate::numeric::vectors::{foot, hypotenuse, length, unit_or};
use crate::{ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, Patch};

/// One point of a profile, and how the curve goes on from there to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot<T: Real> {
    z: T,
    radius: T,
    /// `d(ρ²)/dz` here, and half-way to the next knot.
    slope: T,
    middle_slope: T,
    /// What rounding took from both, for a type narrower than `f64`.
    rests: [T; 2],
}

impl<T: Real> Knot<T> {
    fn at([z, radius]: [T; 2]) -> Self {
        Self { z, radius, slope: T::zero(), middle_slope: T::zero(), rests: [T::zero(); 2] }
    }

    /// Takes what rounding took from the slopes from those of the same knot in double precision.
    fn complete(&mut self, exact: &Knot<f64>) {
        self.rests = [
            T::literal(exact.slope - self.slope.to_f64()),
            T::literal(exact.middle_slope - self.middle_slope.to_f64()),
        ];
    }

    /// Height and radius \[m\].
    #[inline]
    #[must_use]
    pub const fn point(&self) -> [T; 2] {
        [self.z, self.radius]
    }
}

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

/// A stretch of the profile on which `ρ²` is `squared + slope·d + curvature·d²`, `d` being the
/// height over its lower end.
#[derive(Clone, Copy)]
struct Piece<T: Real> {
    low: T,
    high: T,
    squared: T,
    squared_above: T,
    slope: T,
    curvature: T,
}

impl<T: Real> Piece<T> {
    #[inline]
    fn squared_at(&self, z: T) -> T {
        let d = z - self.low;
        self.squared + d * (self.slope + d * self.curvature)
    }

    #[inline]
    fn slope_at(&self, z: T) -> T {
        let d = z - self.low;
        self.slope + (d + d) * self.curvature
    }
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

/// Gives every knot its slopes: exact where `ρ²` is quadratic.
fn fit<T: Real>(knots: &mut [Knot<T>]) -> Result<(), BadShape> {
    let shape = "surface of revolution";
    BadShape::check(shape, "profile", "at least two points", knots.len() >= 2)?;
    let last = knots.len() - 1;
    for (k, knot) in knots.iter().enumerate() {
        BadShape::check(shape, "profile", "finite", knot.z.is_number() && knot.radius.is_number())?;
        let at_end = k == 0 || k == last;
        let clear = knot.radius > T::zero() || (at_end && knot.radius >= T::zero());
        BadShape::check(shape, "profile", "clear of the axis but for its ends", clear)?;
    }
    let greatest = knots.iter().fold(T::zero(), |greatest, knot| greatest.max(knot.radius));
    BadShape::check(
        shape,
        "profile",
        "neither tiny nor huge",
        greatest >= T::LEAST_NORMAL.root() / T::EPSILON && greatest <= T::GREATEST.root() * T::EPSILON,
    )?;
    let two = T::one() + T::one();
    let mut before: Option<(T, T)> = None;
    for k in 0..last {
        let (Some(this), Some(next)) = (knots.get(k).copied(), knots.get(k + 1).copied()) else { break };
        let width = next.z - this.z;
        BadShape::check(shape, "profile", "ascending in z", width > T::zero())?;
        let rise = (next.radius - this.radius) * (next.radius + this.radius) / width;
        if let Some(knot) = knots.get_mut(k) {
            knot.slope = before.map_or(rise, |(width_before, rise_before)| {
                (width * rise_before + width_before * rise) / (width + width_before)
            });
            // Until the next slope is known.
            knot.middle_slope = rise;
        }
        before = Some((width, rise));
    }
    let rises = |knot: Option<&Knot<T>>| knot.map_or(T::zero(), |knot| knot.middle_slope);
    // The ends continue the parabola of their neighbours.
    let final_rise = rises(knots.get(last - 1));
    let final_slope = if last == 1 {
        final_rise
    } else {
        two * final_rise - knots.get(last - 1).map_or(T::zero(), |knot| knot.slope)
    };
    if last > 1 {
        let first_slope = two * rises(knots.first()) - knots.get(1).map_or(T::zero(), |knot| knot.slope);
        if let Some(knot) = knots.first_mut() {
            knot.slope = first_slope;
        }
    }
    if let Some(knot) = knots.get_mut(last) {
        knot.slope = final_slope;
        knot.middle_slope = final_slope;
    }
    for k in 0..last {
        let next_slope = knots.get(k + 1).map_or(T::zero(), |knot| knot.slope);
        if let Some(knot) = knots.get_mut(k) {
            knot.middle_slope = two * knot.middle_slope - (knot.slope + next_slope) / two;
        }
    }
    let tolerance = greatest * greatest * T::EPSILON * T::literal(16.0);
    for piece in pieces(knots) {
        let turn = piece.low - piece.slope / (two * piece.curvature);
        let least = if turn > piece.low && turn < piece.high { piece.squared_at(turn) } else { T::zero() };
        BadShape::check(
            shape,
            "profile",
            "smooth: the curve through its points must not touch the axis between them",
            least >= -tolerance && piece.squared_above >= -tolerance,
        )?;
    }
    Ok(())
}

fn pieces<T: Real>(knots: &[Knot<T>]) -> impl Iterator<Item = Piece<T>> + '_ {
    knots.iter().zip(knots.iter().skip(1)).flat_map(|(this, next)| {
        let width = next.z - this.z;
        let half = width * T::literal(0.5);
        let middle = this.z + half;
        let squared = this.radius * this.radius;
        let squared_above = next.radius * next.radius;
        // From the ends inward, so that both values at the knots are exact.
        let squared_middle = squared + (this.slope + this.middle_slope) * half * T::literal(0.5);
        [
            Piece {
                low: this.z,
                high: middle,
                squared,
                squared_above: squared_middle,
                slope: this.slope,
                curvature: (this.middle_slope - this.slope) / width,
            },
            Piece {
                low: middle,
                high: next.z,
                squared: squared_middle,
                squared_above,
                slope: this.middle_slope,
                curvature: (next.slope - this.middle_slope) / width,
            },
        ]
    })
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

    /// Squared radius at a height and its slope, with twice the digits and the slopes that the points
    /// have exactly; as if the first and the last piece went on beyond the ends.
    fn exact_profile(&self, z: T) -> Option<[Twofold<T>; 2]> {
        let knots = self.knots();
        let (this, next) = knots
            .iter()
            .zip(knots.iter().skip(1))
            .find(|(_, next)| z <= next.z)
            .or_else(|| knots.iter().zip(knots.iter().skip(1)).next_back())?;
        let slope = |rounded: T, rest: T| Twofold::difference(rounded, -rest);
        let middle = slope(this.middle_slope, this.rests[1]);
        let width = Twofold::difference(next.z, this.z);
        // In terms of the nearer knot, so that the value there is exact.
        let ahead = Twofold::difference(z, this.z);
        let from_this = (ahead.value() + ahead.value()) <= width.value();
        let (knot, way) = if from_this { (this, ahead) } else { (next, Twofold::difference(z, next.z)) };
        let at_knot = slope(knot.slope, knot.rests[0]);
        // Half the width from knot to middle, in the direction of the way.
        let turn = if from_this { middle.minus(at_knot) } else { at_knot.minus(middle) };
        let bend = turn.times(way).divided_by(width);
        let squared = Twofold::new(knot.radius).squared().plus(way.times(at_knot.plus(bend)));
        Some([squared, at_knot.plus(bend).plus(bend)])
    }

    /// The part of the side at a height, by the numbers of the nearer knot. Those at the ends go on.
    pub(crate) fn turned(&self, z: T) -> Option<Patch> {
        let knots = self.knots();
        let last = knots.len().checked_sub(2)?;
        let below = knots.iter().skip(1).position(|next| z <= next.z).unwrap_or(last).min(last);
        let (this, next) = (knots.get(below)?, knots.get(below + 1)?);
        let [low, high, at] = [this.z, next.z, z].map(Real::to_f64);
        let exact = |rounded: T, rest: T| rounded.to_f64() + rest.to_f64();
        let middle = exact(this.middle_slope, this.rests[1]);
        let half = low + (high - low) * 0.5;
        let from_this = at <= half;
        let knot = if from_this { this } else { next };
        let slope = exact(knot.slope, knot.rests[0]);
        Some(Patch::Turned {
            origin: knot.z.to_f64(),
            radius: knot.radius.to_f64(),
            slope,
            turn: if from_this { [slope, middle] } else { [middle, slope] },
            width: [low, high],
            between: match (from_this, below) {
                (true, 0) => [f64::NEG_INFINITY, half],
                (true, _) => [low, half],
                (false, below) if below == last => [half, f64::INFINITY],
                (false, _) => [half, high],
            },
        })
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
        let Some([squared, slope]) = self.exact_profile(point.z) else { return T::zero() };
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
