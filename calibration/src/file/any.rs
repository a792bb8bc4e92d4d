//! A calibration in any format that is read.

use std::io;
use std::path::Path;

use thiserror::Error;

use super::bounded::read_text;
use super::{AtiCalibration, AtiError, CalibrationFile, FileError};

/// Why a calibration of either format cannot be read.
///
/// ```
/// use fingertip_calibration::file::{ReadError, read_calibration};
///
/// assert!(matches!(read_calibration("nowhere.toml"), Err(ReadError::Io(_))));
/// // A bare matrix says nothing of its units.
/// let file = tempfile::Builder::new().suffix(".npy").tempfile()?;
/// assert!(matches!(read_calibration(file.path()), Err(ReadError::Plain)));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file cannot be opened.
    #[error("cannot be read: {0}")]
    Io(#[from] io::Error),
    /// A plain matrix, which does not say what it is.
    #[error(
        "a plain matrix says neither its units nor which way it goes; make it a calibration by `fingertip import`, where you \
         say them"
    )]
    Plain,
    /// It is not as our format is.
    #[error(transparent)]
    File(#[from] FileError),
    /// It is not as ATI's format is.
    #[error(transparent)]
    Ati(#[from] AtiError),
}

/// Reads a calibration: ATI's format if the file is called `.cal`, ours otherwise.
///
/// # Errors
/// [`ReadError`], which does not name the file.
pub fn read_calibration(path: impl AsRef<Path>) -> Result<CalibrationFile, ReadError> {
    let path = path.as_ref();
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    if matches!(ending.as_deref(), Some("csv" | "npy" | "txt")) {
        return Err(ReadError::Plain);
    }
    let text = read_text(path)?;
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("cal")) {
        return Ok(AtiCalibration::from_xml(&text)?.to_calibration()?);
    }
    Ok(CalibrationFile::from_toml(&text)?)
}
