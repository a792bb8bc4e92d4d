//! A recording as a source, at its own speed or another.

use std::path::Path;

use fingertip_drivers::middleware::Paced;
use fingertip_drivers::playback::{McapPlayback, WrenchPlayback};
use fingertip_recordings::ReaderOptions;

use super::{Feed, Losses, SourceFeed};
use crate::error::CliError;
use crate::input::Input;
use crate::recording_file::{Kind, mcap};

/// A file loses nothing.
fn whole() -> Losses {
    Losses { lost: Some(0), ..Losses::default() }
}

/// Plays the wrenches of a sensor (CSV) or topic (MCAP); an empty name means the only one. Speed 0 does
/// not wait.
pub(crate) fn open(path: &Path, sensor: &str, speed: f64) -> Result<Box<dyn Feed>, CliError> {
    let mut input = Input::open(path)?;
    if input.kind() == Kind::Mcap {
        let playback = McapPlayback::new(input.messages()?, sensor).map_err(|error| mcap(path, &error))?;
        return Ok(Box::new(SourceFeed { source: Paced::new(playback, speed), losses: |_: &_| whole() }));
    }
    let playback = WrenchPlayback::new(input.rows(ReaderOptions::default())?, sensor)?;
    Ok(Box::new(SourceFeed { source: Paced::new(playback, speed), losses: |_: &_| whole() }))
}
