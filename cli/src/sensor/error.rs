//! What can stop samples.

use core::error::Error;

use fingertip::wrench::{SingularMatrix, TareError};
use fingertip_drivers::devices::{AddressError, ConnectError};
use fingertip_simulation::SimulationError;
use thiserror::Error;

use crate::felt::rest::NoZero;

/// Why there are no samples, or no more.
#[derive(Debug, Error)]
pub(crate) enum SensorError {
    /// The sensor cannot be opened.
    #[error(transparent)]
    Connect(#[from] ConnectError),
    /// The address of the simulated fingertip says what cannot be.
    #[error(transparent)]
    Address(#[from] AddressError),
    /// The simulated fingertip cannot be.
    #[error("simulation: {0}")]
    Simulation(#[from] SimulationError),
    #[error(transparent)]
    Singular(#[from] SingularMatrix),
    #[error(transparent)]
    Tare(#[from] TareError),
    /// The source is of no more use.
    #[error(transparent)]
    Source(Box<dyn Error + Send + Sync>),
    /// Nothing came for too long.
    #[error("the sensor {}: no sample for {seconds} s", if *.ever { "fell silent" } else { "sends nothing" })]
    Silent { ever: bool, seconds: f64 },
    /// The line ended: a sensor that was unplugged.
    #[error("the line was closed")]
    Closed,
    /// It ended while it was recorded.
    #[error("{why} {seconds} s after the first sample, behind {samples} samples, which are recorded")]
    Ended { why: Box<SensorError>, samples: u64, seconds: String },
    /// It was lost, and is not to be connected anew.
    #[error("{0}; is the sensor on, and can it be reached?")]
    Lost(Box<SensorError>),
    /// A recording has one connection.
    #[error("the recording is over")]
    Over,
    /// The rest gives no zero.
    #[error(transparent)]
    NoZero(#[from] NoZero),
    /// Wrenches where readings of gauges are needed.
    #[error("this sensor gives wrenches; --calibration is for readings of gauges, those of --replay or sim")]
    NotGauges,
    /// Nothing to write.
    #[error("no sample came, so nothing was written; is the sensor on and streaming?")]
    NoSample,
    /// The system gives no thread.
    #[error("no thread for its samples: {0}")]
    Thread(std::io::Error),
    #[error("the reader of samples died; please report it")]
    Died,
}
