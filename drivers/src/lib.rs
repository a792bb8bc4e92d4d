#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(any(feature = "simulation", feature = "mcap", all(feature = "schunk-fts", feature = "std")))]
extern crate alloc;

#[cfg(feature = "ati-rdt")]
pub mod ati_rdt;
#[cfg(any(feature = "robotous", feature = "dynpick", feature = "optoforce"))]
mod axis_counts;
#[cfg(feature = "bota-serial")]
pub mod bota_serial;
#[cfg(feature = "dynpick")]
pub mod dynpick;
mod faces;
pub mod line;
pub mod middleware;
#[cfg(feature = "optoforce")]
pub mod optoforce;
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
#[cfg(feature = "simulation")]
pub mod simulation;
mod source;

#[cfg(any(feature = "robotous", feature = "dynpick", feature = "optoforce"))]
pub use axis_counts::{AxisCounts, BadAxisCounts};
pub use faces::{AsyncSignalSource, AsyncWrenchSource, NbSignalSource, NbWrenchSource};
#[cfg(any(feature = "ati-rdt", feature = "schunk-fts"))]
pub use sequence_watch::{Arrival, LinkStatistics, SequenceWatch};
pub use source::{ErrorType, Sample, SignalSource, SourceError, SourceErrorKind, WrenchSource};
