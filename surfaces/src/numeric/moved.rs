//! Points and directions moved by a pose, out of line: for code that few samples take, such that a microcontroller holds
//! it once. Inlined, each takes a hundred bytes.

use fingertip_wrench::{Real, RigidTransform};
use nalgebra::Vector3;

/// A direction of the sensor frame, in the frame of a shape.
#[inline(never)]
pub fn direction_inside<T: Real>(pose: &RigidTransform<T>, direction: &Vector3<T>) -> Vector3<T> {
    pose.rotation().tr_mul(direction)
}

/// A point of the sensor frame, in the frame of a shape \[m\].
#[inline(never)]
pub fn point_inside<T: Real>(pose: &RigidTransform<T>, point: &Vector3<T>) -> Vector3<T> {
    direction_inside(pose, &(point - pose.origin()))
}

/// A direction of the frame of a shape, in the sensor frame.
#[inline(never)]
pub fn direction_outside<T: Real>(pose: &RigidTransform<T>, direction: &Vector3<T>) -> Vector3<T> {
    pose.rotate(direction)
}

/// A point of the frame of a shape, in the sensor frame \[m\].
#[inline(never)]
pub fn point_outside<T: Real>(pose: &RigidTransform<T>, point: &Vector3<T>) -> Vector3<T> {
    direction_outside(pose, point) + pose.origin()
}
