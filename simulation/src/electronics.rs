//! From strain to the volts that the converter reports.

use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use crate::error::{SimulationError, not_negative, positive};

/// The channels: quarter bridge, amplifier, converter, and what the firmware does with the counts.
///
/// The default figures are those of a careful bench set-up:
///
/// * gauge factor 2 (constantan), excitation 5 V (18 mW in a gauge of 350 Ω, half of the bridge's
///   voltage on it: little enough on aluminium);
/// * amplification 2000: the 450 µm/m of the worst 30 N contact give 1.1 mV, which fill ±2.5 V but
///   for 10 %, left for unbalance and drift;
/// * 12 bits from 0 to 5 V: one step is 1.22 mV, or 0.24 µm/m;
/// * noise 0.53 µV at the amplifier's input: 4 nV/√Hz of a precision instrumentation amplifier
///   and 2.4 nV/√Hz of a 350 Ω gauge, behind a first-order filter at 8 kHz:
///   √(8 kHz · π/2) · 4.7 nV/√Hz. That is 0.9 steps, enough to make an average finer than a step;
/// * so 16 conversions are averaged to a sample, which leaves 0.14 µV (rounding included) or a quarter of a step. At
///   1000 samples per second the converter runs at 16 kHz;
/// * the dummy gauge is averaged over 0.1 s, since the temperature is slow and its noise would come
///   into all gauges alike.
///
/// ```
/// use fingertip_simulation::Electronics;
///
/// let electronics = Electronics::default();
/// // 450 µm/m of strain make 1.1 mV, which almost fill the converter.
/// let input = electronics.bridge(450e-6);
/// assert!((input - 1.125e-3).abs() < 1e-6);
/// let volts = electronics.convert(input);
/// assert!(volts > 4.7 && !electronics.is_saturated(volts));
/// assert!(electronics.is_saturated(electronics.convert(2e-3)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Electronics {
    /// Relative change of resistance per strain.
    pub gauge_factor: f64,
    /// Excitation of the bridge \[V\].
    pub excitation: f64,
    /// Amplification.
    pub amplification: f64,
    /// What the amplifier gives for a balanced bridge \[V\].
    pub offset: f64,
    /// Standard deviation of the noise at the amplifier's input \[V\].
    pub input_noise: f64,
    /// Bits of the converter, 1 to 24.
    pub bits: u32,
    /// How many conversions are averaged to one sample, at least 1.
    pub conversions: u32,
    /// Time constant over which the dummy gauge is averaged \[s\]; zero for none.
    pub dummy_averaging: f64,
    /// The converter's range is from zero to this \[V\].
    pub converter_range: f64,
}

impl Default for Electronics {
    fn default() -> Self {
        Self {
            gauge_factor: 2.0,
            excitation: 5.0,
            amplification: 2000.0,
            offset: 2.5,
            input_noise: 0.53e-6,
            bits: 12,
            conversions: 16,
            dummy_averaging: 0.1,
            converter_range: 5.0,
        }
    }
}

impl Electronics {
    pub(super) fn checked(self) -> Result<Self, SimulationError> {
        positive(self.gauge_factor, "gauge factor")?;
        positive(self.excitation, "excitation")?;
        positive(self.amplification, "amplification")?;
        positive(self.converter_range, "converter range")?;
        not_negative(self.offset, "amplifier offset")?;
        not_negative(self.input_noise, "input noise")?;
        not_negative(self.dummy_averaging, "averaging time of the dummy gauge")?;
        if self.conversions == 0 {
            return Err(SimulationError::BadParameter {
                parameter: "number of conversions",
                requirement: "at least 1",
            });
        }
        if !(1..=24).contains(&self.bits) {
            return Err(SimulationError::BadParameter {
                parameter: "number of bits",
                requirement: "1 to 24",
            });
        }
        Ok(self)
    }

    /// Volts at the converter per unit strain, for small strains: `A·U·k/4`.
    #[must_use]
    pub fn gain(&self) -> f64 {
        self.amplification * self.excitation * self.gauge_factor / 4.0
    }

    /// Output of the quarter bridge \[V\]: `U·kε/(4 + 2kε)`. It is linear but for a share of
    /// `kε/2`, 0.05 % at full scale.
    #[must_use]
    pub fn bridge(&self, strain: f64) -> f64 {
        let change = self.gauge_factor * strain;
        self.excitation * change / (4.0 + 2.0 * change)
    }

    /// One step of the converter \[V\].
    #[must_use]
    pub fn step(&self) -> f64 {
        self.converter_range / f64::from(1_u32 << self.bits.min(24))
    }

    /// What the converter reports \[V\] of the amplifier's input \[V\], noise included: whole steps,
    /// and the ends of the range beyond it.
    #[must_use]
    pub fn convert(&self, input: f64) -> f64 {
        let greatest = f64::from((1_u32 << self.bits.min(24)) - 1);
        let code = ((self.offset + self.amplification * input) / self.step()).round().clamp(0.0, greatest);
        code * self.step()
    }

    /// What one channel gives for a steady input \[V\]: the mean of some noisy conversions, and
    /// whether one of them was at an end of the range.
    pub(super) fn sample(&self, input: f64, random: &mut Pcg64Mcg) -> (f64, bool) {
        let (mut sum, mut saturated) = (0.0, false);
        for _ in 0..self.conversions {
            let noise: f64 = StandardNormal.sample(random);
            let volts = self.convert(input + self.input_noise * noise);
            sum += volts;
            saturated |= self.is_saturated(volts);
        }
        (sum / f64::from(self.conversions), saturated)
    }

    /// Whether a reading lies at an end of the converter's range.
    #[must_use]
    pub fn is_saturated(&self, volts: f64) -> bool {
        volts <= 0.0 || volts >= self.converter_range - self.step()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_reading_is_within_half_a_step_or_at_an_end(input in -5e-3_f64..5e-3) {
            let electronics = Electronics::default();
            let (exact, read) = (2.5 + 2000.0 * input, electronics.convert(input));
            if electronics.is_saturated(read) {
                prop_assert!(exact <= electronics.step() || exact >= 5.0 - 2.0 * electronics.step());
            } else {
                prop_assert!((read - exact).abs() <= electronics.step() * 0.500_000_1);
            }
            let codes = read / electronics.step();
            prop_assert_eq!(codes, codes.round());
        }

        #[test]
        fn the_bridge_falls_short_by_half_the_change(strain in -1e-3_f64..1e-3) {
            let electronics = Electronics::default();
            let linear = electronics.gain() * strain;
            let bridge = electronics.bridge(strain) * electronics.amplification;
            // U·kε/4·(1 − kε/2 + …) with k = 2.
            prop_assert!((bridge - linear * (1.0 - strain)).abs() <= linear.abs() * strain * strain * 1.1 + 1e-15);
        }
    }
}
