#![doc = include_str!("../README.md")]

mod axis;
pub mod design;
pub mod file;
pub mod fit;
pub mod linear;
pub mod loads;
pub mod model;
pub mod report;
pub mod units;

pub use axis::Axis;
pub use nalgebra;

/// Name and version of this library, as files and reports name their maker.
pub const TOOL: &str = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));
