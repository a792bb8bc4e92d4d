//! The text of a reading.
//!
//! ```text
//! 0      1                        25     27
//! ├──────┼────────────────────────┼──────┤
//! │ tick │ 6 × 4 hex digits       │ CRLF │
//! └──────┴────────────────────────┴──────┘
//! ```

use crate::sensors::line::FrameFormat;

/// Asks for one reading.
pub const REQUEST: u8 = b'R';
/// Asks for the [`Sensitivities`](super::Sensitivities).
pub const REQUEST_SENSITIVITIES: u8 = b'p';
/// Takes the present load as zero, in the sensor.
pub const REQUEST_ZERO: u8 = b'O';

/// One reading of the six axes.
///
/// ```
/// use fingertip_drivers::sensors::dynpick::Reading;
///
/// let reading = Reading::parse(b"7200020002000200020002001\r\n").unwrap();
/// assert_eq!((reading.tick, reading.raw[0]), (7, Reading::ZERO));
/// assert_eq!(reading.raw[5], Reading::ZERO + 1);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Number of the reading, 0 to 9 and round again.
    pub tick: u8,
    /// What the converter gave for Fx, Fy, Fz, Tx, Ty, Tz; [`ZERO`](Self::ZERO) is no load.
    pub raw: [u16; 6],
}

impl Reading {
    /// Bytes of a reading.
    pub const LENGTH: usize = 27;
    /// What stands for no load.
    pub const ZERO: u16 = 8192;
    /// The greatest number of the converter.
    pub const GREATEST: u16 = 16383;

    /// Reads a reading; `None` if a byte is not what it must be or a number is beyond the converter's
    /// range. Hexadecimal digits may be large or small.
    #[must_use]
    pub fn parse(bytes: &[u8; Self::LENGTH]) -> Option<Self> {
        let [tick @ b'0'..=b'9', digits @ .., b'\r', b'\n'] = bytes else { return None };
        let mut raw = [0; 6];
        for (number, digits) in raw.iter_mut().zip(digits.as_chunks::<4>().0) {
            for digit in digits {
                *number = *number << 4 | u16::try_from(char::from(*digit).to_digit(16)?).ok()?;
            }
            if *number > Self::GREATEST {
                return None;
            }
        }
        Some(Self { tick: tick - b'0', raw })
    }

    /// The text of the reading; a tick or number that is too large is cut to its last digits.
    #[must_use]
    pub fn emit(&self) -> [u8; Self::LENGTH] {
        const DIGITS: [u8; 16] = *b"0123456789ABCDEF";
        let digits = self.raw.into_iter().flat_map(|raw| {
            let digit = |shift: u32| DIGITS.get(usize::from(raw >> shift & 15)).copied().unwrap_or(b'0');
            [digit(12), digit(8), digit(4), digit(0)]
        });
        let mut bytes = [0; Self::LENGTH];
        let all = core::iter::once(b'0' + self.tick % 10).chain(digits).chain(*b"\r\n");
        for (place, byte) in bytes.iter_mut().zip(all) {
            *place = byte;
        }
        bytes
    }
}

/// How readings look, for a [`Deframer`](crate::sensors::line::Deframer).
pub const FORMAT: FrameFormat<Reading, { Reading::LENGTH }> = FrameFormat {
    may_begin: |start| {
        start.iter().enumerate().all(|(at, byte)| match at {
            0 => byte.is_ascii_digit(),
            25 => *byte == b'\r',
            26 => *byte == b'\n',
            _ => byte.is_ascii_hexdigit(),
        })
    },
    frame: |bytes| Reading::parse(bytes),
};

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_reading_is_text() {
        let reading = Reading { tick: 3, raw: [8192, 0, 16383, 0x1abc, 1, 0x20] };
        assert_eq!(reading.emit(), *b"3200000003FFF1ABC00010020\r\n");
        assert_eq!(Reading::parse(b"3200000003fff1abc00010020\r\n"), Some(reading));
        for wrong in [
            b"3200000004FFF1ABC00010020\r\n",
            b"A200000003FFF1ABC00010020\r\n",
            b"32000 0003FFF1ABC00010020\r\n",
        ] {
            assert_eq!(Reading::parse(wrong), None);
        }
    }

    proptest! {
        #[test]
        fn a_reading_is_read_as_it_was_written(tick in 0_u8..10, raw in prop::array::uniform6(0_u16..16384)) {
            let reading = Reading { tick, raw };
            prop_assert_eq!(Reading::parse(&reading.emit()), Some(reading));
        }

        #[test]
        fn any_bytes_are_a_reading_or_none(bytes in any::<[u8; 27]>(), tick in any::<u8>(), raw in any::<[u16; 6]>()) {
            prop_assert!(Reading::parse(&bytes).is_none_or(|reading| reading.emit().eq_ignore_ascii_case(&bytes)));
            let _ = Reading { tick, raw }.emit();
        }
    }
}
