//! An MCAP file as a source of wrenches.

use fingertip_wrench::Wrench;

use super::error::McapError;
use super::messages::Recorded;
use super::reader::McapReader;
use crate::{ErrorType, Sample, WrenchSource};

/// The wrenches of one topic. Those that are not finite are passed over and counted.
#[derive(Debug)]
pub struct McapPlayback<'a> {
    reader: McapReader<'a>,
    topic: String,
    not_finite: u64,
}

impl<'a> McapPlayback<'a> {
    /// Plays a topic by its name; an empty name means the only one with wrenches. The file is read
    /// through once to see which there are.
    ///
    /// # Errors
    /// [`McapError::ChooseTopic`], or what is wrong with the file.
    pub fn new(file: &'a [u8], topic: &str) -> Result<Self, McapError> {
        let mut known: Vec<String> = Vec::new();
        let mut reader = McapReader::new(file)?;
        while let Some(entry) = reader.next_entry()? {
            if matches!(entry.recorded, Recorded::Wrench(_)) && !known.contains(&entry.topic) {
                known.push(entry.topic);
            }
        }
        let chosen = match known.as_slice() {
            [only] if topic.is_empty() => Some(only),
            known => known.iter().find(|name| *name == topic),
        };
        let Some(topic) = chosen.cloned() else {
            return Err(McapError::ChooseTopic { known: known.join(", ") });
        };
        Ok(Self { reader: McapReader::new(file)?, topic, not_finite: 0 })
    }

    /// Wrenches that were passed over since they are not finite.
    #[must_use]
    pub const fn not_finite(&self) -> u64 {
        self.not_finite
    }
}

impl ErrorType for McapPlayback<'_> {
    type Error = McapError;
}

impl WrenchSource<f64> for McapPlayback<'_> {
    fn next_wrench(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, McapError> {
        while let Some(entry) = self.reader.next_entry()? {
            if let (Recorded::Wrench(value), true) = (entry.recorded, entry.topic == self.topic) {
                if value.is_finite() {
                    return Ok(Some(Sample { time: Some(entry.time), value }));
                }
                self.not_finite += 1;
            }
        }
        Ok(None)
    }
}
