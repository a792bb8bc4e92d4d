#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(feature = "simulation")]
extern crate alloc;

#[cfg(feature = "ati-rdt")]
pub mod ati_rdt;
#[cfg(feature = "bota-serial")]
pub mod bota_serial;
#[cfg(feature = "std")]
pub mod recording;
#[cfg(feature = "ati-rdt")]
mod sequence_watch;
#[cfg(feature = "simulation")]
pub mod simulation;
mod source;

#[cfg(feature = "ati-rdt")]
pub use sequence_watch::{Arrival, LinkStatistics, SequenceWatch};
pub use source::{ErrorType, Sample, SignalSource, SourceError, SourceErrorKind, WrenchSource};
