//! A recording as a source, at its own speed or another.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use fingertip_drivers::middleware::Paced;
use fingertip_drivers::recording::mcap::McapPlayback;
use fingertip_drivers::recording::{RecordingReader, WrenchPlayback};

use super::losses::Losses;
use super::{Feed, SourceFeed};
use crate::error::CliError;

/// A file loses nothing.
fn whole() -> Losses {
    Losses { lost: Some(0), ..Losses::default() }
}

/// Plays the wrenches of a sensor (CSV) or topic (MCAP); an empty name means the only one. Speed 0 does
/// not wait.
pub(crate) fn open(path: &Path, sensor: &str, speed: f64) -> Result<Box<dyn Feed>, CliError> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mcap")) {
        let file = File::open(path).map_err(|source| CliError::read("recording", path, source))?;
        let playback = McapPlayback::new(BufReader::new(file), sensor)
            .map_err(|error| CliError::Mcap { path: path.to_owned(), message: error.to_string() })?;
        return Ok(Box::new(SourceFeed { source: Paced::new(playback, speed), losses: |_: &_| whole() }));
    }
    let playback = WrenchPlayback::new(RecordingReader::open(path)?, sensor)?;
    Ok(Box::new(SourceFeed { source: Paced::new(playback, speed), losses: |_: &_| whole() }))
}
