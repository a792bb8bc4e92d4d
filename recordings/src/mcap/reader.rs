//! Reads an MCAP file.

use alloc::borrow::Cow;
use core::fmt;
use core::ops::Range;
use std::io::{self, Read};

use ::mcap::read::ChannelAccumulator;
use ::mcap::records::{MessageHeader, Record, op};
use ::mcap::{MAGIC, parse_record};
use crc::{CRC_32_ISO_HDLC, Crc};

use super::error::McapError;
use super::lengths;
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

/// The longest chunk, or message outside of one, that is read: 256 MiB. Writers make chunks of about one.
pub(super) const LONGEST: u64 = 1 << 28;

/// Reads the messages of a file in the order in which they stand there, holding one chunk at a time. Put a
/// [`BufReader`](std::io::BufReader) around a file. The checksum of a chunk is checked before anything in it is
/// given. A file that was cut is read up to the last whole chunk; the error comes behind it.
pub struct McapReader<R> {
    file: R,
    /// The contents of the record at hand, and where in it stand the records behind the one at hand, if it is a
    /// chunk.
    record: Vec<u8>,
    chunk: Range<usize>,
    channels: ChannelAccumulator<'static>,
    past_data: bool,
}

impl<R> fmt::Debug for McapReader<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("McapReader").field("chunk", &self.chunk).finish_non_exhaustive()
    }
}

impl<R: Read> McapReader<R> {
    /// Over a file, or the bytes of one.
    ///
    /// # Errors
    /// [`McapError::File`] if it is none.
    pub fn new(mut file: R) -> Result<Self, McapError> {
        let mut magic = [0; MAGIC.len()];
        match file.read_exact(&mut magic) {
            Ok(()) if magic == MAGIC => {}
            Err(error) if error.kind() != io::ErrorKind::UnexpectedEof => return Err(error_of(error)),
            _ => return Err(McapError::File(::mcap::McapError::BadMagic)),
        }
        let channels = ChannelAccumulator::default();
        Ok(Self { file, record: Vec::new(), chunk: 0..0, channels, past_data: false })
    }

    /// The next message, or `None` at the end. Behind an error of the file nothing more can be read.
    ///
    /// # Errors
    /// [`McapError::File`], [`McapError::Length`] or [`McapError::Message`].
    pub fn next_entry(&mut self) -> Result<Option<Entry>, McapError> {
        let next = self.next_message();
        if matches!(next, Err(McapError::File(_) | McapError::Length { .. })) {
            self.past_data = true;
        }
        next
    }

    fn next_message(&mut self) -> Result<Option<Entry>, McapError> {
        while !self.past_data {
            let (opcode, contents) = if self.chunk.is_empty() {
                self.read_record()?
            } else {
                next_record(&self.record, &mut self.chunk)?
            };
            let data = self.record.get(contents).unwrap_or_default();
            // Only what is used here is parsed: the library panics on an attachment whose length is wrong.
            lengths::check(opcode, data)?;
            match opcode {
                op::CHUNK if self.chunk.is_empty() => {
                    let length = checked_chunk(data)?.len();
                    // The records are the last field.
                    self.chunk = data.len() - length..data.len();
                }
                op::SCHEMA | op::CHANNEL | op::MESSAGE => match parse_record(opcode, data)? {
                    Record::Schema { header, data } => {
                        self.channels.add_schema(header, Cow::Owned(data.into_owned()))?;
                    }
                    Record::Channel(channel) => self.channels.add_channel(channel)?,
                    Record::Message { header, data } => {
                        return entry(&self.channels, &header, &data).map(Some);
                    }
                    _ => {}
                },
                // What follows are repetitions and the index.
                op::DATA_END => self.past_data = true,
                _ => {}
            }
        }
        Ok(None)
    }

    /// Takes the next record of the file: its kind, its length in eight bytes, and so many bytes, which are passed
    /// over if nobody looks at them.
    fn read_record(&mut self) -> Result<(u8, Range<usize>), McapError> {
        let mut head = [0; 9];
        self.file.read_exact(&mut head).map_err(error_of)?;
        let [opcode, length @ ..] = head;
        let length = u64::from_le_bytes(length);
        self.record.clear();
        let mut contents = Read::take(&mut self.file, length);
        let read = if ![op::SCHEMA, op::CHANNEL, op::MESSAGE, op::CHUNK].contains(&opcode) {
            io::copy(&mut contents, &mut io::sink())
        } else if length > LONGEST {
            return Err(McapError::File(::mcap::McapError::ChunkTooLarge(length)));
        } else {
            // It takes no more memory than there are bytes, whatever the length says.
            contents.read_to_end(&mut self.record).map(|read| read as u64)
        };
        if read.map_err(error_of)? < length {
            return Err(cut());
        }
        Ok((opcode, 0..self.record.len()))
    }
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

fn cut() -> McapError {
    McapError::File(::mcap::McapError::UnexpectedEof)
}

fn error_of(error: io::Error) -> McapError {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => cut(),
        _ => McapError::File(error.into()),
    }
}

/// Takes the next record of a chunk: its kind, and where its contents stand.
///
/// The library's own readers either do not look at the checksums of chunks or trust the lengths of the
/// records in them.
fn next_record(record: &[u8], chunk: &mut Range<usize>) -> Result<(u8, Range<usize>), McapError> {
    let rest = record.get(chunk.clone()).ok_or_else(cut)?;
    let (&[opcode, length @ ..], behind) = rest.split_first_chunk::<9>().ok_or_else(cut)?;
    let length = usize::try_from(u64::from_le_bytes(length)).map_err(|_| cut())?;
    let (contents, rest) = behind.split_at_checked(length).ok_or_else(cut)?;
    chunk.start = chunk.end - rest.len();
    Ok((opcode, chunk.start - contents.len()..chunk.start))
}

/// The records of a chunk whose checksum fits (zero means that there is none).
fn checked_chunk(chunk: &[u8]) -> Result<&[u8], McapError> {
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
