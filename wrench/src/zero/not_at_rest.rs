//! Why a sensor was not at rest.

use thiserror::Error;

/// Why there is no tare. Gauges count from 0.
///
/// ```
/// use fingertip_wrench::{NotAtRest, RestTest};
/// use nalgebra::Vector6;
///
/// let mut rest = RestTest::<f64, 6>::new(1e-3)?;
/// rest.add(&Vector6::zeros());
/// let refused = rest.finish().unwrap_err();
/// assert_eq!(refused, NotAtRest::TooFewSamples { samples: 1, needed: 32 });
/// assert_eq!(refused.to_string(), "at least 32 readings at rest are needed, not 1");
/// # Ok::<(), NotAtRest>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NotAtRest {
    /// Too few readings for the tests to mean anything.
    #[error("at least {needed} readings at rest are needed, not {samples}")]
    TooFewSamples {
        /// How many finite readings there were.
        samples: u32,
        /// How many are needed.
        needed: u32,
    },
    /// Readings that were NaN or infinite.
    #[error("{rejected} of the readings were not finite numbers")]
    NotFinite {
        /// How many.
        rejected: u32,
    },
    /// A gauge moved steadily.
    #[error("gauge {gauge} drifted by {over_noise:.2} times its noise during the readings")]
    Drifts {
        /// Which one.
        gauge: usize,
        /// How far the fitted line moved over all readings, in standard deviations of one reading.
        over_noise: f64,
    },
    /// A gauge's readings hang together more than noise does, or spread more than its noise is known
    /// to.
    #[error("gauge {gauge} is unsteady: its readings are not independent noise of the usual size")]
    Unsteady {
        /// Which one.
        gauge: usize,
    },
    /// A reading far from the others.
    #[error("gauge {gauge} has a reading {over_noise:.1} times its noise away from the mean")]
    Outlier {
        /// Which one.
        gauge: usize,
        /// How far, in standard deviations of one reading.
        over_noise: f64,
    },
    /// Readings so large that their spread cannot be represented.
    #[error("the readings of gauge {gauge} are too large for the scalar type")]
    OutOfRange {
        /// Which one.
        gauge: usize,
    },
    /// The rate of false alarms is not between 0 and 1, both excluded, or a noise or resolution is
    /// negative or not finite.
    #[error("the rate of false alarms must be between 0 and 1, and noise and resolution not negative")]
    BadParameter,
}
