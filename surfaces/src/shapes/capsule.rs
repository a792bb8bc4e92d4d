//! The cylinder with round ends.

use core::hint::select_unpredictable;

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix3, Vector3};

use super::axis::{Axis, Local, LocalEntry};
use crate::numeric::closest::to_convex;
use crate::numeric::vectors::{any_perpendicular, length, unit_or, wide};
use crate::shortcuts::{LineInDouble, entry_near};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, Entry, Extent, ForceLine, Level, Shortcuts,
    SignedDistance, SmoothSurface, Topology,
};

/// All points at one distance from a straight segment.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Capsule};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // A segment from −10 mm to 10 mm along z, and all within 5 mm of it.
/// let tip = Capsule::new(Vector3::zeros(), Vector3::z(), 0.005, 0.01)?;
/// let line = Line { point: Vector3::new(0.0, 0.0, 0.05), direction: -Vector3::z() };
/// let mut heights = Vec::new();
/// tip.crossings(&line, |crossing| heights.push(crossing.point.z));
/// assert!((heights[0] - 0.015_f64).abs() < 1e-15 && (heights[1] + 0.015).abs() < 1e-15);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule<T: Real> {
    /// From the middle along the segment.
    axis: Axis<T>,
    half_length: T,
    radius: T,
    curvature: T,
}

impl<T: Real> Capsule<T> {
    /// At a distance `radius` \[m\] around the segment of length `2·half_length` \[m\] along `axis`
    /// (of any length) about `centre` \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless the centre is finite, the axis has a direction and the two lengths are
    /// positive finite lengths.
    pub fn new(centre: Vector3<T>, axis: Vector3<T>, radius: T, half_length: T) -> Result<Self, BadShape> {
        let radius = BadShape::check_length("capsule", "radius", radius)?;
        Ok(Self {
            axis: Axis::new(
                BadShape::check_point("capsule", "centre", centre)?,
                BadShape::check_direction("capsule", "axis", axis)?,
            ),
            half_length: BadShape::check_length("capsule", "half length", half_length)?,
            radius,
            curvature: T::one() / radius,
        })
    }

    /// The middle \[m\].
    #[inline]
    #[must_use]
    pub const fn centre(&self) -> Vector3<T> {
        self.axis.origin
    }

    /// Unit vector along the segment.
    #[inline]
    #[must_use]
    pub const fn axis(&self) -> Vector3<T> {
        self.axis.direction
    }

    /// Half the length of the segment \[m\].
    #[inline]
    #[must_use]
    pub const fn half_length(&self) -> T {
        self.half_length
    }

    /// Radius \[m\].
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> T {
        self.radius
    }

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<Capsule<f64>> {
        let [radius, half] = [self.radius, self.half_length].map(Real::to_f64);
        Capsule::new(wide(&self.centre()), wide(&self.axis()), radius, half).ok()
    }

    /// Its side, going on for ever.
    #[doc(hidden)]
    #[must_use]
    pub fn without_ends(&self) -> Self {
        Self { half_length: T::GREATEST, ..*self }
    }

    /// The vector to a point from the point of the segment closest to it.
    #[inline]
    fn off_segment(&self, from_centre: &Vector3<T>) -> Vector3<T> {
        let height = from_centre.dot(&self.axis.direction);
        from_centre - self.axis.direction * height.max(-self.half_length).min(self.half_length)
    }

    /// Where a line enters, seen from the middle, all lengths in radii: where it enters the side's
    /// continuation tells which of the balls along the segment it enters first. (An error of that
    /// place moves the entry by its square only, and nothing has to branch on it.)
    #[inline(always)]
    fn entry(&self, line: &Local<T>) -> LocalEntry<T> {
        let (axis, u) = (self.axis.direction, line.direction);
        let half_length = self.half_length * self.curvature;
        // Parallel to the axis, it comes from far away.
        let squared = line.squared.max(T::LEAST_NORMAL);
        let aside = line.aside * self.curvature;
        let root = (squared - aside * aside).root();
        let to_side = -(line.meets * self.curvature + root) / squared;
        let z = line.height * self.curvature + to_side * line.rise;
        let height = z.min(half_length).max(-half_length);
        let over = line.height * self.curvature - height;
        let from_centre = line.across * self.curvature + axis * over;
        let foot = -from_centre.dot(&u);
        let radial = from_centre + u * foot;
        let remainder = T::one() - radial.norm_squared();
        // Where side and ball meet, rounding may find a line outside both: a hair's breadth.
        let meets = remainder >= -T::EPSILON * T::literal(16.0);
        // All but along the axis, the place is known so badly that the ball there may be missed. The chord is the side's, too.
        let on_side = (z.abs() <= half_length) & (remainder <= T::zero());
        let enters = (meets | on_side) & (root >= T::zero());
        let half_chord = select_unpredictable(on_side, root, remainder.max(T::zero()).root());
        let normal = radial - u * half_chord;
        let lift = over + (foot - half_chord) * line.rise;
        // The normal would keep the error of the place.
        let lean = select_unpredictable(z.abs() <= half_length, lift, T::zero());
        LocalEntry {
            enters,
            along: (foot - half_chord) * self.radius,
            height: T::zero(),
            normal: normal - axis * lean,
        }
    }
}

impl<T: Real> ActiveSurface<T> for Capsule<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let centre = self.axis.origin;
        let local = self.axis.localise(line, &centre);
        self.axis.both_ends::<true>(&local, &centre, |line| self.entry(line), |_, crossing| visit(crossing));
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let (centre, reach) = self.bounds();
        Some(to_convex(line, &centre, reach, |point| self.signed_distance(point)))
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        let outward = self.off_segment(&(point - self.axis.origin));
        // Without ends it is as exact as that of a cylinder: across the axis even where most has cancelled.
        let has_ends = self.half_length < T::GREATEST;
        let outward = if has_ends { outward } else { self.axis.part_across(&outward) };
        unit_or(&outward, || self.axis.outward(&Vector3::zeros()))
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        length(&self.off_segment(&(point - self.axis.origin))) < self.radius
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Capsule<T> {
    const CLOSED_CONVEX: bool = true;

    #[inline(always)]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        let centre = self.axis.origin;
        let local = self.axis.localise_push(push, &centre);
        Some(self.axis.entered(&local, &centre, &self.entry(&local), true))
    }

    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let height = (point - self.axis.origin).dot(&self.axis.direction);
        if height.abs() <= self.half_length {
            return self.axis.outside_by(point, self.radius);
        }
        let end = self.half_length.copysign(height);
        self.axis.outside_ball_by(point, end, self.radius)
    }

    fn posed_entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        entry_near(&self.in_double()?, line, near)
    }
}

impl<T: Real> SignedDistance<T> for Capsule<T> {
    const CONVEX: bool = true;

    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T> {
        let outward = self.off_segment(&(point - self.axis.origin));
        let normal = unit_or(&outward, || self.axis.outward(&Vector3::zeros()));
        Distance { distance: length(&outward) - self.radius, normal }
    }

    fn bounds(&self) -> (Vector3<T>, T) {
        (self.axis.origin, self.half_length + self.radius)
    }
}

impl<T: Real> SmoothSurface<T> for Capsule<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let axis = self.axis();
        let from_centre = point - self.centre();
        let height = from_centre.dot(&axis);
        let clamped = height.min(self.half_length()).max(-self.half_length());
        let across = from_centre - axis * clamped;
        let distance = length(&across);
        let normal = unit_or(&across, || any_perpendicular(&axis));
        let mut flat = Matrix3::identity() - normal * normal.transpose();
        if height.abs() < self.half_length() {
            flat -= axis * axis.transpose();
        }
        Level { value: distance - self.radius(), gradient: normal, hessian: flat / distance }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.centre(), radius: self.half_length() + self.radius() }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

stored! {
    Capsule<T>, [T: Real],
    |capsule| {
        #[serde(default = "Vector3::zeros")] centre_m: Vector3<T> = capsule.axis.origin,
        #[serde(default = "Vector3::z")] axis: Vector3<T> = capsule.axis.direction,
        half_length_m: T = capsule.half_length,
        radius_m: T = capsule.radius,
    },
    Capsule::new(centre_m, axis, radius_m, half_length_m)
}
