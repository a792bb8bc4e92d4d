#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(feature = "std")]
pub mod recording;
#[cfg(feature = "simulation")]
pub mod simulation;
mod source;

pub use source::{ErrorType, Sample, SignalSource, SourceError, SourceErrorKind, WrenchSource};
