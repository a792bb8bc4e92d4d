//! What can be wrong with a calibration file.

use std::io;

use fingertip_wrench::SensorMatrixError;
use thiserror::Error;

/// Why a calibration cannot be read, written or used. Every variant names the field.
///
/// ```
/// # use fingertip_calibration::{file::SignalUnit, nalgebra::DMatrix};
/// # // 2 V on one gauge each under 10 N or 0.1 N·m.
/// # let file = fingertip_calibration::file::CalibrationFile::new(
/// #     DMatrix::from_diagonal_element(6, 6, 2.0),
/// #     vec![10.0, 10.0, 10.0, 0.1, 0.1, 0.1],
/// #     vec![0.0; 6],
/// #     SignalUnit::Volt,
/// # )?;
/// use fingertip_calibration::file::{CalibrationFile, FileError};
///
/// // Somebody makes 3 V of 2 V in the file, and the checksum tells.
/// let text = file.to_toml()?.replace("2.0", "3.0");
/// assert!(matches!(CalibrationFile::from_toml(&text), Err(FileError::WrongChecksum { .. })));
/// // A zero for five gauges of six is refused, by the name of the field.
/// let error = CalibrationFile::new(file.matrix, file.nominal, vec![0.0; 5], file.signal_unit).unwrap_err();
/// assert!(matches!(&error, FileError::WrongShape { found: 5, expected: 6, .. }));
/// assert!(error.to_string().contains("zero"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FileError {
    /// The file could not be read or written.
    #[error("{path}: {source}")]
    Io {
        /// Which file.
        path: String,
        /// Why.
        source: io::Error,
    },
    /// The text is not TOML, lacks a field, has a field of the wrong type or one that is not known.
    #[error("the file cannot be used: {message}")]
    Malformed {
        /// What the parser says; it names line and field.
        message: String,
    },
    /// The field `version` names a version that this library does not know.
    #[error("field `version`: version {found} is not known; this library reads versions up to {known}")]
    UnknownVersion {
        /// The version of the file.
        found: i64,
        /// The newest version that this library reads.
        known: i64,
    },
    /// The contents are not those that the checksum was taken of.
    #[error(
        "field `checksum`: it is {found}, but the contents give {expected}; the file was damaged or edited \
         (whoever edited it on purpose writes the second)"
    )]
    WrongChecksum {
        /// The checksum in the file.
        found: String,
        /// The checksum of the contents.
        expected: String,
    },
    /// A number is NaN or infinite.
    #[error("field `{field}` is not a finite number")]
    NotFinite {
        /// Which one, with its indices.
        field: String,
    },
    /// A list has the wrong length.
    #[error("field `{field}` has {found} entries; expected {expected}")]
    WrongShape {
        /// Which one.
        field: String,
        /// Its length.
        found: usize,
        /// The length that it shall have.
        expected: usize,
    },
    /// A number lies outside the range that it may have.
    #[error("field `{field}` must be {requirement}")]
    OutOfRange {
        /// Which one.
        field: String,
        /// What it must be.
        requirement: &'static str,
    },
    /// The sensor has another number of gauges than the caller's type.
    #[error("field `matrix`: the sensor has {found} gauges, not {expected}")]
    WrongGauges {
        /// Gauges of the file.
        found: usize,
        /// Gauges that the caller asked for.
        expected: usize,
    },
    /// The sensor does not measure all six components.
    #[error("field `axes`: the sensor measures {found} components, not the six of a wrench")]
    NotSixAxes {
        /// How many components it measures.
        found: usize,
    },
    /// The calibration has temperature terms, and no temperature is known.
    #[error(
        "field `temperature`: the readings drift with temperature (reference {reference} °C), and none is given for them"
    )]
    NeedsTemperature {
        /// Reference temperature of the calibration \[°C\].
        reference: f64,
    },
    /// The matrix is not that of a sensor.
    #[error("field `matrix`: {0}")]
    Matrix(#[from] SensorMatrixError),
    /// The matrix cannot be inverted, and the format asked for needs its inverse.
    #[error("field `matrix`: it has no inverse")]
    Singular,
}
