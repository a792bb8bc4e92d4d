//! Analogue-to-digital converters: what all of them have in common.
//!
//! Each chip has a module and a feature of its own (`ads131m`, `ads1256`, `hx711`, `mcp3564`,
//! `nau7802`), made of the same parts:
//!
//! * the **wire**: requests and answers as plain values with `parse` and `emit`, bytes in and bytes out;
//! * two thin **faces** over one core: a blocking one over `embedded-hal` (which also polls), and one for
//!   tasks over `embedded-hal-async`. Both speak the same bytes in the same order;
//! * a **simulator** (feature `simulation`) that implements the `embedded-hal` traits, speaks the same
//!   bytes back, keeps its own time and injects faults; see `SimulatedBench`.
//!
//! A converter is a [`Source`](crate::Source) of counts, one number for each channel. Counts
//! become strain in the module [`bridge`](crate::bridge).
//!
//! # What is promised
//! * A sample that is given is new and within range, and whole as far as the chip protects it. One with a
//!   wrong checksum, one that was read before, and one at an end of the converter's range are errors or are
//!   waited for, never numbers. What a chip leaves unprotected stands in its module.
//! * A device that has reset itself, and so has lost its configuration, is noticed where the chip lets
//!   one notice it; each module says how.
//! * Nothing waits without end: every wait has a limit, in [`Patience`].
//!
//! The pin that says "ready" may be wired or not: give [`Unwired`] where it is not, and the device is
//! asked over the bus instead, if it can be.

#[cfg(feature = "ads1256")]
pub mod ads1256;
#[cfg(feature = "ads131m")]
pub mod ads131m;
mod conversion;
mod error;
#[cfg(feature = "devices")]
mod figures;
#[cfg(feature = "hx711")]
pub mod hx711;
#[cfg(feature = "mcp3564")]
pub mod mcp3564;
#[cfg(feature = "nau7802")]
pub mod nau7802;
mod parts;
mod reading;
mod ready;
#[cfg(feature = "simulators")]
mod simulator;
mod sources;

pub use conversion::{Conversion, ConverterStatistics};
pub use error::{ConverterError, ConverterFault};
#[cfg(feature = "devices")]
pub use figures::{
    BridgeDemand, BridgeSetting, ConverterFigures, NoiseFigure, RateFigure, ReferenceSource,
    UnsuitableConverter,
};
pub use reading::Reading;
pub use ready::{Patience, Unwired};

#[cfg(feature = "simulators")]
pub use simulator::{
    Level, SimulatedBench, SimulatedDelay, SimulatedDevice, SimulatedLine, SimulatedSpi, WireFaults,
};

#[cfg(feature = "simulators")]
#[allow(unused_imports, reason = "which of them depends on the converters that are on")]
pub(crate) use simulator::Inner;
#[allow(unused_imports, reason = "which of them depends on the converters that are on")]
pub(crate) use {
    conversion::sign_extended,
    parts::parts,
    ready::{ready_in_time, ready_in_time_async},
    sources::sources,
};
