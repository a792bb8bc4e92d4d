//! A recording as a source, at its own speed or another.

use core::convert::Infallible;
use std::fs;
use std::path::Path;

use fingertip::wrench::Wrench;
use fingertip_drivers::middleware::Paced;
use fingertip_drivers::recording::mcap::McapPlayback;
use fingertip_drivers::recording::{RecordingReader, WrenchPlayback};
use fingertip_drivers::{ErrorType, Sample, WrenchSource};

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
        let file = fs::read(path).map_err(|source| CliError::read("recording", path, source))?;
        let fault = |error: &dyn core::fmt::Display| CliError::Mcap {
            path: path.to_owned(),
            message: error.to_string(),
        };
        // It borrows the file, so it is read whole: a sample takes 56 bytes, a minute at 1 kHz 3.4 MB.
        let mut playback = McapPlayback::new(&file, sensor).map_err(|error| fault(&error))?;
        let mut samples = Vec::new();
        while let Some(sample) = playback.next_wrench().map_err(|error| fault(&error))? {
            samples.push(sample);
        }
        let source = Paced::new(InMemory(samples.into_iter()), speed);
        return Ok(Box::new(SourceFeed { source, losses: |_: &_| whole() }));
    }
    let playback = WrenchPlayback::new(RecordingReader::open(path)?, sensor)?;
    Ok(Box::new(SourceFeed { source: Paced::new(playback, speed), losses: |_: &_| whole() }))
}

struct InMemory(alloc::vec::IntoIter<Sample<f64, Wrench<f64>>>);

impl ErrorType for InMemory {
    type Error = Infallible;
}

impl WrenchSource<f64> for InMemory {
    fn next_wrench(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, Infallible> {
        Ok(self.0.next())
    }
}
