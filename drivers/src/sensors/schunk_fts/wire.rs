//! The bytes of datagrams and commands, little-endian.
//!
//! ```text
//! 0       2         4        6    7
//! ├───────┼─────────┼────────┼────┼──────────────────────────────┤
//! │ FF FF │ counter │ length │ id │ n × (i32 status, 6 × f32)    │
//! └───────┴─────────┴────────┴────┴──────────────────────────────┘
//!                             └──────── length bytes ────────────┘
//! ```
//! n is 1, or 16 at the highest rate. Forces are in N, torques in N·m.

use thiserror::Error;

/// Where the sensor sends datagrams to.
pub const UDP_PORT: u16 = 54843;
/// Where the sensor takes commands.
pub const TCP_PORT: u16 = 82;

const HEADER: [u8; 2] = [0xFF, 0xFF];

/// Bytes that are no message.
///
/// ```
/// use fingertip_drivers::sensors::schunk_fts::{Command, Packet};
///
/// let told = Packet::new_checked(&[0xFF, 0xFF, 0, 0, 29, 0, 1]).unwrap_err().to_string();
/// assert_eq!(told, "the message says 29 bytes and has 1");
/// let told = Command::parse(&[0xFF, 0xFF, 0, 0, 1, 0, 0x77]).unwrap_err().to_string();
/// assert_eq!(told, "0x77 is not a command");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FtsWireError {
    /// There are too few bytes for a header.
    #[error("{found} bytes are no message")]
    Short {
        /// Bytes there are.
        found: usize,
    },
    /// It does not start with FF FF.
    #[error("a message must start with 0xffff")]
    Header,
    /// The length in it is not that of what follows.
    #[error("the message says {stated} bytes and has {found}")]
    Length {
        /// What it says.
        stated: usize,
        /// What there is.
        found: usize,
    },
    /// What follows is not what is expected: not whole samples, or no answer to a command.
    #[error("a payload of {found} bytes is none that is known")]
    Payload {
        /// Its bytes.
        found: usize,
    },
    /// The command is not known here.
    #[error("{code:#04x} is not a command")]
    Command {
        /// The code.
        code: u8,
    },
}

/// Counter and payload of a message.
fn unframed(bytes: &[u8]) -> Result<(u16, &[u8]), FtsWireError> {
    let short = FtsWireError::Short { found: bytes.len() };
    let (&[h0, h1, c0, c1, l0, l1], payload) = bytes.split_first_chunk::<6>().ok_or(short)?;
    if [h0, h1] != HEADER {
        return Err(FtsWireError::Header);
    }
    let stated = usize::from(u16::from_le_bytes([l0, l1]));
    if stated != payload.len() {
        return Err(FtsWireError::Length { stated, found: payload.len() });
    }
    Ok((u16::from_le_bytes([c0, c1]), payload))
}

/// One sample of the sensor.
///
/// ```
/// use fingertip_drivers::sensors::schunk_fts::FtsSample;
///
/// let sample = FtsSample { status: FtsSample::READY, components: [0.0, 0.0, -2.0, 0.0, 0.0, 0.0] };
/// assert_eq!(sample.emit()[12..16], (-2.0_f32).to_le_bytes());
/// assert_eq!(FtsSample::parse(&sample.emit()), sample);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FtsSample {
    /// Status bits.
    pub status: u32,
    /// Fx, Fy, Fz \[N\], Tx, Ty, Tz \[N·m\] as the sensor gives them.
    pub components: [f32; 6],
}

impl FtsSample {
    /// Bytes of a sample.
    pub const LENGTH: usize = 28;
    /// Status bit: the sensor is ready.
    pub const READY: u32 = 1;
    /// Status bit: the numbers are invalid.
    pub const INVALID: u32 = 2;

    /// Reads a sample: any bytes are one.
    #[must_use]
    pub fn parse(bytes: &[u8; Self::LENGTH]) -> Self {
        let (words, _) = bytes.as_chunks::<4>();
        let word = |index: usize| words.get(index).copied().unwrap_or_default();
        let components = core::array::from_fn(|axis| f32::from_le_bytes(word(1 + axis)));
        Self { status: u32::from_le_bytes(word(0)), components }
    }

    /// The bytes of the sample.
    #[must_use]
    pub fn emit(&self) -> [u8; Self::LENGTH] {
        let mut bytes = [0; Self::LENGTH];
        let words = core::iter::once(self.status.to_le_bytes()).chain(self.components.map(f32::to_le_bytes));
        for (place, word) in bytes.as_chunks_mut().0.iter_mut().zip(words) {
            *place = word;
        }
        bytes
    }
}

/// A datagram of samples over its bytes, without a copy.
///
/// ```
/// use fingertip_drivers::sensors::schunk_fts::{FtsSample, Packet, emit_packet};
///
/// // Two samples in a datagram.
/// let mut buffer = [0; 128];
/// let length = emit_packet(7, 0, &[FtsSample::default(); 2], &mut buffer).unwrap();
/// let packet = Packet::new_checked(&buffer[..length])?;
/// assert_eq!((packet.counter(), packet.samples().len()), (7, 2));
/// # Ok::<(), fingertip_drivers::sensors::schunk_fts::FtsWireError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packet<'a> {
    counter: u16,
    id: u8,
    samples: &'a [[u8; FtsSample::LENGTH]],
}

impl<'a> Packet<'a> {
    /// A datagram whose header, length and number of samples are right.
    ///
    /// # Errors
    /// [`FtsWireError`].
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, FtsWireError> {
        let (counter, payload) = unframed(bytes)?;
        let wrong = FtsWireError::Payload { found: payload.len() };
        let (id, body) = payload.split_first().ok_or(wrong)?;
        let (samples, rest) = body.as_chunks();
        if samples.is_empty() || !rest.is_empty() {
            return Err(wrong);
        }
        Ok(Self { counter, id: *id, samples })
    }

    /// Number of the datagram; it wraps around.
    #[must_use]
    pub const fn counter(&self) -> u16 {
        self.counter
    }

    /// The packet's identifier, which counts, too.
    #[must_use]
    pub const fn id(&self) -> u8 {
        self.id
    }

    /// The samples, the oldest first.
    pub fn samples(&self) -> impl ExactSizeIterator<Item = FtsSample> + use<'a> {
        self.samples.iter().map(FtsSample::parse)
    }
}

/// Writes a datagram into a buffer, and says how many bytes it has; `None` if the buffer is too small, or
/// the samples are none or too many.
#[must_use]
pub fn emit_packet(counter: u16, id: u8, samples: &[FtsSample], buffer: &mut [u8]) -> Option<usize> {
    let length = 1 + samples.len() * FtsSample::LENGTH;
    let stated = u16::try_from(length).ok().filter(|_| !samples.is_empty())?;
    let place = buffer.get_mut(..6 + length)?;
    let head = HEADER.into_iter().chain(counter.to_le_bytes()).chain(stated.to_le_bytes()).chain([id]);
    let all = head.chain(samples.iter().flat_map(FtsSample::emit));
    for (place, byte) in place.iter_mut().zip(all) {
        *place = byte;
    }
    Some(6 + length)
}

/// What a client asks of the sensor.
///
/// ```
/// use fingertip_drivers::sensors::schunk_fts::Command;
///
/// assert_eq!(Command::StartUdp.emit(5), [0xFF, 0xFF, 5, 0, 1, 0, 0x40]);
/// assert_eq!(Command::parse(&Command::Tare.emit(6)), Ok((6, Command::Tare)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Command {
    /// Take the present load as zero.
    Tare,
    /// Forget the zero.
    ResetTare,
    /// Send datagrams.
    StartUdp,
    /// Send none.
    StopUdp,
}

impl Command {
    /// Bytes of a command.
    pub const LENGTH: usize = 7;

    const fn code(self) -> u8 {
        match self {
            Self::Tare => 0x12,
            Self::ResetTare => 0x13,
            Self::StartUdp => 0x40,
            Self::StopUdp => 0x41,
        }
    }

    const fn from_code(code: u8) -> Result<Self, FtsWireError> {
        Ok(match code {
            0x12 => Self::Tare,
            0x13 => Self::ResetTare,
            0x40 => Self::StartUdp,
            0x41 => Self::StopUdp,
            _ => return Err(FtsWireError::Command { code }),
        })
    }

    /// Reads a command and the counter in it.
    ///
    /// # Errors
    /// [`FtsWireError`].
    pub fn parse(bytes: &[u8]) -> Result<(u16, Self), FtsWireError> {
        let (counter, payload) = unframed(bytes)?;
        let &[code] = payload else { return Err(FtsWireError::Payload { found: payload.len() }) };
        Ok((counter, Self::from_code(code)?))
    }

    /// The bytes of the command.
    #[must_use]
    pub const fn emit(self, counter: u16) -> [u8; Self::LENGTH] {
        let [c0, c1] = counter.to_le_bytes();
        [0xFF, 0xFF, c0, c1, 1, 0, self.code()]
    }
}

/// What the sensor answers to a command.
///
/// ```
/// use fingertip_drivers::sensors::schunk_fts::{Command, CommandAnswer};
///
/// let (counter, answer) = CommandAnswer::parse(&[0xFF, 0xFF, 6, 0, 2, 0, 0x12, 0])?;
/// assert_eq!((counter, answer), (6, CommandAnswer { command: Command::Tare, error: 0 }));
/// # Ok::<(), fingertip_drivers::sensors::schunk_fts::FtsWireError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CommandAnswer {
    /// The command.
    pub command: Command,
    /// Zero if it was done.
    pub error: u8,
}

impl CommandAnswer {
    /// Bytes of an answer.
    pub const LENGTH: usize = 8;

    /// Reads an answer and the counter in it.
    ///
    /// # Errors
    /// [`FtsWireError`].
    pub fn parse(bytes: &[u8]) -> Result<(u16, Self), FtsWireError> {
        let (counter, payload) = unframed(bytes)?;
        let &[code, error] = payload else { return Err(FtsWireError::Payload { found: payload.len() }) };
        Ok((counter, Self { command: Command::from_code(code)?, error }))
    }

    /// The bytes of the answer.
    #[must_use]
    pub const fn emit(&self, counter: u16) -> [u8; Self::LENGTH] {
        let [c0, c1] = counter.to_le_bytes();
        [0xFF, 0xFF, c0, c1, 2, 0, self.command.code(), self.error]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bytes_are_those_of_the_published_client() {
        assert_eq!(Command::StartUdp.emit(0), [0xFF, 0xFF, 0, 0, 1, 0, 0x40]);
        let sample = FtsSample { status: 1, components: [1.0, 0.0, 0.0, 0.0, 0.0, -2.0] };
        let mut bytes = [0; 64];
        assert_eq!(emit_packet(12345, 7, &[sample], &mut bytes), Some(35));
        assert_eq!(bytes[..15], [0xFF, 0xFF, 0x39, 0x30, 29, 0, 7, 1, 0, 0, 0, 0, 0, 0x80, 0x3F]);
        assert_eq!(bytes[31..35], [0, 0, 0, 0xC0]);
        // Sixteen samples make 455 bytes; a buffer that is too small is not written to.
        let mut large = [0; 455];
        assert_eq!(emit_packet(0, 0, &[sample; 16], &mut large), Some(455));
        assert_eq!(emit_packet(0, 0, &[sample; 17], &mut large), None);
        assert_eq!(emit_packet(0, 0, &[], &mut large), None);
    }

    proptest! {
        #[test]
        fn a_datagram_is_read_as_it_was_written(
            counter in any::<u16>(), id in any::<u8>(),
            samples in prop::collection::vec((any::<u32>(), prop::array::uniform6(-1e6_f32..1e6)), 1..20),
        ) {
            let samples: Vec<FtsSample> =
                samples.into_iter().map(|(status, components)| FtsSample { status, components }).collect();
            let mut bytes = [0; 1000];
            let length = emit_packet(counter, id, &samples, &mut bytes).unwrap();
            let packet = Packet::new_checked(&bytes[..length]).unwrap();
            prop_assert_eq!((packet.counter(), packet.id()), (counter, id));
            prop_assert_eq!(packet.samples().collect::<Vec<_>>(), samples);
        }

        #[test]
        fn any_bytes_are_a_message_or_none(mut bytes in prop::collection::vec(any::<u8>(), 0..100), headed in any::<bool>()) {
            let length = bytes.len();
            if headed && length >= 6 {
                bytes[..2].copy_from_slice(&HEADER);
                bytes[4..6].copy_from_slice(&(length as u16 - 6).to_le_bytes());
            }
            if let Ok(packet) = Packet::new_checked(&bytes) {
                let again: Vec<u8> = packet.samples().flat_map(|sample| sample.emit()).collect();
                prop_assert_eq!(&again, &bytes[7..]);
            }
            if let Ok((counter, command)) = Command::parse(&bytes) {
                prop_assert_eq!(&command.emit(counter)[..], &bytes[..]);
            }
            if let Ok((counter, answer)) = CommandAnswer::parse(&bytes) {
                prop_assert_eq!(&answer.emit(counter)[..], &bytes[..]);
            }
        }

        #[test]
        fn commands_are_read_as_they_were_written(counter in any::<u16>(), error in any::<u8>(), which in 0_usize..4) {
            let command = [Command::Tare, Command::ResetTare, Command::StartUdp, Command::StopUdp][which];
            prop_assert_eq!(Command::parse(&command.emit(counter)), Ok((counter, command)));
            let answer = CommandAnswer { command, error };
            prop_assert_eq!(CommandAnswer::parse(&answer.emit(counter)), Ok((counter, answer)));
        }
    }
}
