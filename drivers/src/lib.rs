#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(any(feature = "simulators", feature = "recordings", all(feature = "schunk-fts", feature = "std")))]
extern crate alloc;

mod awaited;
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
pub mod converters;
#[cfg(feature = "devices")]
pub mod devices;
pub mod middleware;
#[cfg(feature = "recordings")]
pub mod playback;
pub mod polled;
pub mod sensors;
mod source;

pub use awaited::AsyncSource;
pub use source::{Sample, Source, SourceError, SourceErrorKind};
