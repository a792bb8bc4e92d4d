//! Why a simulation cannot run.

use fingertip_wrench::gauge_layout::LayoutError;
use thiserror::Error;

/// Why a simulated fingertip cannot be made.
///
/// ```
/// use fingertip_simulation::{Options, Script, SimulatedFingertip};
///
/// let refused = SimulatedFingertip::new(&Script::default().hold(0.1), Options::default()).unwrap_err();
/// assert_eq!(refused.to_string(), "segment 1 of the script: nothing touches here; press first");
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// A parameter is out of range.
    #[error("the {parameter} of the simulation must be {requirement}")]
    BadParameter {
        /// Which parameter.
        parameter: &'static str,
        /// What it must be.
        requirement: &'static str,
    },
    /// A segment of the script cannot be played.
    #[error("segment {segment} of the script: {problem}")]
    Script {
        /// Number of the segment, from 1.
        segment: usize,
        /// What is wrong.
        problem: ScriptProblem,
    },
    /// A contact of a hand or what it grips with is out of range.
    #[cfg(feature = "hand")]
    #[error("in the simulated hand, {reason}")]
    Hand {
        /// What is wrong, as a sentence that names the parameter.
        reason: String,
    },
    /// The beam or its gauges make no sensor.
    #[error(transparent)]
    Layout(#[from] LayoutError),
}

/// What is wrong with a segment.
///
/// ```
/// use fingertip_simulation::{Options, Script, ScriptProblem, SimulatedFingertip, SimulationError, SurfacePoint};
///
/// let script = Script::default().press(SurfacePoint::degrees(170.0, 0.0), 1.0, 0.1);
/// let refused = SimulatedFingertip::new(&script, Options::default()).unwrap_err();
/// let problem = ScriptProblem::NotOnActiveSurface;
/// assert_eq!(refused, SimulationError::Script { segment: 1, problem });
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ScriptProblem {
    /// A duration is zero, negative or not finite.
    #[error("a duration must be positive and finite")]
    BadDuration,
    /// A force is negative or not finite.
    #[error("the force must be positive and finite")]
    BadForce,
    /// An angle is not finite.
    #[error("an angle is not finite")]
    BadAngle,
    /// Friction coefficients are not `0 < kinetic ≤ static`.
    #[error("the friction coefficients must be positive, the kinetic one not above the static one")]
    BadFriction,
    /// A point lies on the opening, where the sphere is cut away for the beam.
    #[error("the point lies on the opening of the sphere, not on its active surface")]
    NotOnActiveSurface,
    /// Nothing touches.
    #[error("nothing touches here; press first")]
    NotInContact,
    /// A motion of a hand is not finite.
    #[error("the motion of the hand must be finite")]
    BadMotion,
    /// What is poured is no mass, or its place is not finite.
    #[error("the mass that is poured in must be positive and finite, and its place finite")]
    BadMass,
    /// A push is not finite.
    #[error("the force of a push and its place must be finite")]
    BadPush,
    /// Something touches already.
    #[error("something touches already; release first")]
    AlreadyInContact,
}

/// Passes a positive finite parameter.
pub(super) fn positive(value: f64, parameter: &'static str) -> Result<f64, SimulationError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(SimulationError::BadParameter { parameter, requirement: "positive and finite" })
    }
}

/// Passes a finite parameter that is not negative.
pub(super) fn not_negative(value: f64, parameter: &'static str) -> Result<f64, SimulationError> {
    if value >= 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(SimulationError::BadParameter { parameter, requirement: "finite and not negative" })
    }
}
