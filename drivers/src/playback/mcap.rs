//! An MCAP file as a source of wrenches.

use std::io::{Read, Seek, SeekFrom};

use fingertip_recordings::mcap::{Entry, McapError, McapReader, Recorded};
use fingertip_wrench::Wrench;

use crate::{Sample, Source};

/// The wrenches of one topic. Those that are not finite are passed over and counted.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::playback::McapPlayback;
/// use fingertip_recordings::mcap::McapWriter;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector6;
/// use std::io::Cursor;
///
/// let wrench = Wrench::from_components(&Vector6::new(0.0, 0.0, -2.0, 0.0, 0.0, 0.0));
/// let mut writer = McapWriter::new(Cursor::new(Vec::new()))?;
/// let topic = writer.wrenches("tip/wrench", "sensor")?;
/// writer.write_wrench(topic, 0.5, &wrench)?;
/// let file = writer.finish()?.into_inner();
///
/// let mut playback = McapPlayback::new(Cursor::new(file), "tip/wrench")?;
/// let sample = playback.next_sample()?.unwrap();
/// assert_eq!((sample.time, sample.value), (Some(0.5), wrench));
/// assert_eq!(playback.next_sample()?, None);
/// # Ok::<(), fingertip_recordings::mcap::McapError>(())
/// ```
#[derive(Debug)]
pub struct McapPlayback<R> {
    reader: McapReader<R>,
    topic: String,
    not_finite: u64,
}

impl<R: Read + Seek> McapPlayback<R> {
    /// Plays a topic by its name; an empty name means the only one with wrenches. The file is read
    /// through once to see which there are, as far as it is whole.
    ///
    /// # Errors
    /// [`McapError::ChooseTopic`], or what is wrong with the file if that hides all wrenches.
    pub fn new(mut file: R, topic: &str) -> Result<Self, McapError> {
        let mut known: Vec<String> = Vec::new();
        let start = file.stream_position()?;
        let mut reader = McapReader::new(&mut file)?;
        loop {
            match reader.next_entry() {
                Ok(Some(Entry { topic, recorded: Recorded::Wrench(_), .. })) if !known.contains(&topic) => {
                    known.push(topic);
                }
                // A message that cannot be read is met again when it is played; so is the end of a file that was
                // cut.
                Ok(Some(_)) | Err(McapError::Message { .. }) => {}
                Err(error) if known.is_empty() => return Err(error),
                Ok(None) | Err(_) => break,
            }
        }
        let chosen = match known.as_slice() {
            [only] if topic.is_empty() => Some(only),
            known => known.iter().find(|name| *name == topic),
        };
        let Some(topic) = chosen.cloned() else {
            return Err(McapError::ChooseTopic { known: known.join(", ") });
        };
        file.seek(SeekFrom::Start(start))?;
        Ok(Self { reader: McapReader::new(file)?, topic, not_finite: 0 })
    }
}

impl<R> McapPlayback<R> {
    /// Wrenches that were passed over since they are not finite.
    #[must_use]
    pub const fn not_finite(&self) -> u64 {
        self.not_finite
    }
}

impl<R: Read> Source<f64, Wrench<f64>> for McapPlayback<R> {
    type Error = McapError;

    fn next_sample(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, McapError> {
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
