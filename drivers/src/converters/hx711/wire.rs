//! The bits of a reading.

use crate::converters::{Conversion, ConverterFault, sign_extended};

/// Input and gain.
///
/// ```
/// use fingertip_drivers::converters::hx711::Mode;
///
/// // 27 pulses ask for input A at gain 64, whose range is ±7.8 mV/V.
/// assert_eq!(Mode::of_pulses(27), Some(Mode::A64));
/// assert_eq!(Mode::A64.full_scale(), 0.007_812_5);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Input A at gain 128.
    #[default]
    A128,
    /// Input B at gain 32.
    B32,
    /// Input A at gain 64.
    A64,
}

impl Mode {
    /// Bits of a reading.
    pub const BITS: u8 = 24;

    /// Pulses of a reading after which the next conversion is of this mode.
    #[must_use]
    pub const fn pulses(self) -> u8 {
        match self {
            Self::A128 => 25,
            Self::B32 => 26,
            Self::A64 => 27,
        }
    }

    /// The mode of so many pulses.
    #[must_use]
    pub const fn of_pulses(pulses: u8) -> Option<Self> {
        match pulses {
            25 => Some(Self::A128),
            26 => Some(Self::B32),
            27 => Some(Self::A64),
            _ => None,
        }
    }

    /// The gain.
    #[must_use]
    pub const fn gain(self) -> f64 {
        match self {
            Self::A128 => 128.0,
            Self::B32 => 32.0,
            Self::A64 => 64.0,
        }
    }

    /// Volts per volt of AVDD that make full scale, 2²³ counts.
    #[must_use]
    pub fn full_scale(self) -> f64 {
        0.5 / self.gain()
    }
}

/// Collects the bits of `N` chips, one of each at every pulse.
///
/// ```
/// use fingertip_drivers::converters::hx711::{Mode, Shift};
///
/// // One chip sends 5, the other −1; both lines are high behind the bits.
/// let mut shift = Shift::new();
/// for pulse in 0..Mode::A128.pulses() {
///     let bit = |word: u32| pulse < Mode::BITS && word >> (Mode::BITS - 1 - pulse) & 1 == 1;
///     shift.push([bit(5), bit(0xFF_FFFF)]);
/// }
/// assert_eq!(shift.finish([true, true])?.counts, [5, -1]);
/// assert_eq!(shift.finish([true, false]).unwrap_err().to_string(), "the data line of channel 1 is stuck");
/// # Ok::<(), fingertip_drivers::converters::ConverterFault>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shift<const N: usize> {
    words: [u32; N],
    pulses: u8,
}

impl<const N: usize> Default for Shift<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Shift<N> {
    /// Before the first pulse.
    #[must_use]
    pub const fn new() -> Self {
        Self { words: [0; N], pulses: 0 }
    }

    /// Takes the levels of all data lines at a pulse: the first 24 are bits, the highest first.
    pub fn push(&mut self, levels: [bool; N]) {
        if self.pulses < Mode::BITS {
            for (word, level) in self.words.iter_mut().zip(levels) {
                *word = *word << 1 | u32::from(level);
            }
        }
        self.pulses = self.pulses.saturating_add(1);
    }

    /// The conversion, with the levels of all lines after the last pulse.
    ///
    /// # Errors
    /// [`ConverterFault::Answer`] if fewer than 25 pulses were made, [`ConverterFault::Stuck`] for a line that
    /// is not high after them.
    pub fn finish(&self, levels: [bool; N]) -> Result<Conversion<N>, ConverterFault> {
        if self.pulses <= Mode::BITS {
            return Err(ConverterFault::Answer { expected: 25, found: u32::from(self.pulses) });
        }
        if let Some(channel) = levels.iter().position(|high| !high) {
            return Err(ConverterFault::Stuck { channel });
        }
        Ok(Conversion::clipped(self.words.map(|word| sign_extended(word, 24)), -(1 << 23), (1 << 23) - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn bits_become_the_number_that_they_are(first in -8_388_608_i32..8_388_608, second in -8_388_608_i32..8_388_608, mode in 25_u8..28) {
            let mut shift = Shift::new();
            for bit in (0..24).rev() {
                shift.push([first >> bit & 1 == 1, second >> bit & 1 == 1]);
            }
            prop_assert!(shift.finish([true; 2]).is_err());
            for _ in 24..mode {
                shift.push([true; 2]);
            }
            prop_assert_eq!(shift.finish([true; 2]).unwrap().counts, [first, second]);
            prop_assert_eq!(shift.finish([true, false]), Err(ConverterFault::Stuck { channel: 1 }));
            prop_assert_eq!(Mode::of_pulses(mode).unwrap().pulses(), mode);
        }

        #[test]
        fn any_levels_are_a_reading_or_none(levels in prop::collection::vec(any::<[bool; 3]>(), 0..300), last in any::<[bool; 3]>()) {
            let mut shift = Shift::new();
            for level in &levels {
                shift.push(*level);
            }
            if let Ok(conversion) = shift.finish(last) {
                prop_assert!(conversion.counts.iter().all(|count| (-8_388_608..8_388_608).contains(count)));
            }
        }
    }
}
