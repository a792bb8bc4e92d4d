//! The bytes of a frame, little-endian.
//!
//! ```text
//! 0     1        3            27          31              35      37
//! ├─────┼────────┼────────────┼───────────┼───────────────┼───────┤
//! │ AA  │ status │ 6 × f32    │ u32       │ f32           │ CRC   │
//! │     │ u16    │ N and N·m  │ time µs   │ temperature °C│ u16   │
//! └─────┴────────┴────────────┴───────────┴───────────────┴───────┘
//!        └──────────── CRC-16/X-25 over these ────────────┘
//! ```

use crc::{CRC_16_IBM_SDLC, Crc};
use thiserror::Error;

use crate::sensors::line::FrameFormat;

/// CRC-16/X-25 is the IBM-SDLC one by another name.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_SDLC);

/// One sample of the sensor.
///
/// ```
/// use fingertip_drivers::sensors::bota_serial::Frame;
///
/// let frame = Frame { microseconds: 1000, temperature: 25.0, ..Frame::default() };
/// let bytes = frame.emit();
/// assert_eq!((bytes[0], bytes.len()), (Frame::HEADER, 37));
/// assert_eq!(Frame::parse(&bytes), Ok(frame));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame {
    /// Status bits: 1 a gauge is over its range, 2 the numbers are invalid; others reserved.
    pub status: u16,
    /// Fx, Fy, Fz \[N\], Tx, Ty, Tz \[N·m\] as the sensor gives them.
    pub components: [f32; 6],
    /// Time of the sample on the sensor's clock \[µs\]; it wraps around every 71.6 minutes.
    pub microseconds: u32,
    /// Temperature of the sensor \[°C\].
    pub temperature: f32,
}

/// Bytes that are no frame.
///
/// ```
/// use fingertip_drivers::sensors::bota_serial::{Frame, FrameError};
///
/// let mut bytes = Frame::default().emit();
/// assert_eq!(Frame::parse(&bytes[1..]), Err(FrameError::Length { found: 36 }));
/// bytes[5] ^= 1;
/// assert!(matches!(Frame::parse(&bytes), Err(FrameError::Checksum { .. })));
/// bytes[0] = 0x55;
/// assert_eq!(Frame::parse(&bytes).unwrap_err().to_string(), "a frame must start with 0xaa, not 0x55");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FrameError {
    /// Not as many bytes as a frame has.
    #[error("{found} bytes where a frame has 37")]
    Length {
        /// Bytes there are.
        found: usize,
    },
    /// The first byte is not 0xAA.
    #[error("a frame must start with 0xaa, not {found:#04x}")]
    Header {
        /// The first byte.
        found: u8,
    },
    /// The checksum does not fit.
    #[error("the frame's checksum is {found:#06x} where its bytes give {expected:#06x}")]
    Checksum {
        /// Of the bytes.
        expected: u16,
        /// In the frame.
        found: u16,
    },
}

impl Frame {
    /// Bytes of a frame.
    pub const LENGTH: usize = 37;
    /// The first byte of every frame.
    pub const HEADER: u8 = 0xAA;
    /// Status bit: a gauge is over its range.
    pub const OVERRANGE: u16 = 1;
    /// Status bit: the numbers are invalid.
    pub const INVALID: u16 = 2;
    /// Status, six numbers, time, temperature: nine words after the two bytes of the status.
    const DATA: usize = 34;

    /// Reads a frame whose header and checksum are right.
    ///
    /// # Errors
    /// [`FrameError`].
    pub fn parse(bytes: &[u8]) -> Result<Self, FrameError> {
        let wrong = FrameError::Length { found: bytes.len() };
        let [header, rest @ ..] = bytes else { return Err(wrong) };
        let Some((data, checksum)) = rest.split_first_chunk::<{ Self::DATA }>() else { return Err(wrong) };
        let &[low, high] = checksum else { return Err(wrong) };
        if *header != Self::HEADER {
            return Err(FrameError::Header { found: *header });
        }
        let (expected, found) = (CRC.checksum(data), u16::from_le_bytes([low, high]));
        if expected != found {
            return Err(FrameError::Checksum { expected, found });
        }
        let [s0, s1, words @ ..] = data;
        let word = |index: usize| words.as_chunks::<4>().0.get(index).copied().unwrap_or_default();
        Ok(Self {
            status: u16::from_le_bytes([*s0, *s1]),
            components: core::array::from_fn(|axis| f32::from_le_bytes(word(axis))),
            microseconds: u32::from_le_bytes(word(6)),
            temperature: f32::from_le_bytes(word(7)),
        })
    }

    /// The bytes of the frame.
    #[must_use]
    pub fn emit(&self) -> [u8; Self::LENGTH] {
        let mut bytes = [0; Self::LENGTH];
        let mut data = [0; Self::DATA];
        let words = self.components.map(f32::to_le_bytes).into_iter();
        let words = words.chain([self.microseconds.to_le_bytes(), self.temperature.to_le_bytes()]);
        let numbers = self.status.to_le_bytes().into_iter().chain(words.flatten());
        for (place, byte) in data.iter_mut().zip(numbers) {
            *place = byte;
        }
        let checksum = CRC.checksum(&data).to_le_bytes();
        let all = core::iter::once(Self::HEADER).chain(data).chain(checksum);
        for (place, byte) in bytes.iter_mut().zip(all) {
            *place = byte;
        }
        bytes
    }
}

/// How frames look, for a [`Deframer`](crate::sensors::line::Deframer).
pub const FORMAT: FrameFormat<Frame, { Frame::LENGTH }> = FrameFormat {
    may_begin: |start| start.first().is_none_or(|first| *first == Frame::HEADER),
    frame: |bytes| Frame::parse(bytes).ok(),
};

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_checksum_is_that_of_the_catalogue() {
        assert_eq!(CRC.checksum(b"123456789"), 0x906E);
    }

    #[test]
    fn fields_stand_where_the_format_has_them() {
        let frame = Frame {
            status: 0x0201,
            components: [1.0, 0.0, 0.0, 0.0, 0.0, -2.0],
            microseconds: 0x0403_0201,
            temperature: 0.5,
        };
        let bytes = frame.emit();
        assert_eq!(bytes[..7], [0xAA, 1, 2, 0, 0, 0x80, 0x3F]);
        assert_eq!(bytes[23..35], [0, 0, 0, 0xC0, 1, 2, 3, 4, 0, 0, 0, 0x3F]);
    }

    proptest! {
        #[test]
        fn a_frame_is_read_as_it_was_written(
            status in any::<u16>(), components in prop::array::uniform6(-1e6_f32..1e6),
            microseconds in any::<u32>(), temperature in -50.0_f32..150.0,
        ) {
            let frame = Frame { status, components, microseconds, temperature };
            prop_assert_eq!(Frame::parse(&frame.emit()), Ok(frame));
        }

        #[test]
        fn any_burst_of_up_to_sixteen_bits_is_noticed(at in 8_usize..37 * 8 - 16, burst in 1_u32..1 << 16) {
            // What a CRC of 16 bits promises.
            let mut bytes = Frame { components: [1.5; 6], ..Frame::default() }.emit();
            for bit in (0..16).filter(|bit| burst >> bit & 1 == 1) {
                bytes[(at + bit) / 8] ^= 1 << ((at + bit) % 8);
            }
            prop_assert!(Frame::parse(&bytes).is_err());
        }

        #[test]
        fn any_bytes_are_a_frame_or_none(bytes in prop::collection::vec(any::<u8>(), 0..80)) {
            prop_assert!(bytes.len() == Frame::LENGTH || Frame::parse(&bytes).is_err());
        }
    }
}
