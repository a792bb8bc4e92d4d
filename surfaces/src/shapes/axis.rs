//! What shapes around an axis share.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

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

    /// The line's unit direction, split.
    #[inline]
    pub(super) fn split_direction(&self, line: &Line<T>) -> (T, Vector3<T>) {
        self.split(&line.direction)
    }
}
