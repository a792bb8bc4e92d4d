//! Reads an MCAP file.

use alloc::borrow::Cow;
use core::fmt;

use ::mcap::parse_record;
use ::mcap::read::ChannelAccumulator;
use ::mcap::records::{MessageHeader, Record, op};
use crc::{CRC_32_ISO_HDLC, Crc};

use super::error::McapError;
use super::messages::{Header, Recorded};

/// The CRC of MCAP is that of zlib.
const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// One message of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its topic.
    pub topic: String,
    /// When: its stamp, or for a message of another type when it was written down \[s\].
    pub time: f64,
    /// Name of its frame; empty for a message of another type.
    pub frame: String,
    /// What it holds.
    pub recorded: Recorded,
}

/// Reads the messages of a file that is in memory (or mapped to it), in the order in which they stand
/// there. The checksum of a chunk is checked before anything in it is given. A file that was cut is
/// read up to the last whole chunk; the error comes behind it.
pub struct McapReader<'a> {
    /// The records behind the one at hand, and those of the chunk at hand.
    rest: &'a [u8],
    chunk: &'a [u8],
    channels: ChannelAccumulator<'static>,
    past_data: bool,
}

impl fmt::Debug for McapReader<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("McapReader").field("rest", &self.rest.len()).finish_non_exhaustive()
    }
}

impl<'a> McapReader<'a> {
    /// Over the bytes of a file.
    ///
    /// # Errors
    /// [`McapError::File`] if they are none.
    pub fn new(file: &'a [u8]) -> Result<Self, McapError> {
        if !file.starts_with(::mcap::MAGIC) {
            return Err(McapError::File(::mcap::McapError::BadMagic));
        }
        let rest = file.get(::mcap::MAGIC.len()..).unwrap_or_default();
        Ok(Self { rest, chunk: &[], channels: ChannelAccumulator::default(), past_data: false })
    }

    /// The next message, or `None` at the end. Behind an error of the file nothing more can be read.
    ///
    /// # Errors
    /// [`McapError::File`] or [`McapError::Message`].
    pub fn next_entry(&mut self) -> Result<Option<Entry>, McapError> {
        let next = self.next_message();
        if matches!(next, Err(McapError::File(_))) {
            self.past_data = true;
        }
        next
    }

    fn next_message(&mut self) -> Result<Option<Entry>, McapError> {
        while !self.past_data {
            let from = if self.chunk.is_empty() { &mut self.rest } else { &mut self.chunk };
            let (opcode, data) = next_record(from)?;
            if opcode == op::CHUNK {
                self.chunk = checked_chunk(data)?;
                continue;
            }
            // Only what is used here is parsed: the library panics on an attachment whose length is wrong.
            if ![op::SCHEMA, op::CHANNEL, op::MESSAGE, op::DATA_END].contains(&opcode) {
                continue;
            }
            match parse_record(opcode, data)? {
                Record::Schema { header, data } => {
                    self.channels.add_schema(header, Cow::Owned(data.into_owned()))?;
                }
                Record::Channel(channel) => self.channels.add_channel(channel)?,
                Record::Message { header, data } => {
                    return Self::entry(&self.channels, &header, &data).map(Some);
                }
                // What follows are repetitions and the index.
                Record::DataEnd(_) => self.past_data = true,
                _ => {}
            }
        }
        Ok(None)
    }

    fn entry(
        channels: &ChannelAccumulator<'_>,
        message: &MessageHeader,
        data: &[u8],
    ) -> Result<Entry, McapError> {
        let MessageHeader { channel_id, sequence, log_time, .. } = *message;
        let unknown = || ::mcap::McapError::UnknownChannel(sequence, channel_id);
        let channel = channels.get(channel_id).ok_or_else(unknown)?;
        let topic = channel.topic.clone();
        let is_cdr = channel.message_encoding == "cdr";
        let name = channel.schema.as_ref().filter(|_| is_cdr).map_or("", |schema| schema.name.as_str());
        let (header, recorded) = match Recorded::parse(name, data) {
            Ok(parsed) => parsed,
            Err(source) => return Err(McapError::Message { topic, source }),
        };
        #[allow(clippy::cast_precision_loss, reason = "to a microsecond in this century")]
        let time = if recorded == Recorded::Other { log_time as f64 * 1e-9 } else { header.time() };
        let Header { frame, .. } = header;
        Ok(Entry { topic, time, frame, recorded })
    }
}

/// Takes the next record: its kind, its length in eight bytes, and so many bytes.
///
/// The library's own readers either do not look at the checksums of chunks or trust the lengths of the
/// records in them.
fn next_record<'a>(from: &mut &'a [u8]) -> Result<(u8, &'a [u8]), McapError> {
    let cut = || McapError::File(::mcap::McapError::UnexpectedEof);
    let (&[opcode, length @ ..], behind) = from.split_first_chunk::<9>().ok_or_else(cut)?;
    let length = usize::try_from(u64::from_le_bytes(length)).map_err(|_| cut())?;
    let (data, rest) = behind.split_at_checked(length).ok_or_else(cut)?;
    *from = rest;
    Ok((opcode, data))
}

/// The records of a chunk whose checksum fits (zero means that there is none).
fn checked_chunk(chunk: &[u8]) -> Result<&[u8], McapError> {
    let cut = || McapError::File(::mcap::McapError::UnexpectedEof);
    // Two times and the size of the contents come first.
    let behind = chunk.get(24..).ok_or_else(cut)?;
    let (saved, behind) = behind.split_first_chunk::<4>().ok_or_else(cut)?;
    let (length, behind) = behind.split_first_chunk::<4>().ok_or_else(cut)?;
    let length = usize::try_from(u32::from_le_bytes(*length)).map_err(|_| cut())?;
    let (compression, behind) = behind.split_at_checked(length).ok_or_else(cut)?;
    if !compression.is_empty() {
        let name = String::from_utf8_lossy(compression).into_owned();
        return Err(McapError::File(::mcap::McapError::UnsupportedCompression(name)));
    }
    let (length, records) = behind.split_first_chunk::<8>().ok_or_else(cut)?;
    if u64::from_le_bytes(*length) != records.len() as u64 {
        return Err(cut());
    }
    let (saved, calculated) = (u32::from_le_bytes(*saved), CRC.checksum(records));
    if saved != 0 && saved != calculated {
        return Err(McapError::File(::mcap::McapError::BadChunkCrc { saved, calculated }));
    }
    Ok(records)
}
