//! Calibration files: our versioned TOML, ATI's `.cal`, and Rust constants for firmware.

mod calibration_file;
mod checksum;
mod error;
mod rows;
mod text;
mod validate;

pub use calibration_file::{
    CalibrationFile, Covariance, Provenance, Quality, SignalUnit, Temperature, Verdict,
};
pub use error::FileError;
pub use text::VERSION;
