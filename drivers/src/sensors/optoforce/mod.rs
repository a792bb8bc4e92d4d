//! OptoForce six-axis sensors (now OnRobot) on their USB serial line (1 000 000 baud, 8N1).
//!
//! Two layers without I/O: the wire format ([`Reading`], [`Configuration`]) and the
//! [`OptoForceDecoder`], to be put on a sensor of the module [`line`](crate::sensors::line). The sensor streams as it
//! was last configured; send a [`Configuration`] to change that. It sets the zero only if it is asked
//! to.
//!
//! After the manufacturer's general DAQ protocol, with the meaning of the status word as public
//! clients of it have it. Counts per newton differ from sensor to sensor and stand in its sensitivity
//! report.

mod decoder;
#[cfg(feature = "devices")]
pub(crate) mod device;
#[cfg(feature = "simulators")]
mod simulator;
mod wire;

pub use decoder::{OptoForceDecoder, OptoForceFault};
#[cfg(feature = "simulators")]
pub use simulator::SimulatedOptoForce;
pub use wire::{Configuration, FORMAT, Filter, Rate, Reading};
