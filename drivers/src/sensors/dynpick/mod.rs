//! WACOH DynPick force/torque sensors on a serial line (921 600 baud, 8N1).
//!
//! The format is text. A client sends [`REQUEST`] for one reading and gets a digit that counts them, six
//! hexadecimal numbers and a line end; [`Sensitivities`] are asked for with
//! [`REQUEST_SENSITIVITIES`] (not all models answer), and [`REQUEST_ZERO`] takes the present load as
//! zero in the sensor: nothing here sends that by itself. Put a [`DynPickDecoder`] on a sensor of the
//! module [`line`](crate::sensors::line).
//!
//! **There is no checksum.** A damaged byte that leaves a hexadecimal digit gives a wrong number, and
//! nothing can tell. The decoder refuses all that can be told: text that is no reading, numbers
//! beyond the 14 bits of the converter, and an axis at either end of its range.
//!
//! The commands for continuous sending could not be confirmed from a public source and are not
//! offered; what a sensor sends by itself is decoded all the same.

mod decoder;
#[cfg(feature = "devices")]
pub(crate) mod device;
mod sensitivities;
#[cfg(feature = "simulators")]
mod simulator;
mod wire;

pub use decoder::{DynPickDecoder, DynPickFault};
pub use sensitivities::{Sensitivities, SensitivitiesError};
#[cfg(feature = "simulators")]
pub use simulator::SimulatedDynPick;
pub use wire::{FORMAT, REQUEST, REQUEST_SENSITIVITIES, REQUEST_ZERO, Reading};
