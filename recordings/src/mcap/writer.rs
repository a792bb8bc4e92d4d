//! Writes an MCAP file.

use alloc::borrow::Cow;
use alloc::collections::BTreeMap;
use core::fmt;
use std::io::{Seek, Write};
use std::sync::LazyLock;

use ::mcap::records::MessageHeader;
use ::mcap::{WriteOptions, Writer};
use fingertip_wrench::Wrench;

use super::compression::Compression;
use super::definitions::{CONTACT, Definition, SIGNALS, TOUCH, WRENCH};
use super::error::{McapError, writing};
use super::messages::{Header, Recorded, RecordedContact, RecordedSignals};
use super::touch::RecordedTouch;

/// What topics of messages of others are called in errors.
const OTHERS: &str = "messages of others";

/// A topic of a file that is being written, from the writer that made it.
///
/// ```
/// use fingertip_recordings::mcap::{McapError, McapWriter, RecordedSignals};
/// use fingertip_wrench::Wrench;
/// use std::io::Cursor;
///
/// let mut writer = McapWriter::new(Cursor::new(Vec::new()))?;
/// let wrenches = writer.wrenches("tip/wrench", "sensor")?;
/// writer.write_wrench(wrenches, 0.0, &Wrench::zero())?;
/// // A topic of wrenches takes no signals.
/// let refused = writer.write_signals(wrenches, 0.0, RecordedSignals::default()).unwrap_err();
/// assert!(matches!(refused, McapError::WrongTopic { .. }));
/// # Ok::<(), McapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Topic {
    index: usize,
    number: u16,
}

struct Channel {
    number: u16,
    frame: String,
    definition: &'static str,
    sequence: u32,
}

/// What the library writes by default. It looks in `/proc/cpuinfo` each time how many cores there are, which takes longer than
/// a short file.
static DEFAULT: LazyLock<WriteOptions> = LazyLock::new(WriteOptions::new);

/// How files are written here, with messages of this profile.
pub(super) fn options(compression: Compression, profile: &str) -> WriteOptions {
    let library = concat!("fingertip ", env!("CARGO_PKG_VERSION"));
    let options = DEFAULT.clone();
    // One thread: what packs must not take the time of what measures, nor memory by the number of cores.
    #[cfg(feature = "compression")]
    let options = options.compression_threads(0);
    options.compression(compression.of_library()).profile(profile).library(library)
}

/// Writes wrenches, signals and contacts. Call [`finish`](Self::finish): a file without its end can be
/// read, but has no index.
///
/// ```
/// use fingertip_recordings::mcap::{McapReader, McapWriter, Recorded};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
/// use std::io::Cursor;
///
/// let mut writer = McapWriter::new(Cursor::new(Vec::new()))?; // or a buffered file
/// let topic = writer.wrenches("tip/wrench", "sensor")?;
/// let pressed = Wrench::on_fingertip(Vector3::new(0.3, 0.0, -2.0), Vector3::zeros());
/// writer.write_wrench(topic, 0.0, &Wrench::zero())?;
/// writer.write_wrench(topic, 0.001, &pressed)?;
/// let file = writer.finish()?.into_inner();
///
/// let mut reader = McapReader::new(&file[..])?;
/// reader.next_entry()?;
/// assert_eq!(reader.next_entry()?.map(|entry| entry.recorded), Some(Recorded::Wrench(pressed)));
/// assert_eq!(reader.next_entry()?, None);
/// # Ok::<(), fingertip_recordings::mcap::McapError>(())
/// ```
pub struct McapWriter<W: Write + Seek> {
    writer: Writer<W>,
    channels: Vec<Channel>,
}

impl<W: Write + Seek> fmt::Debug for McapWriter<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("McapWriter").field("topics", &self.channels.len()).finish_non_exhaustive()
    }
}

impl<W: Write + Seek> McapWriter<W> {
    /// Begins a file. Put a [`std::io::BufWriter`] around one.
    ///
    /// # Errors
    /// [`McapError::Write`] or [`McapError::File`].
    pub fn new(out: W) -> Result<Self, McapError> {
        Self::with_compression(out, Compression::None)
    }

    /// Begins a file whose chunks are packed.
    ///
    /// # Errors
    /// [`McapError::Write`] or [`McapError::File`].
    pub fn with_compression(out: W, compression: Compression) -> Result<Self, McapError> {
        Ok(Self { writer: options(compression, "ros2").create(out).map_err(writing)?, channels: Vec::new() })
    }

    fn topic(&mut self, name: &str, frame: &str, definition: &Definition) -> Result<Topic, McapError> {
        let schema = self.writer.add_schema(definition.name, "ros2msg", definition.text.as_bytes());
        let number = self.writer.add_channel(schema.map_err(writing)?, name, "cdr", &BTreeMap::new());
        let number = number.map_err(writing)?;
        let frame = frame.to_owned();
        self.channels.push(Channel { number, frame, definition: definition.name, sequence: 0 });
        Ok(Topic { index: self.channels.len() - 1, number })
    }

    /// A topic of wrenches, in a frame of that name.
    ///
    /// # Errors
    /// [`McapError::Write`] or [`McapError::File`].
    pub fn wrenches(&mut self, name: &str, frame: &str) -> Result<Topic, McapError> {
        self.topic(name, frame, &WRENCH)
    }

    /// A topic of signals, of a sensor with a frame of that name.
    ///
    /// # Errors
    /// [`McapError::Write`] or [`McapError::File`].
    pub fn signals(&mut self, name: &str, frame: &str) -> Result<Topic, McapError> {
        self.topic(name, frame, &SIGNALS)
    }

    /// A topic of contacts, in a frame of that name.
    ///
    /// # Errors
    /// [`McapError::Write`] or [`McapError::File`].
    pub fn contacts(&mut self, name: &str, frame: &str) -> Result<Topic, McapError> {
        self.topic(name, frame, &CONTACT)
    }

    /// A topic of all that is felt, in a frame of that name.
    ///
    /// # Errors
    /// [`McapError::Write`] or [`McapError::File`].
    pub fn touches(&mut self, name: &str, frame: &str) -> Result<Topic, McapError> {
        self.topic(name, frame, &TOUCH)
    }

    /// A topic of messages of others, which are written as they are: `messages` says how they are encoded, such as `protobuf`,
    /// and the schema has a name, an encoding and a text of its own.
    ///
    /// # Errors
    /// [`McapError::File`].
    pub fn others(
        &mut self,
        name: &str,
        messages: &str,
        [schema, encoding]: [&str; 2],
        text: &[u8],
    ) -> Result<Topic, McapError> {
        let schema = self.writer.add_schema(schema, encoding, text)?;
        let number = self.writer.add_channel(schema, name, messages, &BTreeMap::new())?;
        self.channels.push(Channel { number, frame: String::new(), definition: OTHERS, sequence: 0 });
        Ok(Topic { index: self.channels.len() - 1, number })
    }

    /// Writes a message of others at a time \[s\].
    ///
    /// # Errors
    /// As [`write_wrench`](Self::write_wrench).
    pub fn write_other(&mut self, topic: Topic, time: f64, message: &[u8]) -> Result<(), McapError> {
        self.write(topic, time, OTHERS, |_| Cow::Borrowed(message))
    }

    /// Writes a wrench at a time \[s\].
    ///
    /// # Errors
    /// [`McapError::Time`], [`McapError::WrongTopic`], [`McapError::Write`] or [`McapError::File`].
    pub fn write_wrench(&mut self, topic: Topic, time: f64, wrench: &Wrench<f64>) -> Result<(), McapError> {
        self.record(topic, time, &WRENCH, &Recorded::Wrench(*wrench))
    }

    /// Writes signals at a time \[s\].
    ///
    /// # Errors
    /// As [`write_wrench`](Self::write_wrench).
    pub fn write_signals(
        &mut self,
        topic: Topic,
        time: f64,
        signals: RecordedSignals,
    ) -> Result<(), McapError> {
        self.record(topic, time, &SIGNALS, &Recorded::Signals(signals))
    }

    /// Writes a contact at a time \[s\].
    ///
    /// # Errors
    /// As [`write_wrench`](Self::write_wrench).
    pub fn write_contact(
        &mut self,
        topic: Topic,
        time: f64,
        contact: RecordedContact,
    ) -> Result<(), McapError> {
        self.record(topic, time, &CONTACT, &Recorded::Contact(contact))
    }

    /// Writes all that was felt at a time \[s\].
    ///
    /// # Errors
    /// As [`write_wrench`](Self::write_wrench).
    pub fn write_touch(&mut self, topic: Topic, time: f64, touch: RecordedTouch) -> Result<(), McapError> {
        self.record(topic, time, &TOUCH, &Recorded::Touch(touch))
    }

    fn record(
        &mut self,
        topic: Topic,
        time: f64,
        definition: &Definition,
        recorded: &Recorded,
    ) -> Result<(), McapError> {
        self.write(topic, time, definition.name, |header| Cow::Owned(recorded.emit(header)))
    }

    fn write<'a>(
        &mut self,
        topic: Topic,
        time: f64,
        what: &'static str,
        message: impl FnOnce(&Header) -> Cow<'a, [u8]>,
    ) -> Result<(), McapError> {
        let channel =
            self.channels.get_mut(topic.index).ok_or(McapError::WrongTopic { topic: topic.number, what })?;
        if channel.definition != what || channel.number != topic.number {
            return Err(McapError::WrongTopic { topic: topic.number, what });
        }
        let header = Header::stamped(time, &channel.frame).ok_or(McapError::Time { time })?;
        let log_time = header.log_time();
        let head = MessageHeader {
            channel_id: channel.number,
            sequence: channel.sequence,
            log_time,
            publish_time: log_time,
        };
        channel.sequence = channel.sequence.wrapping_add(1);
        self.writer.write_to_known_channel(&head, &message(&header)).map_err(writing)
    }

    /// Writes the index and the end, and gives the output back.
    ///
    /// # Errors
    /// [`McapError::Write`] or [`McapError::File`].
    pub fn finish(mut self) -> Result<W, McapError> {
        self.writer.finish().map_err(writing)?;
        Ok(self.writer.into_inner())
    }
}
