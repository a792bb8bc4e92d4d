#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(any(feature = "simulation", feature = "mcap", all(feature = "schunk-fts", feature = "std")))]
extern crate alloc;

#[cfg(feature = "ads1256")]
pub mod ads1256;
#[cfg(feature = "ads131m")]
pub mod ads131m;
#[cfg(feature = "ati-rdt")]
pub mod ati_rdt;
#[cfg(any(feature = "robotous", feature = "dynpick", feature = "optoforce"))]
mod axis_counts;
#[cfg(feature = "bota-serial")]
pub mod bota_serial;
pub mod bridge;
#[cfg(feature = "converter")]
#[cfg_attr(
    not(any(
        feature = "ads131m",
        feature = "ads1256",
        feature = "hx711",
        feature = "mcp3564",
        feature = "nau7802"
    )),
    allow(dead_code, reason = "without a converter there is nobody to use it")
)]
pub mod converter;
#[cfg(all(feature = "simulation", any(feature = "ati-rdt", feature = "schunk-fts")))]
mod datagram_link;
#[cfg(all(feature = "std", any(feature = "ati-rdt", feature = "schunk-fts")))]
mod datagram_socket;
#[cfg(feature = "dynpick")]
pub mod dynpick;
mod faces;
#[cfg(feature = "hx711")]
pub mod hx711;
pub mod line;
#[cfg(feature = "mcp3564")]
pub mod mcp3564;
pub mod middleware;
#[cfg(feature = "nau7802")]
pub mod nau7802;
#[cfg(feature = "optoforce")]
pub mod optoforce;
#[cfg(feature = "simulation")]
mod pace;
#[cfg(feature = "std")]
pub mod recording;
#[cfg(feature = "resense")]
pub mod resense;
#[cfg(feature = "robotous")]
pub mod robotous;
#[cfg(feature = "schunk-fts")]
pub mod schunk_fts;
#[cfg(any(feature = "ati-rdt", feature = "schunk-fts"))]
mod sequence_watch;
#[cfg(all(feature = "simulation", any(feature = "ati-rdt", feature = "schunk-fts")))]
mod served;
#[cfg(all(feature = "simulation", any(feature = "ati-rdt", feature = "schunk-fts")))]
mod simulated_sensor;
#[cfg(feature = "simulation")]
pub mod simulation;
mod source;

#[cfg(any(feature = "robotous", feature = "dynpick", feature = "optoforce"))]
pub use axis_counts::{AxisCounts, BadAxisCounts};
#[cfg(all(feature = "simulation", any(feature = "ati-rdt", feature = "schunk-fts")))]
pub use datagram_link::FaultPlan;
pub use faces::{AsyncSignalSource, AsyncWrenchSource, NbSignalSource, NbWrenchSource};
#[cfg(feature = "simulation")]
pub use pace::Pace;
#[cfg(any(feature = "ati-rdt", feature = "schunk-fts"))]
pub use sequence_watch::{Arrival, LinkStatistics, SequenceWatch};
#[cfg(all(feature = "simulation", any(feature = "ati-rdt", feature = "schunk-fts")))]
pub use served::Served;
#[cfg(all(feature = "simulation", any(feature = "ati-rdt", feature = "schunk-fts")))]
pub use simulated_sensor::SimulatedSensor;
pub use source::{ErrorType, Sample, SignalSource, SourceError, SourceErrorKind, WrenchSource};
