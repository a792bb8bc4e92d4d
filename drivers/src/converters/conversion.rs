//! What a converter gives.

use fingertip_wrench::Real;
use nalgebra::SVector;

use super::error::ConverterFault;

/// The counts of `N` channels that belong together.
///
/// ```
/// use fingertip_drivers::converters::Conversion;
///
/// // Channel 1 is at an end of 24 bits, so that no wrench can come of it.
/// let conversion = Conversion::clipped([12, 8_388_607], -8_388_608, 8_388_607);
/// assert_eq!(conversion.saturated, [false, true]);
/// let told = conversion.signals::<f64>().unwrap_err().to_string();
/// assert_eq!(told, "channel 1 is at an end of the converter's range");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Conversion<const N: usize> {
    /// Signed counts.
    pub counts: [i32; N],
    /// Which channels lie at an end of the converter's range: their true value is there or beyond.
    pub saturated: [bool; N],
}

impl<const N: usize> Conversion<N> {
    /// Counts of a converter that clips at `least` and `greatest`.
    #[must_use]
    pub fn clipped(counts: [i32; N], least: i32, greatest: i32) -> Self {
        Self { counts, saturated: counts.map(|count| count <= least || count >= greatest) }
    }

    /// The first channel at an end of the range.
    #[must_use]
    pub fn first_saturated(&self) -> Option<usize> {
        self.saturated.iter().position(|saturated| *saturated)
    }

    /// The counts as numbers; exact in `f32`, too, for converters of up to 25 bits.
    ///
    /// # Errors
    /// [`ConverterFault::Saturated`] names the first channel at an end of the range: a wrench from a clipped
    /// gauge would be wrong in all components.
    pub fn signals<T: Real>(&self) -> Result<SVector<T, N>, ConverterFault> {
        match self.first_saturated() {
            Some(channel) => Err(ConverterFault::Saturated { channel }),
            None => Ok(SVector::from(self.counts.map(|count| T::literal(f64::from(count))))),
        }
    }
}

/// How a converter has behaved so far.
///
/// ```
/// use fingertip_drivers::converters::ads131m::{Ads131m, Configuration, SimulatedAds131m};
/// use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
///
/// let bench = SimulatedBench::new(SimulatedAds131m::new(|_| [0.001; 4]), WireFaults::default());
/// let mut converter = Ads131m::new(bench.spi(), bench.ready(), bench.delay(), Patience::default());
/// converter.configure(&Configuration::<4>::default())?;
/// // From now on a bit of one answer in ten is flipped on the wire.
/// bench.set_faults(WireFaults { answer_flip: 0.1, ..WireFaults::default() });
/// let read = core::iter::repeat_with(|| converter.read()).take(200).filter(Result::is_ok).count();
/// let statistics = converter.statistics();
/// assert_eq!((statistics.conversions, statistics.corrupt), (read as u64, 200 - read as u64));
/// assert!(read < 200);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ConverterStatistics {
    /// Conversions that were read whole and new; the saturated ones are among them.
    pub conversions: u64,
    /// Conversions of which a channel was at an end of the range.
    pub saturated: u64,
    /// Answers whose checksum or form was wrong.
    pub corrupt: u64,
    /// Answers that held nothing new.
    pub stale: u64,
    /// Conversions that were passed over because their cycle of channels was not whole.
    pub incomplete: u64,
    /// How often the device said that what it was sent was damaged.
    pub rejected: u64,
    /// How often the device did not become ready in time.
    pub timeouts: u64,
    /// How often the device had lost its configuration.
    pub resets: u64,
}

impl ConverterStatistics {
    /// Counts a conversion.
    pub(crate) fn converted<const N: usize>(&mut self, conversion: &Conversion<N>) {
        self.conversions += 1;
        self.saturated += u64::from(conversion.first_saturated().is_some());
    }

    /// Counts a fault.
    pub(crate) const fn note(&mut self, fault: &ConverterFault) {
        match fault {
            ConverterFault::Timeout => self.timeouts += 1,
            ConverterFault::Reset => self.resets += 1,
            ConverterFault::Rejected => self.rejected += 1,
            ConverterFault::Saturated { .. } => self.saturated += 1,
            _ => self.corrupt += 1,
        }
    }
}

/// The number in the low `bits` bits (1 to 32) of a word, in two's complement.
pub(crate) const fn sign_extended(word: u32, bits: u32) -> i32 {
    let unused = 32_u32.saturating_sub(bits);
    (word << unused).cast_signed() >> unused
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_extended_and_ends_are_noticed() {
        assert_eq!(sign_extended(0x80_0000, 24), -8_388_608);
        assert_eq!(sign_extended(0x7F_FFFF, 24), 8_388_607);
        assert_eq!(sign_extended(0xFF_FFFF, 24), -1);
        let conversion = Conversion::clipped([0, -8_388_608, 8_388_607], -8_388_608, 8_388_607);
        assert_eq!(conversion.saturated, [false, true, true]);
        assert_eq!(conversion.signals::<f32>(), Err(ConverterFault::Saturated { channel: 1 }));
        let sound = Conversion::clipped([1, -8_388_607, 8_388_606], -8_388_608, 8_388_607);
        assert_eq!(sound.signals::<f32>().unwrap().map(|count| count as i32), SVector::from(sound.counts));
    }
}
