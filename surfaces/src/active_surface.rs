//! What a shape must be able to tell.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;
use thiserror::Error;

/// Where a line passes through a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing<T: Real> {
    /// Signed distance from the line's point, along its direction \[m\].
    pub along: T,
    /// The point itself \[m\].
    pub point: Vector3<T>,
    /// Outward unit normal there.
    pub normal: Vector3<T>,
    /// `false` where the point belongs to the shape but not to the part that may touch: beyond
    /// the rim of a disk, past the end of an open cylinder.
    pub active: bool,
}

/// The point of a surface closest to a line that misses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestApproach<T: Real> {
    /// Distance between line and surface \[m\]; zero or more.
    pub gap: T,
    /// The closest point of the surface \[m\].
    pub point: Vector3<T>,
    /// Outward unit normal there.
    pub normal: Vector3<T>,
    /// `false` where the point is not part of the active region.
    pub active: bool,
}

/// The part of the fingertip that may touch: a surface with an outside.
///
/// # For users
/// Coordinates are those of the sensor frame \[m\]. All calls are total: they return no NaN for a
/// finite line with unit direction.
///
/// # For implementers
/// Three methods, each short for most shapes:
///
/// * [`crossings`](Self::crossings) shall report *every* point where the line passes through the
///   surface, in any order, those outside the active region too (marked `active: false`). A
///   tangent line may report its point of tangency once, twice or not at all.
/// * [`closest_approach`](Self::closest_approach) is asked only for lines that `crossings`
///   reported nothing for, but shall answer sensibly for any.
/// * [`normal`](Self::normal) is the outward unit normal at a point on (or within rounding of) the
///   surface.
pub trait ActiveSurface<T: Real> {
    /// Calls `visit` for every point where the line passes through the surface.
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>));

    /// The point of the surface closest to a line that misses it.
    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T>;

    /// The outward unit normal at a point of the surface.
    fn normal(&self, point: &Vector3<T>) -> Vector3<T>;
}

impl<T: Real, S: ActiveSurface<T>> ActiveSurface<T> for &S {
    #[inline]
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>)) {
        (**self).crossings(line, visit);
    }

    #[inline]
    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T> {
        (**self).closest_approach(line)
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        (**self).normal(point)
    }
}

/// A parameter of a shape is out of range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the {parameter} of a {shape} must be {requirement}")]
pub struct BadShape {
    /// Which shape.
    pub shape: &'static str,
    /// Which parameter.
    pub parameter: &'static str,
    /// What it must be.
    pub requirement: &'static str,
}

impl BadShape {
    /// `value`, if it is a length: positive, finite, and with a reciprocal that is finite too.
    pub(crate) fn check_length<T: Real>(
        shape: &'static str,
        parameter: &'static str,
        value: T,
    ) -> Result<T, Self> {
        if value >= T::LEAST_NORMAL && value <= T::one() / T::LEAST_NORMAL {
            Ok(value)
        } else {
            Err(Self { shape, parameter, requirement: "a positive finite length" })
        }
    }

    /// `point`, if it is finite.
    pub(crate) fn check_point<T: Real>(
        shape: &'static str,
        parameter: &'static str,
        point: Vector3<T>,
    ) -> Result<Vector3<T>, Self> {
        if point.iter().all(|x| x.is_number()) {
            Ok(point)
        } else {
            Err(Self { shape, parameter, requirement: "finite" })
        }
    }

    /// The unit vector along `direction`, if it has a direction.
    pub(crate) fn check_direction<T: Real>(
        shape: &'static str,
        parameter: &'static str,
        direction: Vector3<T>,
    ) -> Result<Vector3<T>, Self> {
        let scaled = direction * direction.amax().normalising_factor();
        let squared = scaled.norm_squared();
        if squared > T::zero() && squared.is_number() {
            Ok(scaled / squared.root())
        } else {
            Err(Self { shape, parameter, requirement: "finite and not zero" })
        }
    }
}
