//! What shapes around an axis share.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::numeric::twofold::{Twofold, difference, dot};
use crate::numeric::vectors::{any_perpendicular, unit_or};

/// An oriented axis with an origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis<T: Real> {
    pub(super) origin: Vector3<T>,
    pub(super) direction: Vector3<T>,
}

impl<T: Real> Axis<T> {
    /// Height of a vector along the axis, and its part across.
    #[inline]
    pub(super) fn split(&self, v: &Vector3<T>) -> (T, Vector3<T>) {
        let height = v.dot(&self.direction);
        let across = v - self.direction * height;
        // Once more, so that what is left is across even where most has cancelled.
        (height, across - self.direction * across.dot(&self.direction))
    }

    /// As [`split`](Self::split), for a point of the sensor frame.
    #[inline]
    pub(super) fn split_point(&self, point: &Vector3<T>) -> (T, Vector3<T>) {
        self.split(&(point - self.origin))
    }

    /// The unit vector away from the axis; any across it for a point on the axis.
    #[inline]
    pub(super) fn outward(&self, across: &Vector3<T>) -> Vector3<T> {
        unit_or(across, || any_perpendicular(&self.direction))
    }

    /// How far a point is outside the circular cylinder around the axis, with twice the digits.
    pub(super) fn outside_by(&self, point: &Vector3<T>, radius: T) -> T {
        let scale = radius.normalising_factor();
        let radius = radius * scale;
        let from_origin = difference(&(point * scale), &(self.origin * scale));
        // The axis is a unit vector but for rounding: h²/|a|² = h²·(2 − |a|²).
        let axis = [self.direction.x, self.direction.y, self.direction.z].map(Twofold::new);
        let short = Twofold::new(T::literal(2.0)).minus(dot(axis, axis));
        let along = dot(from_origin, axis).squared().times(short);
        let excess = dot(from_origin, from_origin).minus(along).minus(Twofold::new(radius).squared());
        excess.value() / (radius + radius) / scale
    }

    /// The line's unit direction, split.
    #[inline]
    pub(super) fn split_direction(&self, line: &Line<T>) -> (T, Vector3<T>) {
        self.split(&line.direction)
    }
}
