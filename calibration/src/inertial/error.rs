//! What can be wrong with a motion.

use fingertip_wrench::BadInertialUnit;
use thiserror::Error;

/// Why a motion does not tell what the sensor carries.
///
/// ```
/// use fingertip_calibration::inertial::{InertialError, InertialOptions, fit_inertial};
///
/// // No motion at all.
/// let error = fit_inertial(&[], &InertialOptions::default()).unwrap_err();
/// assert!(matches!(error, InertialError::TooShort { .. }), "{error}");
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum InertialError {
    /// The inertial unit or the filter is none.
    #[error(transparent)]
    Unit(#[from] BadInertialUnit),
    /// An option is out of its range.
    #[error("{what} must be {needed}")]
    Option {
        /// Which.
        what: &'static str,
        /// What it must be.
        needed: &'static str,
    },
    /// A number that is NaN or infinite, or a time that is none.
    #[error("sample {sample} has a number that is not finite")]
    NotFinite {
        /// Which, counted from 0.
        sample: usize,
    },
    /// Too short to settle and to be fitted.
    #[error(
        "{seconds:.2} s of motion behind the settling of the filter are too short: at least {needed:.2} s are needed"
    )]
    TooShort {
        /// How much there is \[s\].
        seconds: f64,
        /// How much is needed \[s\].
        needed: f64,
    },
    /// The mass is not told.
    #[error(
        "the motion does not tell the mass: {mass:.4} ± {deviation:.4} kg; turn the sensor through other directions of gravity, or shake it"
    )]
    NoMass {
        /// The mass as fitted \[kg\].
        mass: f64,
        /// Its standard deviation \[kg\].
        deviation: f64,
    },
    /// The fitted mass is negative.
    #[error(
        "the mass would be {mass:.4} kg: the wrench is the reaction (opposite sign), or the accelerometer reads gravity in place of what holds against it, or its axes are not as said"
    )]
    NegativeMass {
        /// The mass as fitted \[kg\].
        mass: f64,
    },
}
