//! The cone or truncated cone, closed at its ends.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::axis::Axis;
use crate::numeric::closest::to_convex;
use crate::numeric::interval::{End, Inside};
use crate::numeric::quadratic::roots;
use crate::numeric::vectors::{foot, hypotenuse};
use crate::serde_parts::serde_parts;
use crate::{ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, SignedDistance};

/// A truncated circular cone with flat ends, all of it active; with one radius zero, a closed
/// cone; with equal radii, a closed cylinder.
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
}

impl<T: Real> Frustum<T> {
    /// From the centre of the base \[m\], an axis of any length towards the top, the height, and
    /// the radii of base and top \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless the centre is finite, the axis has a direction, the height is a
    /// positive finite length, and so are the radii, of which one may be zero.
    pub fn new(
        base_centre: Vector3<T>,
        axis: Vector3<T>,
        height: T,
        base_radius: T,
        top_radius: T,
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
        Ok(Self {
            axis: Axis {
                origin: BadShape::check_point(shape, "base centre", base_centre)?,
                direction: BadShape::check_direction(shape, "axis", axis)?,
            },
            height,
            base_radius,
            top_radius,
            taper,
            side_cosine: T::one() / hypotenuse(T::one(), taper),
        })
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

    /// By how much the radius shrinks per height.
    #[inline]
    pub(crate) const fn taper(&self) -> T {
        self.taper
    }

    /// Cosine of the angle between the side and the axis.
    #[inline]
    pub(crate) const fn side_cosine(&self) -> T {
        self.side_cosine
    }

    #[inline]
    fn side_normal(&self, across: &Vector3<T>) -> Vector3<T> {
        (self.axis.outward(across) + self.axis.direction * self.taper) * self.side_cosine
    }

    /// The part of a line inside the infinite cone, `start` being its point with position zero.
    #[inline]
    fn inside_cone(&self, line: &Line<T>, start: &Vector3<T>) -> Option<Inside<T>> {
        let (height, across) = self.axis.split_point(start);
        let (rise, drift) = self.axis.split_direction(line);
        let radius = self.base_radius - self.taper * height;
        let shrink = self.taper * rise;
        // |across + t·drift|² − (radius − t·shrink)², negative inside. Adding zero makes −0 to 0.
        let (drift_length, across_length) = (drift.norm_squared().root(), across.norm_squared().root());
        let a = (drift_length - shrink.abs()) * (drift_length + shrink.abs()) + T::zero();
        let b = across.dot(&drift) + radius * shrink;
        let c = (across_length - radius.abs()) * (across_length + radius.abs());
        let far = T::GREATEST;
        let [first, second] = match roots(a, b, c) {
            // Along the axis of a cylinder.
            _ if a == T::zero() && b == T::zero() => {
                if !(c <= T::zero()) {
                    return None;
                }
                [-far, far]
            }
            Some(ends) => ends,
            // Steeper than the side, a line always meets the cone: at the apex, here.
            None if a < T::zero() => [-b / a, -b / a],
            None => return None,
        };
        let (entry, exit) = if a >= T::zero() {
            (first, second)
        } else if shrink < T::zero() {
            (second, far)
        } else {
            (-far, first)
        };
        let (entry, exit) = (entry.max(-far), exit.min(far));
        // Of the two cones that meet at the apex, the right one.
        let witness = if entry > -far { entry } else { exit };
        if !(radius - witness * shrink >= -self.base_radius.max(self.top_radius) * T::EPSILON.root()) {
            return None;
        }
        let end = |along: T| End { along, normal: self.side_normal(&(across + drift * along)), active: true };
        Some(Inside { entry: end(entry), exit: end(exit) })
    }
}

impl<T: Real> ActiveSurface<T> for Frustum<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>)) {
        let middle = self.axis.origin + self.axis.direction * (self.height * T::literal(0.5));
        let (from_middle, along) = foot(line, &middle);
        let start = middle + from_middle;
        let axis = self.axis.direction;
        let slope = line.direction.dot(&axis);
        let height = (start - self.axis.origin).dot(&axis);
        let inside = self
            .inside_cone(line, &start)
            .and_then(|inside| inside.below(self.height, height, slope, axis, true))
            .and_then(|inside| inside.below(T::zero(), -height, -slope, -axis, true));
        if let Some(inside) = inside {
            inside.report(line, &start, along, visit);
        }
    }

    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T> {
        let (centre, reach) = self.bounds();
        to_convex(line, &centre, reach, |point| self.signed_distance(point))
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
        let half = self.height * T::literal(0.5);
        let centre = self.axis.origin + self.axis.direction * half;
        (centre, hypotenuse(half, self.base_radius.max(self.top_radius)))
    }
}

serde_parts!(Frustum {
    #[serde(default = "Vector3::zeros")]
    base_centre_m: Vector3<T> = |frustum: &Frustum<T>| frustum.axis.origin,
    #[serde(default = "Vector3::z")] axis: Vector3<T> = |frustum: &Frustum<T>| frustum.axis.direction,
    height_m: T = |frustum: &Frustum<T>| frustum.height,
    base_radius_m: T = |frustum: &Frustum<T>| frustum.base_radius,
    top_radius_m: T = |frustum: &Frustum<T>| frustum.top_radius,
} => |parts| Frustum::new(
    parts.base_centre_m,
    parts.axis,
    parts.height_m,
    parts.base_radius_m,
    parts.top_radius_m,
));
