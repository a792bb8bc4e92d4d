//! Why touches tell no object.

use fingertip_surfaces::BadShape;
use thiserror::Error;

/// Why touches tell no object.
///
/// ```
/// use fingertip_calibration::object::{ObjectError, PoseNoise, fit_sphere};
///
/// // Nothing was touched, and a noise below zero is none.
/// let noise = PoseNoise::new(1e-4, 1e-3)?;
/// assert!(matches!(fit_sphere(&[], noise), Err(ObjectError::TooFew { points: 0, .. })));
/// assert!(matches!(PoseNoise::new(-1e-4, 1e-3), Err(ObjectError::BadNoise)));
/// # Ok::<(), ObjectError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ObjectError {
    /// Three numbers of each touch must be more than those of the shape.
    #[error("{points} touches are too few: {least} at least")]
    TooFew {
        /// How many there are.
        points: usize,
        /// How many it takes.
        least: usize,
    },
    /// A number of a touch is none.
    #[error("touch {touch}: {what}")]
    BadPoint {
        /// Which, from 0.
        touch: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// Deviations of the pose that are not positive and finite.
    #[error("the pose of the fingertip needs some noise: two finite numbers above zero")]
    BadNoise,
    /// The touches do not determine a part of the shape.
    #[error("the touches do not determine {what}: touch the object on more sides and further apart")]
    Undetermined {
        /// Which parameter or combination of parameters.
        what: String,
    },
    /// What was fitted is no shape.
    #[error("the touches give no shape: {0}")]
    BadShape(#[from] BadShape),
    /// The search for the shape did not come to rest.
    #[error("no convergence after {iterations} iterations: the object may be of another shape")]
    NoConvergence {
        /// How many were made.
        iterations: usize,
    },
}
