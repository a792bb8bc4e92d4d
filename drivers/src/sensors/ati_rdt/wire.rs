//! The bytes of requests and records, big-endian.

use thiserror::Error;

/// What a client asks of the sensor.
///
/// ```
/// use fingertip_drivers::sensors::ati_rdt::{Command, Request};
///
/// let request = Request { command: Command::Bias, count: 0 };
/// assert_eq!(request.emit()[2..4], [0, 0x42]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Command {
    /// Stop streaming.
    Stop,
    /// Stream records, one to a datagram, as fast as the sensor's RDT rate.
    Stream,
    /// Stream records, several to a datagram.
    StreamBuffered,
    /// Take the present load as zero. The sensor forgets its former zero.
    Bias,
}

impl Command {
    const fn code(self) -> u16 {
        match self {
            Self::Stop => 0,
            Self::Stream => 2,
            Self::StreamBuffered => 3,
            Self::Bias => 0x42,
        }
    }

    const fn from_code(code: u16) -> Option<Self> {
        Some(match code {
            0 => Self::Stop,
            2 => Self::Stream,
            3 => Self::StreamBuffered,
            0x42 => Self::Bias,
            _ => return None,
        })
    }
}

/// Bytes that are no RDT message.
///
/// ```
/// use fingertip_drivers::sensors::ati_rdt::{RecordPacket, Request};
///
/// let told = RecordPacket::new_checked(&[0; 30]).unwrap_err().to_string();
/// assert_eq!(told, "30 bytes where 36 (or a multiple, for records) are a message");
/// let told = Request::parse(&[0; 8]).unwrap_err().to_string();
/// assert_eq!(told, "a request must start with 0x1234, not 0x0000");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum WireError {
    /// The length is wrong.
    #[error("{found} bytes where {expected} (or a multiple, for records) are a message")]
    Length {
        /// Bytes of one message.
        expected: usize,
        /// Bytes there are.
        found: usize,
    },
    /// A request does not start with 0x1234.
    #[error("a request must start with 0x1234, not {found:#06x}")]
    Header {
        /// What it starts with.
        found: u16,
    },
    /// The command is not known.
    #[error("{code:#06x} is not a command of RDT")]
    Command {
        /// The code.
        code: u16,
    },
}

/// A request, 8 bytes.
///
/// ```
/// use fingertip_drivers::sensors::ati_rdt::{Command, Request};
///
/// let request = Request { command: Command::Stream, count: 0 };
/// assert_eq!(request.emit(), [0x12, 0x34, 0, 2, 0, 0, 0, 0]);
/// assert_eq!(Request::parse(&request.emit()), Ok(request));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// What is asked for.
    pub command: Command,
    /// How many records to send; 0 for no end.
    pub count: u32,
}

impl Request {
    /// Bytes of a request.
    pub const LENGTH: usize = 8;
    const HEADER: u16 = 0x1234;

    /// Reads a request.
    ///
    /// # Errors
    /// [`WireError`].
    pub fn parse(bytes: &[u8]) -> Result<Self, WireError> {
        let wrong = WireError::Length { expected: Self::LENGTH, found: bytes.len() };
        let &[h0, h1, c0, c1, n0, n1, n2, n3] = bytes else { return Err(wrong) };
        let header = u16::from_be_bytes([h0, h1]);
        if header != Self::HEADER {
            return Err(WireError::Header { found: header });
        }
        let code = u16::from_be_bytes([c0, c1]);
        let command = Command::from_code(code).ok_or(WireError::Command { code })?;
        Ok(Self { command, count: u32::from_be_bytes([n0, n1, n2, n3]) })
    }

    /// The bytes of the request.
    #[must_use]
    pub const fn emit(&self) -> [u8; Self::LENGTH] {
        let [h0, h1] = Self::HEADER.to_be_bytes();
        let [c0, c1] = self.command.code().to_be_bytes();
        let [n0, n1, n2, n3] = self.count.to_be_bytes();
        [h0, h1, c0, c1, n0, n1, n2, n3]
    }
}

/// One record over the bytes of a datagram, without a copy.
///
/// ```
/// use fingertip_drivers::sensors::ati_rdt::{Record, RecordPacket};
///
/// let datagram = Record { rdt_sequence: 7, counts: [0, 0, -5, 0, 0, 0], ..Record::default() }.emit();
/// let packet = RecordPacket::new_checked(&datagram)?;
/// assert_eq!((packet.rdt_sequence(), packet.status(), packet.counts()[2]), (7, 0, -5));
/// # Ok::<(), fingertip_drivers::sensors::ati_rdt::WireError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordPacket<'a> {
    bytes: &'a [u8; Record::LENGTH],
}

impl<'a> RecordPacket<'a> {
    /// A record over exactly its bytes.
    ///
    /// # Errors
    /// [`WireError::Length`].
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, WireError> {
        let wrong = WireError::Length { expected: Record::LENGTH, found: bytes.len() };
        bytes.try_into().map(|bytes| Self { bytes }).map_err(|_| wrong)
    }

    fn word(&self, index: usize) -> [u8; 4] {
        self.bytes.as_chunks().0.get(index).copied().unwrap_or_default()
    }

    /// Number of the record since streaming began; the first one is 1, and it wraps around.
    #[must_use]
    pub fn rdt_sequence(&self) -> u32 {
        u32::from_be_bytes(self.word(0))
    }

    /// Number of the sensor's internal sample.
    #[must_use]
    pub fn ft_sequence(&self) -> u32 {
        u32::from_be_bytes(self.word(1))
    }

    /// Status of the sensor: zero if all is well.
    #[must_use]
    pub fn status(&self) -> u32 {
        u32::from_be_bytes(self.word(2))
    }

    /// Counts of Fx, Fy, Fz, Tx, Ty, Tz.
    #[must_use]
    pub fn counts(&self) -> [i32; 6] {
        core::array::from_fn(|axis| i32::from_be_bytes(self.word(3 + axis)))
    }
}

/// One record, 36 bytes.
///
/// ```
/// use fingertip_drivers::sensors::ati_rdt::{Record, records};
///
/// let record = |rdt_sequence| Record { rdt_sequence, ..Record::default() };
/// // Two of them in one datagram.
/// let datagram = [record(1).emit(), record(2).emit()].concat();
/// let found: Vec<_> = records(&datagram)?.map(|packet| Record::parse(&packet)).collect();
/// assert_eq!(found, [record(1), record(2)]);
/// # Ok::<(), fingertip_drivers::sensors::ati_rdt::WireError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Record {
    /// Number of the record since streaming began.
    pub rdt_sequence: u32,
    /// Number of the sensor's internal sample.
    pub ft_sequence: u32,
    /// Status of the sensor: zero if all is well.
    pub status: u32,
    /// Counts of Fx, Fy, Fz, Tx, Ty, Tz.
    pub counts: [i32; 6],
}

impl Record {
    /// Bytes of a record.
    pub const LENGTH: usize = 36;

    /// Reads a record.
    #[must_use]
    pub fn parse(packet: &RecordPacket<'_>) -> Self {
        Self {
            rdt_sequence: packet.rdt_sequence(),
            ft_sequence: packet.ft_sequence(),
            status: packet.status(),
            counts: packet.counts(),
        }
    }

    /// The bytes of the record.
    #[must_use]
    pub fn emit(&self) -> [u8; Self::LENGTH] {
        let mut bytes = [0; Self::LENGTH];
        let head = [self.rdt_sequence, self.ft_sequence, self.status].map(u32::to_be_bytes);
        let words = head.into_iter().chain(self.counts.map(i32::to_be_bytes));
        for (place, word) in bytes.as_chunks_mut().0.iter_mut().zip(words) {
            *place = word;
        }
        bytes
    }
}

/// The records of a datagram, one or several.
///
/// # Errors
/// [`WireError::Length`] unless the datagram is one or more whole records.
pub fn records(datagram: &[u8]) -> Result<impl ExactSizeIterator<Item = RecordPacket<'_>>, WireError> {
    let (whole, rest) = datagram.as_chunks::<{ Record::LENGTH }>();
    if whole.is_empty() || !rest.is_empty() {
        return Err(WireError::Length { expected: Record::LENGTH, found: datagram.len() });
    }
    Ok(whole.iter().map(|bytes| RecordPacket { bytes }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bytes_are_those_of_the_manual() {
        let start = Request { command: Command::Stream, count: 0 };
        assert_eq!(start.emit(), [0x12, 0x34, 0, 2, 0, 0, 0, 0]);
        let bias = Request { command: Command::Bias, count: 0 };
        assert_eq!(bias.emit(), [0x12, 0x34, 0, 0x42, 0, 0, 0, 0]);
        let record =
            Record { rdt_sequence: 1, ft_sequence: 0x0102_0304, status: 0, counts: [1, -1, 256, 0, 0, -2] };
        let bytes = record.emit();
        assert_eq!(bytes[..12], [0, 0, 0, 1, 1, 2, 3, 4, 0, 0, 0, 0]);
        assert_eq!(bytes[12..24], [0, 0, 0, 1, 255, 255, 255, 255, 0, 0, 1, 0]);
        assert_eq!(bytes[32..], [255, 255, 255, 254]);
    }

    proptest! {
        #[test]
        fn a_record_is_read_as_it_was_written(
            rdt_sequence in any::<u32>(), ft_sequence in any::<u32>(), status in any::<u32>(), counts in any::<[i32; 6]>(),
        ) {
            let record = Record { rdt_sequence, ft_sequence, status, counts };
            let bytes = record.emit();
            prop_assert_eq!(Record::parse(&RecordPacket::new_checked(&bytes).unwrap()), record);
        }

        #[test]
        fn any_bytes_are_records_or_none(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            match records(&bytes) {
                Ok(records) => {
                    prop_assert_eq!(records.len() * Record::LENGTH, bytes.len());
                    let again: Vec<u8> = records.flat_map(|packet| Record::parse(&packet).emit()).collect();
                    prop_assert_eq!(&again, &bytes);
                }
                Err(_) => prop_assert!(bytes.is_empty() || bytes.len() % Record::LENGTH != 0),
            }
            if let Ok(request) = Request::parse(&bytes) {
                prop_assert_eq!(&request.emit()[..], &bytes[..]);
            }
        }

        #[test]
        fn a_request_is_read_as_it_was_written(
            command in prop::sample::select(vec![Command::Stop, Command::Stream, Command::StreamBuffered, Command::Bias]),
            count in any::<u32>(),
        ) {
            let request = Request { command, count };
            prop_assert_eq!(Request::parse(&request.emit()), Ok(request));
        }
    }
}
