//! The file of a recording that is written: CSV or MCAP, by its ending; and what is wrong with one.

use std::io;
use std::path::Path;

use clap::ValueEnum;
use fingertip_recordings::mcap::{Compression, McapError};
use fingertip_recordings::{RecordingError, SignalUnit};

use crate::error::CliError;
use crate::standard::{is_standard, shown};
use crate::table::count;

/// Name of the frame in MCAP files.
pub(crate) const FRAME: &str = "fingertip_sensor";

/// How an MCAP file is packed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Packing {
    /// Not at all
    #[default]
    None,
    /// By LZ4, which is fast
    Lz4,
    /// By zstd, which makes small files
    Zstd,
}

impl From<Packing> for Compression {
    fn from(packing: Packing) -> Self {
        match packing {
            Packing::None => Self::None,
            Packing::Lz4 => Self::Lz4,
            Packing::Zstd => Self::Zstd,
        }
    }
}

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
            None if is_standard(path) => Ok(Self::Csv),
            _ => Err(CliError::UnknownEnding { path: path.to_owned() }),
        }
    }
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

/// An error of an MCAP file, with its name; a disk that is full is named as such, with what to do.
pub(crate) fn mcap(path: &Path, error: &McapError) -> CliError {
    if let McapError::Write(refused) = error {
        return CliError::write("recording", path, same(refused));
    }
    CliError::Mcap { path: path.to_owned(), message: error.to_string() }
}

/// The same refusal of the system.
fn same(refused: &io::Error) -> io::Error {
    match refused.raw_os_error() {
        Some(number) => io::Error::from_raw_os_error(number),
        None => io::Error::new(refused.kind(), refused.to_string()),
    }
}

/// What to know of a file that was cut behind so many messages.
pub(crate) fn cut(path: &Path, messages: u64) -> String {
    format!(
        "{} ends in the middle: it was cut, or its recorder was killed; its {} whole messages were read (`fingertip \
         recover` writes them anew)",
        shown(path),
        count(messages)
    )
}
