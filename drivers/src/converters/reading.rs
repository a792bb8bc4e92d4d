//! A conversion of 24 bits, as several chips send it.

use super::conversion::{Conversion, sign_extended};

/// A conversion: three bytes, the highest first, in two's complement.
///
/// ```
/// use fingertip_drivers::converters::Reading;
///
/// assert_eq!(Reading::parse([0xFF, 0xFF, 0xFE]).counts, -2);
/// assert_eq!(Reading { counts: 258 }.emit(), [0, 1, 2]);
/// assert_eq!(Reading::parse([0x7F, 0xFF, 0xFF]).conversion().saturated, [true]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Counts of 24 bits.
    pub counts: i32,
}

impl Reading {
    /// Reads three bytes: any are a reading.
    #[must_use]
    pub const fn parse([high, middle, low]: [u8; 3]) -> Self {
        Self { counts: sign_extended(u32::from_be_bytes([0, high, middle, low]), 24) }
    }

    /// The three bytes; counts beyond 24 bits are cut off.
    #[must_use]
    pub const fn emit(self) -> [u8; 3] {
        let [_, high, middle, low] = self.counts.to_be_bytes();
        [high, middle, low]
    }

    /// As a conversion of one channel, saturated at either end of the 24 bits.
    #[must_use]
    pub fn conversion(self) -> Conversion<1> {
        Conversion::clipped([self.counts], -(1 << 23), (1 << 23) - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn only_the_two_ends_of_the_range_are_saturated() {
        for (counts, saturated) in [
            (-8_388_608, true),
            (-8_388_607, false),
            (-1, false),
            (0, false),
            (1, false),
            (8_388_606, false),
            (8_388_607, true),
        ] {
            assert_eq!(
                Reading { counts }.conversion(),
                Conversion { counts: [counts], saturated: [saturated] }
            );
        }
    }

    proptest! {
        #[test]
        fn any_bytes_are_a_reading_and_are_written_as_they_were_read(bytes in any::<[u8; 3]>()) {
            prop_assert_eq!(Reading::parse(bytes).emit(), bytes);
        }
    }
}
