//! Why a shape cannot be made.

use fingertip_wrench::Real;
use nalgebra::Vector3;
use thiserror::Error;

use crate::numeric::vectors::{is_finite, unit_or};

/// A parameter of a shape is out of range.
///
/// ```
/// use fingertip_surfaces::Sphere;
///
/// let refused = Sphere::<f64>::centred(-0.013).unwrap_err();
/// assert_eq!(refused.parameter, "radius");
/// assert_eq!(refused.to_string(), "the radius of a sphere must be a positive finite length");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the {parameter} of {} {shape} must be {requirement}", article(shape))]
pub struct BadShape {
    /// Which shape.
    pub shape: &'static str,
    /// Which parameter.
    pub parameter: &'static str,
    /// What it must be.
    pub requirement: &'static str,
}

/// What stands before the name of a shape.
fn article(shape: &str) -> &'static str {
    if shape.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" }
}

impl BadShape {
    /// `value`, if it is a length: positive, finite, and with a reciprocal that is finite too.
    pub fn check_length<T: Real>(shape: &'static str, parameter: &'static str, value: T) -> Result<T, Self> {
        if value >= T::LEAST_NORMAL && value <= T::one() / T::LEAST_NORMAL {
            Ok(value)
        } else {
            Err(Self { shape, parameter, requirement: "a positive finite length" })
        }
    }

    /// Nothing, if `condition` holds.
    pub fn check(
        shape: &'static str,
        parameter: &'static str,
        requirement: &'static str,
        condition: bool,
    ) -> Result<(), Self> {
        if condition { Ok(()) } else { Err(Self { shape, parameter, requirement }) }
    }

    /// `point`, if it is finite.
    pub fn check_point<T: Real>(
        shape: &'static str,
        parameter: &'static str,
        point: Vector3<T>,
    ) -> Result<Vector3<T>, Self> {
        Self::check(shape, parameter, "finite", is_finite(&point)).map(|()| point)
    }

    /// The unit vector along `direction`, if it has a direction.
    pub fn check_direction<T: Real>(
        shape: &'static str,
        parameter: &'static str,
        direction: Vector3<T>,
    ) -> Result<Vector3<T>, Self> {
        let unit = unit_or(&direction, Vector3::zeros);
        Self::check(shape, parameter, "finite and not zero", unit.amax() > T::zero()).map(|()| unit)
    }
}
