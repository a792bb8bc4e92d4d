//! Bota Systems' sensors on a serial line (Rokubi, SensONE, MiniONE …), in their binary streaming
//! format.
//!
//! Two layers, each usable alone and neither with I/O: the wire format ([`Frame`]) and the
//! [`BotaDecoder`], which finds frames among bytes, drops what does not check and gives wrenches. Put
//! the decoder on a line at 460 800 baud with a sensor of the module [`line`](crate::sensors::line). To
//! simulate one, send [`Frame::emit`] over a `SimulatedLine` (feature `simulation`).
//!
//! The sensor must be streaming: as delivered it does so when it is switched on. Its configuration
//! is not touched, and its zero is never set.

mod decoder;
#[cfg(feature = "devices")]
pub(crate) mod device;
#[cfg(feature = "simulators")]
mod simulator;
mod wire;

pub use decoder::{BotaDecoder, BotaFault};
#[cfg(feature = "simulators")]
pub use simulator::SimulatedBota;
pub use wire::{FORMAT, Frame, FrameError};
