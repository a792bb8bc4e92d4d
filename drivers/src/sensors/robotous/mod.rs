//! Robotous RFT force/torque sensors, over a serial line (RS-232, UART, USB) or CAN.
//!
//! Layers, each usable alone and without I/O: the wire format ([`Reading`] with the frames of both
//! transports, [`Request`]), the [`RobotousDecoder`] for a serial line (put it on a sensor of the
//! module [`line`](crate::sensors::line), 115 200 baud as delivered), and the [`CanAssembler`], which joins the
//! two CAN frames of a reading. A [`CanSensor`] puts it on any driver of `embedded-can`; with the feature
//! `simulation` a `SimulatedCan` is such a driver, with a sensor behind it.
//!
//! A sensor streams after [`Request::Stream`]; its zero is set only by [`Request::Bias`].
//!
//! The layout follows the manufacturer's published example programs (force divided by 50, torque by
//! 2000, 16 bytes of data, the sum of them as checksum). Two facts could not be confirmed from a
//! public source, and are left to the user: the CAN identifiers that a sensor has as delivered, and
//! the dividers of models other than the RFT60 and RFT80. An overload is any bit of the overload
//! byte; which bit belongs to which axis is not relied on.

mod can;
mod can_sensor;
mod decoder;
#[cfg(feature = "devices")]
pub(crate) mod device;
#[cfg(feature = "simulators")]
mod simulated_can;
#[cfg(feature = "simulators")]
mod simulator;
#[cfg(all(feature = "devices", target_os = "linux"))]
mod socketcan;
mod wire;

pub use can::{CanAssembler, CanStatistics};
pub use can_sensor::{CanSensor, CanSensorError};
pub use decoder::{RobotousDecoder, RobotousFault};
#[cfg(feature = "simulators")]
pub use simulated_can::{Silent, SimulatedCan, SimulatedFrame};
#[cfg(feature = "simulators")]
pub use simulator::SimulatedRft;
pub use wire::{FORMAT, Reading, Request};
