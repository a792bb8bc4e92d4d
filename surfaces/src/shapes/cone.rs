//! The cone, open at its wide end.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix3, Vector3};

use super::axis::{Axis, Local, LocalEntry};
use crate::numeric::closest::to_convex;
use crate::numeric::twofold::Twofold;
use crate::numeric::vectors::{any_perpendicular, foot, is_finite, length, unit_or, wide};
#[cfg(feature = "serde")]
use crate::numeric::vectors::{from_degrees, to_degrees};
use crate::shortcuts::{LineInDouble, entry_near};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Corner, Crossing, Distance, Entry, Extent, ForceLine, Level,
    Shortcuts, SmoothSurface, Topology,
};

/// The side of a circular cone, unbounded or active down to a depth.
///
/// ```
/// use core::f64::consts::FRAC_PI_6;
/// use fingertip_surfaces::{ActiveSurface, Cone};
/// use nalgebra::Vector3;
///
/// // A point upwards, whose side falls 30° beside the axis, down to 20 mm.
/// let tip = Cone::new(Vector3::zeros(), -Vector3::z(), FRAC_PI_6)?.with_depth(0.02)?;
/// // At a depth of 10 mm it is 10 mm · tan 30° wide; the normal points outward and up.
/// let rim = 0.01 * FRAC_PI_6.tan();
/// let normal = tip.normal(&Vector3::new(rim, 0.0, -0.01));
/// assert!((normal - Vector3::new(FRAC_PI_6.cos(), 0.0, FRAC_PI_6.sin())).amax() < 1e-15);
/// assert_eq!(tip.depth(), Some(0.02));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<T: Real> {
    /// From the apex into the cone.
    axis: Axis<T>,
    half_angle: T,
    sine: T,
    cosine: T,
    tangent: T,
    /// What rounding took from the tangent, for a type narrower than `f64`.
    tangent_rest: T,
    depth: Option<T>,
    /// A hair across the axis.
    least_across: Vector3<T>,
}

impl<T: Real> Cone<T> {
    /// From its apex \[m\], an axis of any length pointing into the cone, and the angle between
    /// axis and side \[rad\].
    ///
    /// # Errors
    /// [`BadShape`] unless the apex is finite, the axis has a direction and the half angle lies
    /// between 0 and π/2, by more than `√ε`.
    pub fn new(apex: Vector3<T>, axis: Vector3<T>, half_angle: T) -> Result<Self, BadShape> {
        let (sine, cosine) = (half_angle.sine(), half_angle.cosine());
        let least = T::EPSILON.root();
        BadShape::check(
            "cone",
            "half angle",
            "between 0 and a right angle",
            half_angle > T::zero() && half_angle < T::frac_pi_2() && sine >= least && cosine >= least,
        )?;
        let tangent = sine / cosine;
        let exact = Real::tangent(half_angle.to_f64());
        let axis = Axis::new(
            BadShape::check_point("cone", "apex", apex)?,
            BadShape::check_direction("cone", "axis", axis)?,
        );
        Ok(Self {
            axis,
            least_across: axis.least_across(),
            tangent_rest: T::literal(exact - tangent.to_f64()),
            half_angle,
            sine,
            cosine,
            tangent,
            depth: None,
        })
    }

    /// Only the part down to `depth` \[m\] from the apex, along the axis, is active.
    ///
    /// # Errors
    /// [`BadShape`] unless it is a positive finite length.
    pub fn with_depth(self, depth: T) -> Result<Self, BadShape> {
        Ok(Self { depth: Some(BadShape::check_length("cone", "depth", depth)?), ..self })
    }

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<Cone<f64>> {
        let double = Cone::new(wide(&self.apex()), wide(&self.axis()), self.half_angle.to_f64()).ok()?;
        self.depth.map_or(Some(double), |depth| double.with_depth(depth.to_f64()).ok())
    }

    /// Apex \[m\].
    #[inline]
    #[must_use]
    pub const fn apex(&self) -> Vector3<T> {
        self.axis.origin
    }

    /// Unit vector along the axis, into the cone.
    #[inline]
    #[must_use]
    pub const fn axis(&self) -> Vector3<T> {
        self.axis.direction
    }

    /// Angle between axis and side \[rad\].
    #[inline]
    #[must_use]
    pub const fn half_angle(&self) -> T {
        self.half_angle
    }

    /// Sine and cosine of that angle.
    #[inline]
    #[must_use]
    pub const fn half_angle_sin_cos(&self) -> (T, T) {
        (self.sine, self.cosine)
    }

    /// How far down from the apex, along the axis, the side is active \[m\]; `None` if it is unbounded.
    #[inline]
    #[must_use]
    pub const fn depth(&self) -> Option<T> {
        self.depth
    }

    #[inline]
    fn is_active(&self, height: T) -> bool {
        self.depth.is_none_or(|depth| height <= depth)
    }

    #[inline]
    fn side_normal(&self, across: &Vector3<T>) -> Vector3<T> {
        self.axis.outward(across) * self.cosine - self.axis.direction * self.sine
    }

    /// The solid is convex; its distance is that of the side, or of the apex for points above it.
    fn distance(&self, point: &Vector3<T>) -> Distance<T> {
        let from_apex = point - self.axis.origin;
        let (height, across) = self.axis.split(&from_apex);
        let outward = self.axis.outward(&across);
        let radius = across.dot(&outward).abs();
        let normal = self.side_normal(&across);
        if radius * self.sine + height * self.cosine >= T::zero() {
            return Distance { distance: radius * self.cosine - height * self.sine, normal };
        }
        let distance = length(&from_apex);
        Distance { distance, normal: if distance > T::zero() { from_apex / distance } else { normal } }
    }

    /// Where a line enters, seen from the apex.
    #[inline(always)]
    fn entry(&self, line: &Local<T>) -> LocalEntry<T> {
        let [to_side, over] = line.enters_cone(line.height * self.tangent, -line.rise * self.tangent);
        let along = to_side / over;
        let height = line.height + along * line.rise;
        let across = line.across_at(along) + self.least_across;
        LocalEntry {
            // Of the two cones that meet at the apex, the right one.
            enters: height >= T::zero() && along.abs() < T::GREATEST,
            along,
            height,
            normal: self.axis.slanted(&across, self.cosine, -self.sine),
        }
    }
}

impl<T: Real> ActiveSurface<T> for Cone<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let apex = self.axis.origin;
        let local = self.axis.localise(line, &apex);
        self.axis.both_ends::<false>(
            &local,
            &apex,
            |line| self.entry(line),
            |entry, crossing| visit(Crossing { active: self.is_active(entry.height), ..crossing }),
        );
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let (from_apex, _) = foot(line, &self.axis.origin);
        let distance = length(&from_apex);
        let reach = if is_finite(&from_apex) && distance > T::zero() { distance } else { T::one() };
        let far = reach * T::literal(f64::from(1 << 20));
        let approach = to_convex(line, &self.axis.origin, far.min(T::GREATEST.root()), |p| self.distance(p));
        let depth = self.axis.split_point(&approach.point).0;
        Some(ClosestApproach { active: self.is_active(depth), ..approach })
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.side_normal(&self.axis.split_point(point).1)
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        let (height, across) = self.axis.split_point(point);
        self.is_active(height) && length(&across) * self.cosine < height * self.sine
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Cone<T> {
    #[inline(always)]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        let apex = self.axis.origin;
        let local = self.axis.localise_push(push, &apex);
        let entry = self.entry(&local);
        Some(self.axis.entered(&local, &apex, &entry, self.is_active(entry.height)))
    }

    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let taper = Twofold::difference(-self.tangent, self.tangent_rest);
        self.axis.outside_cone_by(point, T::zero(), taper, self.cosine)
    }

    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        entry_near(&self.in_double()?, line, near)
    }
}

/// The extent of a cone is a ball of one metre around its apex.
impl<T: Real> SmoothSurface<T> for Cone<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let axis = self.axis();
        let (sine, cosine) = (self.sine, self.cosine);
        let from_apex = point - self.apex();
        let height = from_apex.dot(&axis);
        let across = from_apex - axis * height;
        let radius = length(&across);
        let outward = unit_or(&across, || any_perpendicular(&axis));
        let flat = Matrix3::identity() - outward * outward.transpose() - axis * axis.transpose();
        let bend = cosine / radius;
        Level {
            value: radius * cosine - height * sine,
            gradient: outward * cosine - axis * sine,
            hessian: if bend.is_number() { flat * bend } else { Matrix3::zeros() },
        }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.apex(), radius: T::one() }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn corner(&self, _point: &Vector3<T>, _normal: &Vector3<T>) -> Option<Corner<T>> {
        Some(Corner::Tip)
    }
}

stored! {
    Cone<T>, [T: Real],
    |cone| {
        #[serde(default = "Vector3::zeros")] apex_m: Vector3<T> = cone.axis.origin,
        #[serde(default = "Vector3::z")] axis: Vector3<T> = cone.axis.direction,
        half_angle_deg: T = to_degrees(cone.half_angle),
        #[serde(default, skip_serializing_if = "Option::is_none")]
        depth_m: Option<T> = cone.depth,
    },
    Cone::new(apex_m, axis, from_degrees(half_angle_deg))
        .and_then(|cone| depth_m.map_or(Ok(cone), |depth| cone.with_depth(depth)))
}
