//! Calibration and payload files: our versioned TOML, ATI's `.cal`, and Rust constants for firmware.

mod any;
mod ati;
mod ati_error;
mod ati_reader;
mod ati_writer;
mod bounded;
mod calibration_file;
mod checksum;
mod covariance;
mod document;
mod error;
mod npy;
mod payload_file;
mod plain;
mod rows;
mod rust_constants;
mod temperature;
mod text;
mod uncertainty;
mod validate;

pub use any::{ReadError, read_calibration};
pub(crate) use ati::UNTARED;
pub use ati::{AtiAxis, AtiCalibration};
pub use ati_error::AtiError;
pub use bounded::{read_bounded, read_text};
pub use calibration_file::{CalibrationFile, Provenance, Quality, Verdict};
pub use covariance::Covariance;
pub(crate) use covariance::of_pseudo_inverse;
pub use document::VERSION;
pub use error::FileError;
pub use fingertip_recordings::SignalUnit;
pub use payload_file::{InertialUnitFile, PayloadFile, PayloadQuality};
pub use plain::{PlainError, PlainMatrix, PlainUnits, plain_csv, plain_npy};
pub use rust_constants::Scalar;
pub use temperature::Temperature;
