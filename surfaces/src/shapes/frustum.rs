//! The cone or truncated cone, closed at its ends.

use crate::smooth::flat_ends::Face;
use core::hint::select_unpredictable;

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix2, Matrix3, Vector3};

use super::axis::{Axis, Local, LocalEntry};
use crate::numeric::closest::to_convex;
use crate::numeric::twofold::Twofold;
use crate::numeric::vectors::{any_perpendicular, hypotenuse, length, unit_or, wide};
use crate::shortcuts::{LineInDouble, entry_near};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Corner, Crossing, Distance, Entry, Extent, ForceLine, Level,
    Shortcuts, SignedDistance, SmoothSurface, Topology,
};

/// A truncated circular cone with flat ends, all of it active; with one radius zero, a closed
/// cone; with equal radii, a closed cylinder.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Frustum};
/// use nalgebra::Vector3;
///
/// // 10 mm high, 6 mm in radius at its base and 4 mm at its top: 5 mm half-way.
/// let tip = Frustum::new(Vector3::zeros(), Vector3::z(), 0.006, 0.004, 0.01)?;
/// assert!(tip.contains(&Vector3::new(0.0049, 0.0, 0.005)));
/// assert!(!tip.contains(&Vector3::new(0.0051, 0.0, 0.005)));
/// assert_eq!(tip.normal(&Vector3::new(0.001, 0.0, 0.01)), Vector3::z());
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frustum<T: Real> {
    /// From the centre of the base towards the top.
    axis: Axis<T>,
    height: T,
    base_radius: T,
    top_radius: T,
    /// By how much the radius shrinks per height.
    taper: T,
    /// Cosine of the angle between the side and the axis.
    side_cosine: T,
    /// Sine of that angle: the part of the side's normal along the axis.
    side_sine: T,
    /// A hair across the axis.
    least_across: Vector3<T>,
    /// Centre of the narrower end, and how high over the base that is.
    narrow_end: (Vector3<T>, T),
    /// Halfway up the axis, and the radius there.
    middle: Vector3<T>,
    middle_radius: T,
    half_height: T,
    /// As far from the middle as an entry may be found, along the axis.
    reach: T,
}

impl<T: Real> Frustum<T> {
    /// From the centre of the base \[m\], an axis of any length towards the top, the radii of base and
    /// top, and the height \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless the centre is finite, the axis has a direction, the radii are positive
    /// finite lengths, of which one may be zero, and so is the height.
    pub fn new(
        base_centre: Vector3<T>,
        axis: Vector3<T>,
        base_radius: T,
        top_radius: T,
        height: T,
    ) -> Result<Self, BadShape> {
        let shape = "frustum";
        let check = |parameter, radius: T| {
            if radius == T::zero() { Ok(radius) } else { BadShape::check_length(shape, parameter, radius) }
        };
        let base_radius = check("base radius", base_radius)?;
        let top_radius = check("top radius", top_radius)?;
        BadShape::check_length(shape, "greater radius", base_radius.max(top_radius))?;
        let height = BadShape::check_length(shape, "height", height)?;
        let taper = (base_radius - top_radius) / height;
        BadShape::check(shape, "height", "not negligible against the radii", taper.is_number())?;
        let axis = Axis::new(
            BadShape::check_point(shape, "base centre", base_centre)?,
            BadShape::check_direction(shape, "axis", axis)?,
        );
        let side_cosine = T::one() / hypotenuse(T::one(), taper);
        let (half_height, middle_radius) =
            (height * T::literal(0.5), (base_radius + top_radius) * T::literal(0.5));
        let narrow_height = if top_radius < base_radius { height } else { T::zero() };
        // Where side and end meet, rounding may find a line outside both: a hair's breadth.
        let hair = (half_height + middle_radius) * (T::EPSILON * T::literal(16.0));
        Ok(Self {
            axis,
            narrow_end: (axis.origin + axis.direction * narrow_height, narrow_height),
            middle: axis.origin + axis.direction * half_height,
            middle_radius,
            half_height,
            reach: half_height + hair,
            side_sine: taper * side_cosine,
            least_across: axis.least_across(),
            height,
            base_radius,
            top_radius,
            taper,
            side_cosine,
        })
    }

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<Frustum<f64>> {
        let [base, top, height] = [self.base_radius, self.top_radius, self.height].map(Real::to_f64);
        Frustum::new(wide(&self.base_centre()), wide(&self.axis()), base, top, height).ok()
    }

    /// Centre of the base \[m\].
    #[inline]
    #[must_use]
    pub const fn base_centre(&self) -> Vector3<T> {
        self.axis.origin
    }

    /// Unit vector along the axis, from base to top.
    #[inline]
    #[must_use]
    pub const fn axis(&self) -> Vector3<T> {
        self.axis.direction
    }

    /// Height \[m\].
    #[inline]
    #[must_use]
    pub const fn height(&self) -> T {
        self.height
    }

    /// Radius of the base \[m\].
    #[inline]
    #[must_use]
    pub const fn base_radius(&self) -> T {
        self.base_radius
    }

    /// Radius of the top \[m\].
    #[inline]
    #[must_use]
    pub const fn top_radius(&self) -> T {
        self.top_radius
    }

    /// Centre of the narrower end \[m\], and how high over the base that is \[m\].
    #[inline]
    #[doc(hidden)]
    pub const fn narrow_end(&self) -> (Vector3<T>, T) {
        self.narrow_end
    }

    /// By how much the radius shrinks per height.
    #[inline]
    #[doc(hidden)]
    pub const fn taper(&self) -> T {
        self.taper
    }

    /// Cosine of the angle between the side and the axis.
    #[inline]
    #[doc(hidden)]
    pub const fn side_cosine(&self) -> T {
        self.side_cosine
    }

    #[inline]
    fn side_normal(&self, across: &Vector3<T>) -> Vector3<T> {
        (self.axis.outward(across) + self.axis.direction * self.taper) * self.side_cosine
    }

    /// Where a line enters, seen from the middle: through the end that it comes from, or else through
    /// the side. Which of them cannot be foretold, so both are prepared and one division serves both.
    ///
    /// That it enters nowhere is certain, but for rounding: a line that gets into the convex solid does
    /// so through the plane of the end that it comes from, within that end's circle, or out of the
    /// layer between both ends through the cone of the side, where `F` falls; it has one such place,
    /// and a place in the layer is on the right nappe.
    #[inline(always)]
    fn entry(&self, line: &Local<T>) -> LocalEntry<T> {
        let end = self.half_height.copysign(-line.rise);
        let end_radius = select_unpredictable(line.rise > T::zero(), self.base_radius, self.top_radius);
        // Where the line reaches that end, times its rise; never where it is parallel to the ends.
        let to_end = end - line.height;
        let there = line.across * line.rise + line.drift * to_end;
        let limit = end_radius * line.rise;
        let through_end = there.norm_squared() < limit * limit;
        let [to_side, over] = if self.taper == T::zero() {
            line.enters_cylinder(self.middle_radius)
        } else {
            line.enters_cone(self.middle_radius - self.taper * line.height, self.taper * line.rise)
        };
        let along = select_unpredictable(through_end, to_end, to_side)
            / select_unpredictable(through_end, line.rise, over);
        let height = select_unpredictable(through_end, end, line.height + along * line.rise);
        let away = select_unpredictable(through_end, T::zero(), self.side_cosine);
        let flat = select_unpredictable(through_end, T::one().copysign(end), self.side_sine);
        let across = line.across_at(along) + self.least_across;
        LocalEntry {
            enters: height.abs() <= self.reach,
            along,
            height: T::zero(),
            normal: self.axis.slanted(&across, away, flat),
        }
    }
}

impl<T: Real> ActiveSurface<T> for Frustum<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let local = self.axis.localise(line, &self.middle);
        self.axis.both_ends::<true>(
            &local,
            &self.middle,
            |line| self.entry(line),
            |_, crossing| visit(crossing),
        );
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let (centre, reach) = self.bounds();
        Some(to_convex(line, &centre, reach, |point| self.signed_distance(point)))
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.signed_distance(point).normal
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        let (height, across) = self.axis.split_point(point);
        let radius = self.base_radius - self.taper * height;
        height > T::zero()
            && height < self.height
            && radius > T::zero()
            && across.norm_squared() < radius * radius
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Frustum<T> {
    const CLOSED_CONVEX: bool = true;

    #[inline(always)]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        let local = self.axis.localise_push(push, &self.middle);
        Some(self.axis.entered(&local, &self.middle, &self.entry(&local), true))
    }

    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let taper = Twofold::difference(self.base_radius, self.top_radius).over(self.height);
        let side = self.axis.outside_cone_by(point, self.base_radius, taper, self.side_cosine);
        self.axis.outside_side_or_end(point, side, [T::zero(), self.height])
    }

    /// A line that grazes may leave through an end, or enter by one that is far from where the middle is.
    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        entry_near(&self.in_double()?, line, near)
    }
}

impl<T: Real> SignedDistance<T> for Frustum<T> {
    const CONVEX: bool = true;

    /// In the half-plane through the axis the solid is a trapezium with three sides.
    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T> {
        let (height, across) = self.axis.split_point(point);
        let outward = self.axis.outward(&across);
        let radius = across.dot(&outward).abs();
        let axis = self.axis.direction;
        // Heights over the three sides.
        let over_top = height - self.height;
        let under_base = -height;
        let beside = (radius - self.base_radius + self.taper * height) * self.side_cosine;
        if over_top <= T::zero() && under_base <= T::zero() && beside <= T::zero() {
            return if beside >= over_top && beside >= under_base {
                Distance { distance: beside, normal: self.side_normal(&across) }
            } else if over_top >= under_base {
                Distance { distance: over_top, normal: axis }
            } else {
                Distance { distance: under_base, normal: -axis }
            };
        }
        if over_top > T::zero() && radius <= self.top_radius {
            return Distance { distance: over_top, normal: axis };
        }
        if under_base > T::zero() && radius <= self.base_radius {
            return Distance { distance: under_base, normal: -axis };
        }
        // Position of the foot on the side, along it from the base.
        let side_height = height - beside * self.side_cosine * self.taper;
        if side_height >= T::zero() && side_height <= self.height {
            return Distance { distance: beside, normal: self.side_normal(&across) };
        }
        let (rim_radius, rim_height) = if side_height < T::zero() {
            (self.base_radius, T::zero())
        } else {
            (self.top_radius, self.height)
        };
        let (dr, dh) = (radius - rim_radius, height - rim_height);
        let distance = hypotenuse(dr, dh);
        let normal = if distance > T::zero() {
            (outward * dr + axis * dh) / distance
        } else {
            self.side_normal(&across)
        };
        Distance { distance, normal }
    }

    fn bounds(&self) -> (Vector3<T>, T) {
        (self.middle, hypotenuse(self.half_height, self.base_radius.max(self.top_radius)))
    }
}

/// The level function is that of the side; the flat ends are not part of it, but of the curvature.
impl<T: Real> SmoothSurface<T> for Frustum<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let axis = self.axis();
        let (taper, cosine) = (self.taper(), self.side_cosine());
        let from_base = point - self.base_centre();
        let height = from_base.dot(&axis);
        let across = from_base - axis * height;
        let radius = length(&across);
        let outward = unit_or(&across, || any_perpendicular(&axis));
        let flat = Matrix3::identity() - outward * outward.transpose() - axis * axis.transpose();
        let bend = cosine / radius;
        Level {
            value: (radius - self.base_radius() + taper * height) * cosine,
            gradient: (outward + axis * taper) * cosine,
            hessian: if bend.is_number() { flat * bend } else { Matrix3::zeros() },
        }
    }

    fn extent(&self) -> Extent<T> {
        let (centre, radius) = self.bounds();
        Extent { centre, radius }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        let level = self.level(point);
        Face::of(&self.axis(), &level, &self.normal(point)).shape_operator(&level)
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        let level = self.level(point);
        Face::of(&self.axis(), &level, normal).bend(&level, tangents)
    }

    /// On the rim of the nearer end.
    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        let axis = self.axis();
        let from_base = point - self.base_centre();
        let height = from_base.dot(&axis);
        let upper = height > self.height() * T::literal(0.5);
        let radius = if upper { self.top_radius() } else { self.base_radius() };
        if radius.is_zero() {
            return Some(Corner::Tip);
        }
        let outward = unit_or(&(from_base - axis * height), || any_perpendicular(&axis));
        Some(Corner::Edge { direction: axis.cross(&outward), bend: normal.dot(&outward) / radius })
    }
}

stored! {
    Frustum<T>, [T: Real],
    |frustum| {
        #[serde(default = "Vector3::zeros")]
        base_centre_m: Vector3<T> = frustum.axis.origin,
        #[serde(default = "Vector3::z")] axis: Vector3<T> = frustum.axis.direction,
        height_m: T = frustum.height,
        base_radius_m: T = frustum.base_radius,
        top_radius_m: T = frustum.top_radius,
    },
    Frustum::new(
        base_centre_m,
        axis,
        base_radius_m,
        top_radius_m,
        height_m,
    )
}
