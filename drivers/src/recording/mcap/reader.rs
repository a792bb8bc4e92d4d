//! Reads an MCAP file.

use alloc::borrow::Cow;
use core::fmt;

use ::mcap::parse_record;
use ::mcap::read::ChannelAccumulator;
use ::mcap::records::{MessageHeader, Record, op};
use ::mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::error::McapError;
use super::messages::{Header, Recorded};

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
    rest: &'a [u8],
    reader: LinearReader,
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
        // The library's own stream of messages does not look at the checksums of chunks. No record is
        // longer than the file, whatever a damaged length says.
        let options = LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_record_length_limit(file.len());
        let reader = LinearReader::new_with_options(options);
        Ok(Self { rest: file, reader, channels: ChannelAccumulator::default(), past_data: false })
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
            let Some(event) = self.reader.next_event() else { break };
            let (opcode, data) = match event? {
                LinearReadEvent::ReadRequest(need) => {
                    let length = need.min(self.rest.len());
                    let (bytes, rest) = self.rest.split_at_checked(length).unwrap_or_default();
                    if let Some(place) = self.reader.insert(length).get_mut(..length) {
                        place.copy_from_slice(bytes);
                    }
                    self.reader.notify_read(length);
                    self.rest = rest;
                    continue;
                }
                LinearReadEvent::Record { opcode, data } => (opcode, data),
            };
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
