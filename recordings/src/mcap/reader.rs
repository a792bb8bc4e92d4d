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
