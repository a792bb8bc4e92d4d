//! The bytes of readings and configurations, big-endian.
//!
//! ```text
//! 0             4       6        8               20    22
//! ├─────────────┼───────┼────────┼───────────────┼─────┤
//! │ AA 07 08 10 │ count │ status │ 6 × i16 counts│ sum │
//! └─────────────┴───────┴────────┴───────────────┴─────┘
//! ```
//! The sum is that of all bytes before it, the header included, as a number of 16 bits.

use crate::sensors::line::FrameFormat;

const HEADER: [u8; 4] = [0xAA, 7, 8, 16];

fn sum(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0, |sum: u16, byte| sum.wrapping_add(u16::from(*byte)))
}

/// One reading of the six axes.
///
/// ```
/// use fingertip_drivers::sensors::optoforce::Reading;
///
/// let reading = Reading { count: 7, status: 0, counts: [0, 0, -160, 0, 0, 0] };
/// let mut bytes = reading.emit();
/// assert_eq!((&bytes[..4], Reading::parse(&bytes)), (&[0xAA, 7, 8, 16][..], Some(reading)));
/// // Its sum tells of a damaged byte.
/// bytes[12] ^= 1;
/// assert_eq!(Reading::parse(&bytes), None);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Number of the reading; it wraps around.
    pub count: u16,
    /// The status word: zero if all is well.
    pub status: u16,
    /// Counts of Fx, Fy, Fz, Tx, Ty, Tz.
    pub counts: [i16; 6],
}

impl Reading {
    /// Bytes of a reading.
    pub const LENGTH: usize = 22;
    /// Bits of the status word: an axis is overloaded, Fx at bit 9 to Tz at bit 4.
    pub const OVERLOAD: u16 = 0x03F0;

    /// Reads a reading whose header and sum are right.
    #[must_use]
    pub fn parse(bytes: &[u8; Self::LENGTH]) -> Option<Self> {
        let (words, _) = bytes.as_chunks::<2>();
        let word = |index: usize| u16::from_be_bytes(words.get(index).copied().unwrap_or_default());
        let (summed, _) = bytes.split_last_chunk::<2>()?;
        if !bytes.starts_with(&HEADER) || sum(summed) != word(10) {
            return None;
        }
        let counts = core::array::from_fn(|axis| word(4 + axis).cast_signed());
        Some(Self { count: word(2), status: word(3), counts })
    }

    /// The bytes of the reading.
    #[must_use]
    pub fn emit(&self) -> [u8; Self::LENGTH] {
        let mut bytes = [0; Self::LENGTH];
        let words = [self.count, self.status].into_iter().chain(self.counts.map(i16::cast_unsigned));
        let body = HEADER.into_iter().chain(words.flat_map(u16::to_be_bytes));
        for (place, byte) in bytes.iter_mut().zip(body) {
            *place = byte;
        }
        if let Some((summed, place)) = bytes.split_last_chunk_mut() {
            *place = sum(summed).to_be_bytes();
        }
        bytes
    }
}

/// How many readings a second the sensor sends.
///
/// ```
/// use fingertip_drivers::sensors::optoforce::{Configuration, Filter, Rate};
///
/// // The byte is the milliseconds between readings.
/// let slow = Configuration { rate: Rate::Hz10, filter: Filter::None, zero: false };
/// assert_eq!(slow.emit()[4], 100);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Rate {
    /// None.
    Stop,
    /// 1000 a second.
    Hz1000,
    /// 333 a second.
    Hz333,
    /// 100 a second.
    Hz100,
    /// 30 a second.
    Hz30,
    /// 10 a second.
    Hz10,
}

/// Corner of the low-pass filter in the sensor.
///
/// ```
/// use fingertip_drivers::sensors::optoforce::{Configuration, Filter, Rate};
///
/// let smooth = Configuration { rate: Rate::Hz100, filter: Filter::Hz15, zero: false };
/// assert_eq!(smooth.emit()[5], 4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Filter {
    /// No filter.
    None,
    /// 500 Hz.
    Hz500,
    /// 150 Hz.
    Hz150,
    /// 50 Hz.
    Hz50,
    /// 15 Hz.
    Hz15,
    /// 5 Hz.
    Hz5,
    /// 1.5 Hz.
    Hz1_5,
}

const RATES: [(Rate, u8); 6] = [
    (Rate::Stop, 0),
    (Rate::Hz1000, 1),
    (Rate::Hz333, 3),
    (Rate::Hz100, 10),
    (Rate::Hz30, 33),
    (Rate::Hz10, 100),
];

const FILTERS: [(Filter, u8); 7] = [
    (Filter::None, 0),
    (Filter::Hz500, 1),
    (Filter::Hz150, 2),
    (Filter::Hz50, 3),
    (Filter::Hz15, 4),
    (Filter::Hz5, 5),
    (Filter::Hz1_5, 6),
];

fn code<V: PartialEq>(table: &[(V, u8)], value: &V) -> u8 {
    table.iter().find(|(known, _)| known == value).map_or(0, |(_, code)| *code)
}

fn value<V: Copy>(table: &[(V, u8)], code: u8) -> Option<V> {
    table.iter().find(|(_, known)| *known == code).map(|(value, _)| *value)
}

/// What a client sets.
///
/// ```
/// use fingertip_drivers::sensors::optoforce::{Configuration, Filter, Rate};
///
/// let configuration = Configuration { rate: Rate::Hz1000, filter: Filter::Hz150, zero: true };
/// assert_eq!(configuration.emit(), [0xAA, 0, 50, 3, 1, 2, 255, 1, 0xE1]);
/// assert_eq!(Configuration::parse(&configuration.emit()), Some(configuration));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration {
    /// Readings a second.
    pub rate: Rate,
    /// The filter in the sensor.
    pub filter: Filter,
    /// Whether to take the present load as zero; `false` forgets the zero.
    pub zero: bool,
}

impl Configuration {
    /// Bytes of a configuration.
    pub const LENGTH: usize = 9;
    const HEADER: [u8; 4] = [0xAA, 0, 50, 3];

    /// Reads a configuration; `None` if header, sum or a value is not right.
    #[must_use]
    pub fn parse(bytes: &[u8; Self::LENGTH]) -> Option<Self> {
        let [head @ .., rate, filter, zero, high, low] = bytes;
        let (summed, _) = bytes.split_last_chunk::<2>()?;
        if *head != Self::HEADER || sum(summed) != u16::from_be_bytes([*high, *low]) {
            return None;
        }
        let zero = match *zero {
            0 => false,
            255 => true,
            _ => return None,
        };
        Some(Self { rate: value(&RATES, *rate)?, filter: value(&FILTERS, *filter)?, zero })
    }

    /// The bytes of the configuration.
    #[must_use]
    pub fn emit(&self) -> [u8; Self::LENGTH] {
        let [a, b, c, d] = Self::HEADER;
        let zero = if self.zero { 255 } else { 0 };
        let summed = [a, b, c, d, code(&RATES, &self.rate), code(&FILTERS, &self.filter), zero];
        let [e, f, g, h, i, j, k] = summed;
        let [high, low] = sum(&summed).to_be_bytes();
        [e, f, g, h, i, j, k, high, low]
    }
}

/// How readings look, for a [`Deframer`](crate::sensors::line::Deframer).
pub const FORMAT: FrameFormat<Reading, { Reading::LENGTH }> = FrameFormat {
    may_begin: |start| start.iter().zip(HEADER).all(|(byte, header)| *byte == header),
    frame: |bytes| Reading::parse(bytes),
};

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bytes_are_those_of_the_protocol() {
        let configuration = Configuration { rate: Rate::Hz100, filter: Filter::Hz15, zero: true };
        // 170 + 50 + 3 + 10 + 4 + 255 = 492.
        assert_eq!(configuration.emit(), [170, 0, 50, 3, 10, 4, 255, 1, 236]);
        let reading = Reading { count: 0x0102, status: 0, counts: [1, -1, 0, 0, 0, 0] };
        let bytes = reading.emit();
        assert_eq!(bytes[..12], [170, 7, 8, 16, 1, 2, 0, 0, 0, 1, 255, 255]);
        // 170 + 7 + 8 + 16 + 1 + 2 + 1 + 255 + 255 = 715.
        assert_eq!(bytes[20..], [2, 203]);
    }

    proptest! {
        #[test]
        fn a_reading_is_read_as_it_was_written(count in any::<u16>(), status in any::<u16>(), counts in any::<[i16; 6]>()) {
            let reading = Reading { count, status, counts };
            prop_assert_eq!(Reading::parse(&reading.emit()), Some(reading));
        }

        #[test]
        fn a_configuration_is_read_as_it_was_written(rate in 0_usize..6, filter in 0_usize..7, zero in any::<bool>()) {
            let configuration = Configuration { rate: RATES[rate].0, filter: FILTERS[filter].0, zero };
            prop_assert_eq!(Configuration::parse(&configuration.emit()), Some(configuration));
        }

        #[test]
        fn any_bytes_are_a_message_or_none(mut bytes in any::<[u8; 22]>(), configuration in any::<[u8; 9]>(), headed in any::<bool>()) {
            if headed {
                bytes[..4].copy_from_slice(&HEADER);
            }
            prop_assert!(Reading::parse(&bytes).is_none_or(|reading| reading.emit() == bytes));
            prop_assert!(Configuration::parse(&configuration).is_none_or(|read| read.emit() == configuration));
        }

        #[test]
        fn any_one_damaged_byte_is_noticed(counts in any::<[i16; 6]>(), at in 0_usize..22, change in 1_u8..) {
            let mut bytes = Reading { counts, ..Reading::default() }.emit();
            bytes[at] ^= change;
            prop_assert_eq!(Reading::parse(&bytes), None);
        }
    }
}
