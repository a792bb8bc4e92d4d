#![doc = include_str!("../README.md")]

extern crate alloc;

mod axis;
pub mod bench;
mod calibrate;
pub mod creep;
pub mod curve;
pub mod design;
pub mod experiment;
pub mod file;
pub mod fit;
pub mod geometry;
pub mod gravity;
pub mod in_situ;
pub mod inertial;
pub mod linear;
pub mod loads;
pub mod model;
pub mod motion;
pub mod page;
pub mod report;
pub mod sheet;
pub mod tare;
#[cfg(test)]
mod testing;

pub use axis::Axis;
pub use calibrate::{Calibration, calibrate, calibrate_taking};
pub use fingertip_wrench::units;
pub use nalgebra;

/// Name and version of this library, as files and reports name their maker.
pub const TOOL: &str = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));
