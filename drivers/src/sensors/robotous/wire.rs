//! The bytes of requests and readings; numbers are big-endian.
//!
//! ```text
//! 0     1     2                  14         15         17    18
//! ├─────┼─────┼──────────────────┼──────────┼──────────┼─────┼─────┤
//! │ 55  │ id  │ 6 × i16 counts   │ overload │ reserved │ sum │ AA  │   serial line: 19 bytes
//! └─────┴─────┴──────────────────┴──────────┴──────────┴─────┴─────┘
//!        └──────────── 16 bytes: two CAN frames of 8 ──┘
//! ```
//! The sum is that of the 16 bytes, without carry.

use crate::sensors::line::FrameFormat;

const START: u8 = 0x55;
const END: u8 = 0xAA;

/// One reading of the six axes.
///
/// ```
/// use fingertip_drivers::sensors::robotous::Reading;
///
/// let reading = Reading { streamed: true, counts: [0, 0, -100, 0, 0, 0], overload: 0 };
/// assert_eq!(Reading::parse(&reading.emit()), Some(reading));
/// let frame = reading.emit_serial();
/// assert_eq!((frame[0], frame[1], frame[18]), (0x55, 0x0B, 0xAA));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Whether it answers [`Request::Stream`] (or else [`Request::Single`]).
    pub streamed: bool,
    /// Counts of Fx, Fy, Fz, Tx, Ty, Tz.
    pub counts: [i16; 6],
    /// The overload byte: zero if no axis is overloaded.
    pub overload: u8,
}

impl Reading {
    /// Bytes of a reading without its frame.
    pub const LENGTH: usize = 16;
    /// Bytes of its frame on a serial line.
    pub const SERIAL_LENGTH: usize = 19;

    /// Reads the 16 bytes; `None` if they answer another request.
    #[must_use]
    pub fn parse(bytes: &[u8; Self::LENGTH]) -> Option<Self> {
        let [id, counts @ .., overload, _, _] = bytes;
        let streamed = match *id {
            Request::STREAM => true,
            Request::SINGLE => false,
            _ => return None,
        };
        let word = |axis: usize| counts.as_chunks::<2>().0.get(axis).copied().unwrap_or_default();
        let counts = core::array::from_fn(|axis| i16::from_be_bytes(word(axis)));
        Some(Self { streamed, counts, overload: *overload })
    }

    /// The 16 bytes.
    #[must_use]
    pub fn emit(&self) -> [u8; Self::LENGTH] {
        let mut bytes = [0; Self::LENGTH];
        let id = if self.streamed { Request::STREAM } else { Request::SINGLE };
        let counts = self.counts.into_iter().flat_map(i16::to_be_bytes);
        for (place, byte) in bytes.iter_mut().zip(core::iter::once(id).chain(counts).chain([self.overload])) {
            *place = byte;
        }
        bytes
    }

    /// The frame on a serial line.
    #[must_use]
    pub fn emit_serial(&self) -> [u8; Self::SERIAL_LENGTH] {
        framed(&self.emit())
    }
}

/// Puts data between start, sum and end.
fn framed<const DATA: usize, const ALL: usize>(data: &[u8; DATA]) -> [u8; ALL] {
    let mut bytes = [0; ALL];
    let all = core::iter::once(START).chain(*data).chain([sum(data), END]);
    for (place, byte) in bytes.iter_mut().zip(all) {
        *place = byte;
    }
    bytes
}

fn sum(data: &[u8]) -> u8 {
    data.iter().fold(0, |sum: u8, byte| sum.wrapping_add(*byte))
}

/// What a client asks of the sensor.
///
/// ```
/// use fingertip_drivers::sensors::robotous::Request;
///
/// assert_eq!(Request::Stream.emit_serial(), [0x55, 0x0B, 0, 0, 0, 0, 0, 0, 0, 0x0B, 0xAA]);
/// assert_eq!(Request::parse(&[0x11, 1, 0, 0, 0, 0, 0, 0]), Some(Request::Bias { set: true }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Request {
    /// One reading.
    Single,
    /// Readings without end.
    Stream,
    /// No more readings.
    Stop,
    /// Take the present load as zero, or forget the zero.
    Bias {
        /// Whether to set it.
        set: bool,
    },
}

impl Request {
    /// Bytes of a request on CAN: the data of one frame.
    pub const LENGTH: usize = 8;
    /// Bytes of a request on a serial line.
    pub const SERIAL_LENGTH: usize = 11;
    const SINGLE: u8 = 0x0A;
    const STREAM: u8 = 0x0B;
    const STOP: u8 = 0x0C;
    const BIAS: u8 = 0x11;

    /// Reads a request; `None` for one that is not known here.
    #[must_use]
    pub const fn parse(bytes: &[u8; Self::LENGTH]) -> Option<Self> {
        let [id, option, ..] = *bytes;
        Some(match id {
            Self::SINGLE => Self::Single,
            Self::STREAM => Self::Stream,
            Self::STOP => Self::Stop,
            Self::BIAS => Self::Bias { set: option != 0 },
            _ => return None,
        })
    }

    /// Reads a frame on a serial line; `None` if its marks or its sum are wrong, or the request is not known
    /// here.
    #[must_use]
    pub fn parse_serial(bytes: &[u8; Self::SERIAL_LENGTH]) -> Option<Self> {
        let [START, data @ .., checksum, END] = bytes else { return None };
        (sum(data) == *checksum).then(|| Self::parse(data)).flatten()
    }

    /// The data of a CAN frame.
    #[must_use]
    pub const fn emit(self) -> [u8; Self::LENGTH] {
        let (id, option) = match self {
            Self::Single => (Self::SINGLE, 0),
            Self::Stream => (Self::STREAM, 0),
            Self::Stop => (Self::STOP, 0),
            Self::Bias { set } => (Self::BIAS, set as u8),
        };
        [id, option, 0, 0, 0, 0, 0, 0]
    }

    /// The frame on a serial line.
    #[must_use]
    pub fn emit_serial(self) -> [u8; Self::SERIAL_LENGTH] {
        framed(&self.emit())
    }
}

/// How readings look on a serial line, for a [`Deframer`](crate::sensors::line::Deframer).
pub const FORMAT: FrameFormat<Reading, { Reading::SERIAL_LENGTH }> = FrameFormat {
    may_begin: |start| {
        match start {
            [] => true,
            [first] => *first == START,
            // Answers to other requests are passed over as bytes of no frame.
            [first, id, ..] => *first == START && matches!(*id, Request::SINGLE | Request::STREAM),
        }
    },
    frame: |bytes| {
        let [START, data @ .., checksum, END] = bytes else { return None };
        (sum(data) == *checksum).then(|| Reading::parse(data)).flatten()
    },
};

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bytes_are_those_of_the_published_examples() {
        assert_eq!(Request::Stream.emit_serial(), [0x55, 0x0B, 0, 0, 0, 0, 0, 0, 0, 0x0B, 0xAA]);
        assert_eq!(Request::Bias { set: true }.emit_serial(), [0x55, 0x11, 1, 0, 0, 0, 0, 0, 0, 0x12, 0xAA]);
        for request in [Request::Single, Request::Stream, Request::Stop, Request::Bias { set: false }] {
            let mut bytes = request.emit_serial();
            assert_eq!(Request::parse_serial(&bytes), Some(request));
            bytes[3] ^= 1;
            assert_eq!(Request::parse_serial(&bytes), None);
        }
        let reading = Reading { streamed: true, counts: [1, -1, 256, 0, 0, -2], overload: 3 };
        let expected = [0x55, 0x0B, 0, 1, 255, 255, 1, 0, 0, 0, 0, 0, 255, 254, 3, 0, 0, 0x0B, 0xAA];
        assert_eq!(reading.emit_serial()[..17], expected[..17]);
        let expected_sum = 0x0B + 1 + 255 + 255 + 1 + 255 + 254 + 3;
        assert_eq!(reading.emit_serial()[17], (expected_sum % 256) as u8);
    }

    proptest! {
        #[test]
        fn a_reading_is_read_as_it_was_written(streamed in any::<bool>(), counts in any::<[i16; 6]>(), overload in any::<u8>()) {
            let reading = Reading { streamed, counts, overload };
            prop_assert_eq!(Reading::parse(&reading.emit()), Some(reading));
            prop_assert_eq!((FORMAT.frame)(&reading.emit_serial()), Some(reading));
        }

        #[test]
        fn any_bytes_are_a_reading_or_none(bytes in any::<[u8; 19]>(), request in any::<[u8; 8]>()) {
            if let Some(reading) = (FORMAT.frame)(&bytes) {
                prop_assert_eq!(&reading.emit_serial()[..15], &bytes[..15]);
            }
            if let Some(request) = Request::parse(&request) {
                prop_assert_eq!(Request::parse(&request.emit()), Some(request));
            }
        }

        #[test]
        fn any_one_damaged_byte_is_noticed(counts in any::<[i16; 6]>(), at in 0_usize..19, change in 1_u8..) {
            let mut bytes = Reading { streamed: true, counts, overload: 0 }.emit_serial();
            bytes[at] ^= change;
            prop_assert_eq!((FORMAT.frame)(&bytes), None);
        }
    }
}
