//! What a damaged file still holds, as a whole one.

use alloc::collections::BTreeMap;
use std::io::{Read, Seek, Write};

use ::mcap::Writer;
use ::mcap::records::{Record, SchemaHeader, op};
use ::mcap::{McapError as FileError, parse_record};

use super::compression::Compression;
use super::error::McapError;
use super::lengths;
use super::records::Records;
use super::writer::options;

/// What was recovered, and what was not.
///
/// ```
/// use fingertip_recordings::mcap::{Compression, McapWriter, recover};
/// use fingertip_wrench::Wrench;
/// use std::io::Cursor;
///
/// let mut writer = McapWriter::new(Cursor::new(Vec::new()))?;
/// let topic = writer.wrenches("tip/wrench", "sensor")?;
/// for i in 0..1000 {
///     writer.write_wrench(topic, f64::from(i) * 1e-3, &Wrench::zero())?;
/// }
/// let file = writer.finish()?.into_inner();
/// let half = &file[..file.len() / 2];
/// let (recovered, _) = recover(half, Cursor::new(Vec::new()), Compression::default())?;
/// assert!(recovered.cut && recovered.damaged_chunks == 0);
/// assert_eq!(recovered.topics["tip/wrench"], recovered.messages);
/// # Ok::<(), fingertip_recordings::mcap::McapError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Recovered {
    /// Messages that were written anew.
    pub messages: u64,
    /// Their topics, and how many messages each has.
    pub topics: BTreeMap<String, u64>,
    /// The file ended in the middle.
    pub cut: bool,
    /// Chunks that are damaged, of which nothing was taken.
    pub damaged_chunks: u64,
    /// Records outside of damaged chunks that cannot be read, and messages of channels that nothing describes.
    pub damaged_records: u64,
}

/// Copies all messages that are whole, of every type, with their topics, times and definitions, into a new file with
/// an index. Attachments and metadata are not copied.
///
/// # Errors
/// [`McapError::File`] if the input is no MCAP file, or the system refuses.
pub fn recover<R: Read, W: Write + Seek>(
    from: R,
    to: W,
    compression: Compression,
) -> Result<(Recovered, W), McapError> {
    let mut records = Records::new(from)?;
    let mut copy = Copy { compression, to: Some(to), ..Copy::default() };
    loop {
        match records.next() {
            Ok(None) => break,
            Ok(Some((opcode, contents))) => copy.record(opcode, contents)?,
            Err(McapError::Cut) => copy.recovered.cut = true,
            Err(McapError::File(FileError::Io(error))) => return Err(error.into()),
            Err(McapError::File(FileError::UnsupportedCompression(name))) => {
                return Err(McapError::File(FileError::UnsupportedCompression(name)));
            }
            Err(_) => copy.recovered.damaged_chunks += 1,
        }
    }
    copy.finish()
}

/// A file that is being copied.
struct Copy<W: Write + Seek> {
    compression: Compression,
    profile: String,
    /// Until the first record tells the profile.
    to: Option<W>,
    writer: Option<Writer<W>>,
    /// Numbers in the copy by those in the original; schema 0 is none.
    schemas: BTreeMap<u16, u16>,
    channels: BTreeMap<u16, (u16, String)>,
    recovered: Recovered,
}

impl<W: Write + Seek> Default for Copy<W> {
    fn default() -> Self {
        Self {
            compression: Compression::None,
            profile: String::new(),
            to: None,
            writer: None,
            schemas: BTreeMap::from([(0, 0)]),
            channels: BTreeMap::new(),
            recovered: Recovered::default(),
        }
    }
}

impl<W: Write + Seek> Copy<W> {
    /// Takes over a record, or counts it as damaged.
    fn record(&mut self, opcode: u8, contents: &[u8]) -> Result<(), McapError> {
        if opcode == op::HEADER {
            if let Some(profile) = lengths::first_string(contents) {
                profile.clone_into(&mut self.profile);
            }
            return Ok(());
        }
        let parsed = lengths::check(opcode, contents).and_then(|()| Ok(parse_record(opcode, contents)?));
        let copied = match parsed {
            Ok(record) => self.copy(record)?,
            Err(_) => false,
        };
        self.recovered.damaged_records += u64::from(!copied);
        Ok(())
    }

    fn writer(&mut self) -> Result<&mut Writer<W>, McapError> {
        if let Some(to) = self.to.take() {
            self.writer = Some(options(self.compression, &self.profile).create(to)?);
        }
        // There is one or the other.
        self.writer.as_mut().ok_or(McapError::Cut)
    }

    /// `false` for what nothing describes.
    fn copy(&mut self, record: Record<'_>) -> Result<bool, McapError> {
        match record {
            Record::Schema { header: SchemaHeader { id, name, encoding }, data } => {
                let number = self.writer()?.add_schema(&name, &encoding, &data)?;
                self.schemas.insert(id, number);
            }
            Record::Channel(channel) => {
                let Some(&schema) = self.schemas.get(&channel.schema_id) else { return Ok(false) };
                let (topic, encoding) = (&channel.topic, &channel.message_encoding);
                let number = self.writer()?.add_channel(schema, topic, encoding, &channel.metadata)?;
                self.channels.insert(channel.id, (number, channel.topic));
            }
            Record::Message { mut header, data } => {
                let Some((number, topic)) = self.channels.get(&header.channel_id) else { return Ok(false) };
                header.channel_id = *number;
                let topic = topic.clone();
                self.writer()?.write_to_known_channel(&header, &data)?;
                self.recovered.messages += 1;
                *self.recovered.topics.entry(topic).or_default() += 1;
            }
            _ => {}
        }
        Ok(true)
    }

    fn finish(mut self) -> Result<(Recovered, W), McapError> {
        self.writer()?.finish()?;
        let writer = self.writer.ok_or(McapError::Cut)?;
        Ok((self.recovered, writer.into_inner()))
    }
}
