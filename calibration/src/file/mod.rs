//! Calibration files: our versioned TOML, ATI's `.cal`, and Rust constants for firmware.

mod ati;
mod ati_writer;
mod calibration_file;
mod checksum;
mod error;
mod rows;
mod rust_constants;
mod text;
mod validate;

pub use ati::{AtiAxis, AtiCalibration, AtiError};
pub use calibration_file::{
    CalibrationFile, Covariance, Provenance, Quality, SignalUnit, Temperature, Verdict,
};
pub use error::FileError;
pub use rust_constants::Scalar;
pub use text::VERSION;
