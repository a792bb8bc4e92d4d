//! The cylinder with round ends.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::axis::Axis;
use crate::numeric::closest::to_convex;
use crate::numeric::vectors::{foot, length, unit_or};
use crate::serde_parts::serde_parts;
use crate::{ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, SignedDistance};

/// All points at one distance from a straight segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule<T: Real> {
    /// From the middle along the segment.
    axis: Axis<T>,
    half_length: T,
    radius: T,
    curvature: T,
}

impl<T: Real> Capsule<T> {
    /// Around the segment of length `2·half_length` \[m\] along `axis` (of any length) about
    /// `centre` \[m\], at a distance `radius` \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless the centre is finite, the axis has a direction and the two lengths are
    /// positive finite lengths.
    pub fn new(centre: Vector3<T>, axis: Vector3<T>, half_length: T, radius: T) -> Result<Self, BadShape> {
        let radius = BadShape::check_length("capsule", "radius", radius)?;
        Ok(Self {
            axis: Axis {
                origin: BadShape::check_point("capsule", "centre", centre)?,
                direction: BadShape::check_direction("capsule", "axis", axis)?,
            },
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

    /// The vector to a point from the point of the segment closest to it.
    #[inline]
    fn off_segment(&self, from_centre: &Vector3<T>) -> Vector3<T> {
        let height = from_centre.dot(&self.axis.direction);
        from_centre - self.axis.direction * height.max(-self.half_length).min(self.half_length)
    }

    /// Where the line enters (`side` −1) or leaves (+1) the solid: on the side between the ends,
    /// or else on the ball at the end beyond which it does so.
    #[inline]
    fn end(&self, line: &Line<T>, start: &Vector3<T>, side: T) -> Option<(T, Vector3<T>)> {
        let (height, across) = self.axis.split(start);
        let (rise, drift) = self.axis.split_direction(line);
        let (across, squared) = (across * self.curvature, drift.norm_squared());
        let mut end = -rise * side;
        if squared > T::EPSILON * T::EPSILON * T::literal(16.0) {
            let foot = -across.dot(&drift) / squared;
            let radial = across + drift * foot;
            let remainder = T::one() - radial.norm_squared();
            if !(remainder >= T::zero()) {
                return None;
            }
            let half_chord = (remainder / squared).root() * side;
            let along = (foot + half_chord) * self.radius;
            let beyond = height + along * rise;
            if beyond.abs() <= self.half_length {
                return Some((along, radial + drift * half_chord));
            }
            end = beyond;
        } else {
            // Parallel to the axis: in at one end, out at the other.
            end = -end;
        }
        let tip = self.axis.direction * self.half_length.copysign(end);
        let from_tip = start - tip;
        let along = -from_tip.dot(&line.direction);
        let radial = (from_tip + line.direction * along) * self.curvature;
        let remainder = T::one() - radial.norm_squared();
        // Where side and ball meet, rounding may find a line outside both: a hair's breadth.
        if !(remainder >= -T::EPSILON * T::literal(16.0)) {
            return None;
        }
        let half_chord = remainder.max(T::zero()).root() * side;
        Some((along + half_chord * self.radius, radial + line.direction * half_chord))
    }
}

impl<T: Real> ActiveSurface<T> for Capsule<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let (start, along) = foot(line, &self.axis.origin);
        let (Some(entry), Some(exit)) = (self.end(line, &start, -T::one()), self.end(line, &start, T::one()))
        else {
            return;
        };
        for (t, normal) in [entry, exit] {
            visit(Crossing {
                along: along + t,
                point: self.axis.origin + start + line.direction * t,
                normal,
                active: true,
            });
        }
    }

    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T> {
        let (centre, reach) = self.bounds();
        to_convex(line, &centre, reach, |point| self.signed_distance(point))
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        let outward = self.off_segment(&(point - self.axis.origin));
        unit_or(&outward, || self.axis.outward(&Vector3::zeros()))
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        length(&self.off_segment(&(point - self.axis.origin))) < self.radius
    }
}

impl<T: Real> SignedDistance<T> for Capsule<T> {
    const CONVEX: bool = true;

    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T> {
        let outward = self.off_segment(&(point - self.axis.origin));
        Distance { distance: length(&outward) - self.radius, normal: self.normal(point) }
    }

    fn bounds(&self) -> (Vector3<T>, T) {
        (self.axis.origin, self.half_length + self.radius)
    }
}

serde_parts!(Capsule {
    #[serde(default = "Vector3::zeros")] centre_m: Vector3<T> = |capsule: &Capsule<T>| capsule.axis.origin,
    #[serde(default = "Vector3::z")] axis: Vector3<T> = |capsule: &Capsule<T>| capsule.axis.direction,
    half_length_m: T = |capsule: &Capsule<T>| capsule.half_length,
    radius_m: T = |capsule: &Capsule<T>| capsule.radius,
} => |parts| Capsule::new(parts.centre_m, parts.axis, parts.half_length_m, parts.radius_m));
