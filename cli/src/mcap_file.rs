//! MCAP files that are read.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use fingertip_drivers::recording::SignalUnit;
use fingertip_drivers::recording::mcap::McapReader;

use crate::error::CliError;
use crate::record::output::mcap;

/// The bytes of a recording.
pub(crate) fn bytes(path: &Path) -> Result<BufReader<File>, CliError> {
    File::open(path).map(BufReader::new).map_err(|source| CliError::read("recording", path, source))
}

/// The entries of a recording.
pub(crate) fn open(path: &Path) -> Result<McapReader<BufReader<File>>, CliError> {
    McapReader::new(bytes(path)?).map_err(|error| mcap(path, &error))
}

/// The unit that a message of signals states.
pub(crate) fn unit(name: &str) -> SignalUnit {
    match name {
        "V" => SignalUnit::Volts,
        "counts" => SignalUnit::Counts,
        _ => SignalUnit::Unstated,
    }
}
