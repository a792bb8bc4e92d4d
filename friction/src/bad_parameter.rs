//! What a constructor says of a number that it cannot use.

use fingertip_wrench::Real;
use thiserror::Error;

/// A parameter is out of range.
///
/// ```
/// use fingertip_friction::Coulomb;
///
/// let error = Coulomb::new(-0.5).unwrap_err();
/// assert_eq!(error.to_string(), "the friction coefficient must be positive and finite");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the {parameter} must be {requirement}")]
pub struct BadParameter {
    /// Which parameter.
    pub parameter: &'static str,
    /// What it must be.
    pub requirement: &'static str,
}

/// The value if it is positive and finite.
pub(crate) fn positive<T: Real>(value: T, parameter: &'static str) -> Result<T, BadParameter> {
    if value > T::zero() && value.is_number() {
        Ok(value)
    } else {
        Err(BadParameter { parameter, requirement: "positive and finite" })
    }
}

/// The value if it is finite and not negative.
pub(crate) fn not_negative<T: Real>(value: T, parameter: &'static str) -> Result<T, BadParameter> {
    if value >= T::zero() && value.is_number() {
        Ok(value)
    } else {
        Err(BadParameter { parameter, requirement: "finite and not negative" })
    }
}
