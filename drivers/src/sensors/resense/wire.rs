//! The bytes of a reading, little-endian: seven `f32`.

/// One reading.
///
/// ```
/// use fingertip_drivers::sensors::resense::Reading;
///
/// let reading = Reading { force: [0.0, 0.0, -2.0], temperature: 25.0, ..Reading::default() };
/// assert_eq!(reading.emit()[8..12], (-2.0_f32).to_le_bytes());
/// assert_eq!(Reading::parse(&reading.emit()), reading);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// Fx, Fy, Fz \[N\].
    pub force: [f32; 3],
    /// Tx, Ty, Tz \[mN·m\], as on the wire.
    pub torque_millinewton_metres: [f32; 3],
    /// Temperature of the sensor \[°C\].
    pub temperature: f32,
}

impl Reading {
    /// Bytes of a reading.
    pub const LENGTH: usize = 28;

    /// Reads a reading: any bytes are one.
    #[must_use]
    pub fn parse(bytes: &[u8; Self::LENGTH]) -> Self {
        let (words, _) = bytes.as_chunks::<4>();
        let number = |index: usize| f32::from_le_bytes(words.get(index).copied().unwrap_or_default());
        Self {
            force: core::array::from_fn(number),
            torque_millinewton_metres: core::array::from_fn(|axis| number(3 + axis)),
            temperature: number(6),
        }
    }

    /// The bytes of the reading.
    #[must_use]
    pub fn emit(&self) -> [u8; Self::LENGTH] {
        let mut bytes = [0; Self::LENGTH];
        let numbers = self.force.into_iter().chain(self.torque_millinewton_metres).chain([self.temperature]);
        for (place, number) in bytes.as_chunks_mut().0.iter_mut().zip(numbers) {
            *place = number.to_le_bytes();
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn any_bytes_are_a_reading_and_are_written_as_they_were_read(bytes in any::<[u8; 28]>()) {
            prop_assert_eq!(Reading::parse(&bytes).emit(), bytes);
        }
    }

    #[test]
    fn numbers_stand_in_their_order() {
        let bytes =
            Reading { force: [1.0, 0.0, 0.0], torque_millinewton_metres: [0.0, 0.0, -2.0], temperature: 0.5 }
                .emit();
        assert_eq!(
            (&bytes[..4], &bytes[20..]),
            (&[0, 0, 0x80, 0x3F][..], &[0, 0, 0, 0xC0, 0, 0, 0, 0x3F][..])
        );
    }
}
