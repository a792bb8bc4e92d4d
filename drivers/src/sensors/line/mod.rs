//! Sensors that send frames of bytes over a line: what all of them have in common.
//!
//! A device gives a [`FrameFormat`] (how its frames look), from which a [`Deframer`] finds them
//! among noise, and a [`LineDecoder`] (what they mean). Neither does I/O. On top of one core there
//! are three faces: `LineSensor` blocks on any `std::io::Read` (feature `std`), `EmbeddedLine` blocks
//! or polls any `embedded_io::Read`, and `AsyncLine` awaits any `embedded_io_async::Read` (feature
//! `embedded-io`).
//!
//! With `simulation` each device has a simulator, a `SerialDevice`: put into a `SimulatedSerial` it stands where a
//! serial port does, hears requests, and sends frames over a `SimulatedLine` with faults.

mod decoder;
mod deframer;
mod error;
#[cfg(any(feature = "std", feature = "embedded-io"))]
mod pump;

#[cfg(feature = "embedded-io")]
mod embedded;
#[cfg(feature = "std")]
mod sensor;
#[cfg(feature = "simulators")]
mod simulated_sensor;
#[cfg(feature = "simulators")]
mod simulator;

pub use decoder::LineDecoder;
pub use deframer::{Deframer, FrameFormat, LineStatistics};
pub use error::LineError;

#[cfg(feature = "embedded-io")]
pub use embedded::{AsyncLine, EmbeddedLine};
#[cfg(feature = "std")]
pub use sensor::LineSensor;
#[cfg(feature = "simulators")]
pub use simulated_sensor::{SerialDevice, SerialRequest, SerialSample, SimulatedSerial};
#[cfg(feature = "simulators")]
pub use simulator::{LineFaults, SimulatedLine};

#[cfg(any(feature = "bota-serial", feature = "resense", feature = "schunk-fts"))]
pub(crate) use decoder::finite_wrench;
