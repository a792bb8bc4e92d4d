//! Bota Systems' sensors on a serial line (Rokubi, SensONE, MiniONE …), in their binary streaming
//! format.
//!
//! Three layers, each usable alone: the wire format ([`Frame`], `no_std`), the [`Deframer`] that
//! finds frames in a stream of bytes and drops what does not check (`no_std`, no I/O), and the
//! `BotaSensor` over any `std::io::Read` (feature `std`), such as an open serial port at 460 800
//! baud. With the feature `simulation` a `SimulatedBota` sends the same bytes over a line
//! with faults.
//!
//! The sensor must be streaming: as delivered it does so when it is switched on. Its configuration
//! is not touched, and its zero is never set.

mod deframer;
mod wire;

#[cfg(feature = "std")]
mod sensor;
#[cfg(feature = "simulation")]
mod simulator;

pub use deframer::Deframer;
pub use wire::{Frame, FrameError};

#[cfg(feature = "std")]
pub use sensor::{BotaError, BotaSensor};
#[cfg(feature = "simulation")]
pub use simulator::{LineFaults, SimulatedBota};
