//! Recordings as sources of samples.

mod csv;
mod error;
#[cfg(feature = "mcap")]
mod mcap;

pub use csv::{SignalPlayback, WrenchPlayback};
#[cfg(feature = "mcap")]
pub use mcap::McapPlayback;
