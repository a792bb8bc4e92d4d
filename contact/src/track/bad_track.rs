//! Why what follows a contact cannot be made.

use fingertip_wrench::Real;
use thiserror::Error;

/// A setting of what follows a contact over time is out of range.
///
/// ```
/// use fingertip_contact::Tracker;
///
/// let error = Tracker::<f64>::new(-0.01, 0.1).unwrap_err();
/// assert_eq!(error.to_string(), "the speed of a tracker must be positive and finite");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the {parameter} of {what} must be {requirement}")]
pub struct BadTrack {
    /// What was to be made.
    pub what: &'static str,
    /// Which setting.
    pub parameter: &'static str,
    /// What it must be.
    pub requirement: &'static str,
}

impl BadTrack {
    /// Nothing, if `good` holds.
    pub(super) fn check(
        what: &'static str,
        parameter: &'static str,
        requirement: &'static str,
        good: bool,
    ) -> Result<(), Self> {
        if good { Ok(()) } else { Err(Self { what, parameter, requirement }) }
    }
}

/// Whether the square of a length, and its reciprocal, are in the range of the type.
pub(super) fn is_ordinary<T: Real>(length: T) -> bool {
    let square = length * length;
    square >= T::LEAST_NORMAL && square <= T::one() / T::LEAST_NORMAL
}
