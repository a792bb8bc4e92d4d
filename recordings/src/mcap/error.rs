//! What can be wrong with an MCAP file.

use thiserror::Error;

use super::cdr::CdrError;

/// Why an MCAP file cannot be read or written.
///
/// ```
/// use fingertip_recordings::mcap::{McapError, McapWriter};
/// use fingertip_wrench::Wrench;
/// use std::io::Cursor;
///
/// let mut writer = McapWriter::new(Cursor::new(Vec::new()))?;
/// let topic = writer.wrenches("tip/wrench", "sensor")?;
/// let refused = writer.write_wrench(topic, -1.0, &Wrench::zero()).unwrap_err();
/// assert!(matches!(refused, McapError::Time { time: -1.0 }));
/// assert_eq!(refused.to_string(), "-1 s cannot be written: times are from 0 to 2147483647 s");
/// assert!(!refused.is_transport());
/// # Ok::<(), McapError>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum McapError {
    /// The file ends before it says that it does: it was cut, or its recorder was killed.
    #[error("the file ends in the middle: it was cut, or its recorder was killed")]
    Cut,
    /// The file is damaged or packed in a way that is not read, or the system refuses.
    #[error("MCAP: {}", said(.0))]
    File(#[from] ::mcap::McapError),
    /// A length in a record is beyond its bytes.
    #[error("MCAP: {what} says {stated} bytes where {found} are left")]
    Length {
        /// What it is the length of.
        what: &'static str,
        /// What it says.
        stated: u32,
        /// Bytes that are left of the record.
        found: usize,
    },
    /// A message is not what its definition says.
    #[error("a message of topic {topic}: {source}")]
    Message {
        /// Its topic.
        topic: String,
        /// What is wrong.
        source: CdrError,
    },
    /// A time that cannot be written.
    #[error("{time} s cannot be written: times are from 0 to 2147483647 s")]
    Time {
        /// The time \[s\].
        time: f64,
    },
    /// A topic was made for other messages.
    #[error("topic number {topic} is not for {what}")]
    WrongTopic {
        /// Its number.
        topic: u16,
        /// What was to be written.
        what: &'static str,
    },
    /// There are no wrenches, or several topics of them and none was chosen.
    #[error("choose a topic with wrenches; there are: {known}")]
    ChooseTopic {
        /// Their names.
        known: String,
    },
}

impl McapError {
    /// `true` if the system refused to read or write, `false` if it is the file.
    #[must_use]
    pub const fn is_transport(&self) -> bool {
        matches!(self, Self::File(::mcap::McapError::Io(_)))
    }
}

impl From<std::io::Error> for McapError {
    fn from(error: std::io::Error) -> Self {
        Self::File(error.into())
    }
}

/// What the library says, or what the system has told it.
fn said(error: &::mcap::McapError) -> String {
    match error {
        ::mcap::McapError::Io(refused) => refused.to_string(),
        other => other.to_string(),
    }
}
