//! Reads the messages of an MCAP file.

use alloc::borrow::Cow;
use core::fmt;
use std::io::Read;

use ::mcap::parse_record;
use ::mcap::read::ChannelAccumulator;
use ::mcap::records::{MessageHeader, Record, op};

use super::error::McapError;
use super::lengths;
use super::messages::{Header, Recorded};
use super::records::Records;

/// One message of a file.
///
/// ```
/// use fingertip_recordings::mcap::{McapReader, McapWriter, Recorded};
/// use fingertip_wrench::Wrench;
/// use std::io::Cursor;
///
/// let mut writer = McapWriter::new(Cursor::new(Vec::new()))?;
/// let topic = writer.wrenches("tip/wrench", "sensor")?;
/// writer.write_wrench(topic, 1.5, &Wrench::zero())?;
/// let file = writer.finish()?.into_inner();
/// let entry = McapReader::new(&file[..])?.next_entry()?.unwrap();
/// assert_eq!((entry.topic.as_str(), entry.frame.as_str(), entry.time), ("tip/wrench", "sensor", 1.5));
/// assert_eq!(entry.recorded, Recorded::Wrench(Wrench::zero()));
/// # Ok::<(), fingertip_recordings::mcap::McapError>(())
/// ```
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

/// Reads the messages of a file in the order in which they stand there, holding one chunk at a time. Put a
/// [`BufReader`](std::io::BufReader) around a file. The checksum of a chunk is checked before anything in it is
/// given. A file that was cut is read up to the last whole message, that of a chunk without its end too; the error comes
/// behind it.
///
/// ```
/// use fingertip_recordings::mcap::{McapError, McapReader, McapWriter};
/// use fingertip_wrench::Wrench;
/// use std::io::Cursor;
///
/// let mut writer = McapWriter::new(Cursor::new(Vec::new()))?;
/// let topic = writer.wrenches("tip/wrench", "sensor")?;
/// for i in 0..1000 {
///     writer.write_wrench(topic, f64::from(i) * 1e-3, &Wrench::zero())?;
/// }
/// let file = writer.finish()?.into_inner();
/// // The recorder was killed: all whole messages are read, and then it is said that something is missing.
/// let mut reader = McapReader::new(&file[..file.len() / 2])?;
/// let cut = loop {
///     match reader.next_entry() {
///         Ok(entry) => assert!(entry.is_some()),
///         Err(error) => break error,
///     }
/// };
/// assert!(matches!(cut, McapError::Cut) && reader.messages() > 300);
/// # Ok::<(), McapError>(())
/// ```
pub struct McapReader<R> {
    records: Records<R>,
    channels: ChannelAccumulator<'static>,
    messages: u64,
    past_data: bool,
}

impl<R> fmt::Debug for McapReader<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let left = self.records.left_of_chunk();
        f.debug_struct("McapReader").field("left_of_chunk", &left).finish_non_exhaustive()
    }
}

impl<R> McapReader<R> {
    /// How many messages were given, of whatever type.
    #[must_use]
    pub const fn messages(&self) -> u64 {
        self.messages
    }
}

impl<R: Read> McapReader<R> {
    /// Over a file, or the bytes of one.
    ///
    /// # Errors
    /// [`McapError::File`] if it is none.
    pub fn new(file: R) -> Result<Self, McapError> {
        let (records, channels) = (Records::new(file)?, ChannelAccumulator::default());
        Ok(Self { records, channels, messages: 0, past_data: false })
    }

    /// The next message, or `None` at the end. Behind an error of the file nothing more can be read.
    ///
    /// # Errors
    /// [`McapError::Cut`], behind all messages that are whole; [`McapError::File`], [`McapError::Length`] or
    /// [`McapError::Message`].
    pub fn next_entry(&mut self) -> Result<Option<Entry>, McapError> {
        let next = self.next_message();
        if matches!(next, Err(McapError::File(_) | McapError::Length { .. } | McapError::Cut)) {
            self.past_data = true;
        }
        next
    }

    fn next_message(&mut self) -> Result<Option<Entry>, McapError> {
        while !self.past_data
            && let Some((opcode, data)) = self.records.next()?
        {
            // Only what is used here is parsed: the library panics on an attachment whose length is wrong.
            lengths::check(opcode, data)?;
            if ![op::SCHEMA, op::CHANNEL, op::MESSAGE].contains(&opcode) {
                continue;
            }
            match parse_record(opcode, data)? {
                Record::Schema { header, data } => {
                    self.channels.add_schema(header, Cow::Owned(data.into_owned()))?;
                }
                Record::Channel(channel) => self.channels.add_channel(channel)?,
                Record::Message { header, data } => {
                    self.messages += 1;
                    return entry(&self.channels, &header, &data).map(Some);
                }
                _ => {}
            }
        }
        Ok(None)
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
