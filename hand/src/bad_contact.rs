//! What the constructors of this crate say of what they cannot use.

use thiserror::Error;

/// Why numbers are not a contact of a grasp.
///
/// ```
/// use fingertip_hand::GraspContact;
/// use nalgebra::Vector3;
///
/// let error = GraspContact::<f64>::point(Vector3::zeros(), Vector3::zeros(), 0.5).unwrap_err();
/// assert_eq!(error.to_string(), "the point or normal of the contact is zero or not finite");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadContact {
    /// The point or the normal is no place and no direction.
    #[error("the point or normal of the contact is zero or not finite")]
    BadPlace,
    /// The friction coefficient is not positive and finite.
    #[error("the friction coefficient of the contact must be positive and finite")]
    BadFriction,
    /// The torque arm is not positive and finite.
    #[error("the torque arm of the contact must be positive and finite")]
    BadArm,
    /// The factor of safety is below 1 or not finite.
    #[error("the factor of safety of the contact must be at least 1 and finite")]
    BadSafety,
    /// Friction is so uncertain that it may be none.
    #[error("the friction coefficient may be zero with the probability that was given")]
    NoFriction,
}

/// Why a limit of a finger is none.
///
/// ```
/// use fingertip_hand::FingerLimits;
///
/// let error = FingerLimits::<f64, 1>::none().with_greatest_normal(-1.0).unwrap_err();
/// assert_eq!(error.to_string(), "the greatest normal force must be positive and finite");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadLimit {
    /// A number is out of range.
    #[error("the {parameter} must be {requirement}")]
    BadNumber {
        /// Which number.
        parameter: &'static str,
        /// What it must be.
        requirement: &'static str,
    },
    /// There are more limits than the type has room for.
    #[error("the limits of a finger need {needed} rows, and its type has {room}")]
    NoRoom {
        /// How many rows there are.
        room: usize,
        /// How many the limits need: one for a normal force, two for a joint.
        needed: usize,
    },
}
