//! The file of a recording, read or written: CSV or MCAP, by its ending.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use fingertip_recordings::mcap::{McapError, McapReader};
use fingertip_recordings::{RecordingError, SignalUnit};

use crate::error::CliError;

/// Name of the frame in MCAP files.
pub(crate) const FRAME: &str = "fingertip_sensor";

/// What the ending of a name says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Csv,
    Mcap,
}

impl Kind {
    pub(crate) fn of(path: &Path) -> Result<Self, CliError> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("csv" | "txt") => Ok(Self::Csv),
            Some("mcap") => Ok(Self::Mcap),
            _ => Err(CliError::UnknownEnding { path: path.to_owned() }),
        }
    }
}

/// The bytes of an MCAP recording.
pub(crate) fn bytes(path: &Path) -> Result<BufReader<File>, CliError> {
    File::open(path).map(BufReader::new).map_err(|source| CliError::read("recording", path, source))
}

/// The entries of an MCAP recording.
pub(crate) fn open(path: &Path) -> Result<McapReader<BufReader<File>>, CliError> {
    McapReader::new(bytes(path)?).map_err(|error| mcap(path, &error))
}

/// The unit that a message of signals states.
pub(crate) fn unit(name: &str) -> SignalUnit {
    SignalUnit::from_name(name)
        .filter(|(_, size)| *size == 1.0)
        .map_or(SignalUnit::Unstated, |(unit, _)| unit)
}

/// An error of a CSV file that is written, with its name.
pub(crate) fn csv(path: &Path, error: RecordingError) -> CliError {
    match error {
        RecordingError::Write { source } => CliError::write("recording", path, source),
        other => CliError::Recording(other),
    }
}

/// An error of an MCAP file, with its name.
pub(crate) fn mcap(path: &Path, error: &McapError) -> CliError {
    CliError::Mcap { path: path.to_owned(), message: error.to_string() }
}
