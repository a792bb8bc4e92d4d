//! All bridges of a fingertip.

use fingertip_wrench::Real;
use nalgebra::SVector;
use thiserror::Error;

use super::channel::{BridgeChannel, Excitation};
use crate::{SourceError, SourceErrorKind};

/// Why a front end cannot be made. Channels count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BridgeFrontEndError {
    /// A bridge, or the excitation, is at an input that the converter does not have.
    #[error("bridge {channel} is at an input that the converter does not have")]
    NoSuchInput {
        /// The bridge; as many as there are bridges for the excitation.
        channel: usize,
    },
    /// A number of a bridge cannot be.
    #[error("bridge {channel}: the {parameter} must be {requirement}")]
    BadParameter {
        /// The bridge.
        channel: usize,
        /// Which number.
        parameter: &'static str,
        /// What it must be.
        requirement: &'static str,
    },
    /// The voltage of the excitation, or its scale, is not a finite number other than zero.
    #[error("the excitation must be a finite number other than zero")]
    BadExcitation,
}

/// Why counts give no strain. Channels are bridges, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BridgeFault {
    /// A bridge is at an end of the converter's range.
    #[error("bridge {channel} is at an end of the converter's range")]
    Saturated {
        /// The bridge.
        channel: usize,
    },
    /// A bridge gives more than any strain: a gauge or a wire is open or shorted.
    #[error("bridge {channel} gives more than any strain does: is a gauge or a wire broken?")]
    Implausible {
        /// The bridge.
        channel: usize,
    },
    /// There is no excitation.
    #[error("there is no excitation")]
    NoExcitation,
}

impl SourceError for BridgeFault {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Saturated { .. } => SourceErrorKind::Overload,
            Self::Implausible { .. } | Self::NoExcitation => SourceErrorKind::DeviceFault,
        }
    }
}

/// Strains, and how far off they may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strains<T, const N: usize> {
    /// Strain \[m/m\], positive when the gauge that the circuit names is stretched.
    pub strain: SVector<T, N>,
    /// What is lost in whole counts, of the bridge and of the measured excitation, and in rounding: a
    /// bound.
    pub resolution: SVector<T, N>,
    /// What the tolerances of full scale and gauge factor can make of it: a bound. It is the same share in
    /// every sample, so calibration takes it away.
    pub scale_error: SVector<T, N>,
    /// Standard deviation of the noise.
    pub noise: SVector<T, N>,
    /// Which bridges are at an end of the converter's range: their strain is that or more, and no bound
    /// holds.
    pub saturated: [bool; N],
}

impl<T: Real, const N: usize> Strains<T, N> {
    /// The first bridge at an end of the range.
    #[must_use]
    pub fn first_saturated(&self) -> Option<usize> {
        self.saturated.iter().position(|saturated| *saturated)
    }
}

/// `N` bridges at a converter with `M` channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeFrontEnd<T, const N: usize, const M: usize> {
    channels: [BridgeChannel<T>; N],
    excitation: Excitation<T>,
}

impl<T: Real, const N: usize, const M: usize> BridgeFrontEnd<T, N, M> {
    /// From bridges and their excitation.
    ///
    /// # Errors
    /// [`BridgeFrontEndError`].
    pub fn new(
        channels: [BridgeChannel<T>; N],
        excitation: Excitation<T>,
    ) -> Result<Self, BridgeFrontEndError> {
        let is_scale = |number: T| number.is_number() && !number.is_zero() && (T::one() / number).is_number();
        for (channel, bridge) in channels.iter().enumerate() {
            let checked = |holds: bool, parameter, requirement| {
                if holds {
                    Ok(())
                } else {
                    Err(BridgeFrontEndError::BadParameter { channel, parameter, requirement })
                }
            };
            if bridge.input >= M {
                return Err(BridgeFrontEndError::NoSuchInput { channel });
            }
            let scale = &bridge.scale;
            let (finite, share) = ("finite and not zero", "at least 0 and less than 1");
            let is_share = |number: T| number >= T::zero() && number < T::one();
            checked(is_scale(bridge.gauge_factor), "gauge factor", finite)?;
            checked(is_scale(scale.full_scale), "full scale", finite)?;
            checked(
                scale.full_scale_counts > T::one() && is_scale(scale.full_scale_counts),
                "counts at full scale",
                "finite and more than 1",
            )?;
            checked(
                is_scale(scale.full_scale / scale.full_scale_counts),
                "full scale over its counts",
                finite,
            )?;
            checked(is_share(bridge.gauge_factor_tolerance), "tolerance of the gauge factor", share)?;
            checked(is_share(scale.tolerance), "tolerance of the full scale", share)?;
            let noise = bridge.noise_counts;
            checked(noise >= T::zero() && noise.is_number(), "noise", "finite and not negative")?;
        }
        match excitation {
            Excitation::Reference => {}
            Excitation::Steady { volts } if is_scale(volts) => {}
            Excitation::Measured { channel, .. } if channel >= M => {
                return Err(BridgeFrontEndError::NoSuchInput { channel: N });
            }
            Excitation::Measured { volts_per_count, .. } if is_scale(volts_per_count) => {}
            _ => return Err(BridgeFrontEndError::BadExcitation),
        }
        Ok(Self { channels, excitation })
    }

    /// The bridges.
    #[must_use]
    pub const fn channels(&self) -> &[BridgeChannel<T>; N] {
        &self.channels
    }

    /// One over the excitation \[1/V\] in a sample, and the bound of its relative error from whole counts.
    fn per_excitation(&self, counts: &SVector<T, M>) -> Result<(T, T), BridgeFault> {
        match self.excitation {
            Excitation::Reference => Ok((T::one(), T::zero())),
            Excitation::Steady { volts } => Ok((T::one() / volts, T::zero())),
            Excitation::Measured { channel, volts_per_count } => {
                let count = counts.get(channel).copied().unwrap_or_else(T::zero);
                let inverse = T::one() / (count * volts_per_count);
                // Fewer than a thousand counts are noise and not an excitation.
                if count.abs() >= T::literal(1000.0) && inverse.is_number() {
                    Ok((inverse, T::literal(0.5) / count.abs()))
                } else {
                    Err(BridgeFault::NoExcitation)
                }
            }
        }
    }

    /// Output over excitation of a bridge, and whether it is at an end of the range.
    fn ratio(&self, bridge: &BridgeChannel<T>, counts: &SVector<T, M>, per_excitation: T) -> (T, bool) {
        let count = counts.get(bridge.input).copied().unwrap_or_else(T::zero);
        let greatest = bridge.scale.full_scale_counts - T::one();
        let volts = count * (bridge.scale.full_scale / bridge.scale.full_scale_counts);
        (volts * per_excitation, !(count.abs() < greatest))
    }

    /// The strains of all bridges \[m/m\].
    ///
    /// # Errors
    /// [`BridgeFault`], which names the first bridge that gives none. A count that is no number is at an end
    /// of the range.
    #[inline]
    pub fn strain(&self, counts: &SVector<T, M>) -> Result<SVector<T, N>, BridgeFault> {
        let (per_excitation, _) = self.per_excitation(counts)?;
        let mut strain: SVector<T, N> = SVector::zeros();
        for (channel, (bridge, place)) in self.channels.iter().zip(strain.iter_mut()).enumerate() {
            let (ratio, saturated) = self.ratio(bridge, counts, per_excitation);
            if saturated {
                return Err(BridgeFault::Saturated { channel });
            }
            let change = bridge.circuit.change(ratio).ok_or(BridgeFault::Implausible { channel })?;
            *place = change / bridge.gauge_factor;
        }
        Ok(strain)
    }

    /// The strains of all bridges with bounds. A bridge at an end of the range is marked instead of refused.
    ///
    /// # Errors
    /// [`BridgeFault::Implausible`], [`BridgeFault::NoExcitation`].
    pub fn strain_with_bounds(&self, counts: &SVector<T, M>) -> Result<Strains<T, N>, BridgeFault> {
        let (per_excitation, excitation_error) = self.per_excitation(counts)?;
        let zeros = SVector::zeros();
        let mut strains = Strains {
            strain: zeros,
            resolution: zeros,
            scale_error: zeros,
            noise: zeros,
            saturated: [false; N],
        };
        for (channel, bridge) in self.channels.iter().enumerate() {
            let (ratio, saturated) = self.ratio(bridge, counts, per_excitation);
            let factor = bridge.gauge_factor;
            let change = bridge.circuit.change(ratio).ok_or(BridgeFault::Implausible { channel })?;
            let strain = change / factor;
            let per_count = (bridge.scale.full_scale / bridge.scale.full_scale_counts * per_excitation).abs();
            // Half a count of the bridge over an excitation that is less by half of one, that half itself, and
            // eight roundings.
            let lost = (per_count * T::literal(0.5) + ratio.abs() * excitation_error)
                / (T::one() - excitation_error)
                + ratio.abs() * T::literal(8.0) * T::EPSILON;
            // The relation is convex or concave throughout, so that the ends of the interval bound it.
            let slope = |ratio: T| bridge.circuit.slope_of_change(ratio) / factor.abs();
            let steepest = |width: T| {
                let (up, down) = (slope(ratio + width), slope(ratio - width));
                if up > down { up } else { down }
            };
            let tolerance = bridge.scale.tolerance;
            let by_scale = ratio.abs() * tolerance / (T::one() - tolerance);
            let gauge = bridge.gauge_factor_tolerance;
            if let Some(place) = strains.strain.get_mut(channel) {
                *place = strain;
            }
            if let Some(place) = strains.resolution.get_mut(channel) {
                *place = steepest(lost) * lost + strain.abs() * T::literal(8.0) * T::EPSILON;
            }
            if let Some(place) = strains.scale_error.get_mut(channel) {
                *place = (steepest(by_scale) * by_scale + strain.abs() * gauge) / (T::one() - gauge);
            }
            if let Some(place) = strains.noise.get_mut(channel) {
                *place = slope(ratio) * per_count * bridge.noise_counts;
            }
            if let Some(place) = strains.saturated.get_mut(channel) {
                *place = saturated;
            }
        }
        Ok(strains)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BridgeCircuit, CountScale};
    use super::*;
    use nalgebra::{Vector1, Vector2};
    use proptest::prelude::*;

    fn quarter(full_scale: f64) -> BridgeChannel<f64> {
        BridgeChannel::new(0, BridgeCircuit::quarter(), 2.0, CountScale::bits24(full_scale))
    }

    proptest! {
        #[test]
        fn the_true_strain_is_within_the_bound_of_resolution(strain in -5e-3_f64..5e-3, volts in 2.0_f64..5.0, gain in 0_u32..5) {
            // A converter with a range of ±1.2 V over its gain, and the excitation over four at channel 1.
            let gain = f64::from(1_u32 << gain);
            let scale = CountScale::bits24(1.2 / gain);
            let mut bridge = quarter(1.2 / gain);
            bridge.scale = scale;
            let measured = Excitation::Measured { channel: 1, volts_per_count: 4.8 / 8_388_608.0 };
            let front_end = BridgeFrontEnd::<f64, 1, 2>::new([bridge], measured).unwrap();
            let output = volts * bridge.circuit.ratio(2.0 * strain);
            let counts = Vector2::new((output / 1.2 * gain * 8_388_608.0).round(), (volts / 4.8 * 8_388_608.0).round());
            let strains = front_end.strain_with_bounds(&counts).unwrap();
            prop_assert_eq!(front_end.strain(&counts).unwrap(), strains.strain);
            let error = (strains.strain.x - strain).abs();
            prop_assert!(error <= strains.resolution.x, "{error} {}", strains.resolution.x);
            // The bound is not idle: some counts of the ideal resolution.
            let ideal = 1.2 / gain / 8_388_608.0 / volts * 2.0 / 2.0;
            prop_assert!(strains.resolution.x < 4.0 * ideal + strain.abs() * 1e-6);
        }

        #[test]
        fn tolerances_are_bounded(strain in -5e-3_f64..5e-3, tolerance in 0.0_f64..0.05, gauge in 0.0_f64..0.05, s in -1.0_f64..1.0, g in -1.0_f64..1.0) {
            let mut bridge = quarter(0.05).gauge_factor_within(gauge);
            bridge.scale.tolerance = tolerance;
            let front_end = BridgeFrontEnd::<f64, 1, 1>::new([bridge], Excitation::Reference).unwrap();
            // The sensor has another gauge factor and another full scale than is stated.
            let output = bridge.circuit.ratio(2.0 * (1.0 + g * gauge) * strain);
            let count = output / (0.05 * (1.0 + s * tolerance)) * 8_388_608.0;
            let strains = front_end.strain_with_bounds(&Vector1::new(count)).unwrap();
            let error = (strains.strain.x - strain).abs();
            prop_assert!(error <= strains.scale_error.x + strains.resolution.x, "{error} {strains:?}");
        }

        #[test]
        fn any_counts_give_finite_strain_or_an_error(first in any::<f64>(), second in any::<f64>()) {
            let measured = Excitation::Measured { channel: 1, volts_per_count: 1e-6 };
            let front_end = BridgeFrontEnd::<f64, 1, 2>::new([quarter(0.05)], measured).unwrap();
            let counts = Vector2::new(first, second);
            if let Ok(strain) = front_end.strain(&counts) {
                prop_assert!(strain.x.is_finite() && strain.x.abs() <= 0.25);
            }
            if let Ok(strains) = front_end.strain_with_bounds(&counts) {
                prop_assert!(strains.strain.x.is_finite() && strains.resolution.x.is_finite() && strains.noise.x.is_finite());
            }
        }
    }

    #[test]
    fn noise_is_that_of_many_samples() {
        use rand::SeedableRng;
        use rand_distr::{Distribution, StandardNormal};
        let bridge =
            BridgeChannel::new(0, BridgeCircuit::quarter(), 2.0, CountScale::bits24(0.02)).noise(50.0);
        let front_end = BridgeFrontEnd::<f64, 1, 1>::new([bridge], Excitation::Reference).unwrap();
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        let stated = front_end.strain_with_bounds(&Vector1::new(4e6)).unwrap().noise.x;
        let samples: Vec<f64> = (0..20_000)
            .map(|_| {
                let noise: f64 = StandardNormal.sample(&mut random);
                front_end.strain(&Vector1::new(4e6 + 50.0 * noise)).unwrap().x
            })
            .collect();
        let mean = samples.iter().sum::<f64>() / 2e4;
        let variance = samples.iter().map(|sample| (sample - mean).powi(2)).sum::<f64>() / 2e4;
        // A standard deviation from 20 000 samples is off by half a percent (1σ).
        assert!((variance.sqrt() / stated - 1.0).abs() < 0.025, "{} {stated}", variance.sqrt());
    }

    #[test]
    fn ends_of_the_range_and_broken_wires_are_told() {
        let front_end = BridgeFrontEnd::<f64, 1, 1>::new([quarter(0.02)], Excitation::Reference).unwrap();
        for count in [8_388_607.0, -8_388_608.0, f64::NAN, f64::INFINITY] {
            assert_eq!(front_end.strain(&Vector1::new(count)), Err(BridgeFault::Saturated { channel: 0 }));
        }
        assert!(front_end.strain_with_bounds(&Vector1::new(8_388_607.0)).unwrap().saturated[0]);
        // A range that an open gauge does not leave.
        let wide = BridgeFrontEnd::<f64, 1, 1>::new([quarter(1.0)], Excitation::Reference).unwrap();
        assert_eq!(wide.strain(&Vector1::new(4_194_304.0)), Err(BridgeFault::Implausible { channel: 0 }));
        let measured = Excitation::Measured { channel: 0, volts_per_count: 1e-6 };
        let dark = BridgeFrontEnd::<f64, 1, 1>::new([quarter(1.0)], measured).unwrap();
        assert_eq!(dark.strain(&Vector1::new(12.0)), Err(BridgeFault::NoExcitation));
    }

    #[test]
    fn a_steady_excitation_is_as_one_that_is_measured() {
        let made = |excitation| BridgeFrontEnd::<f64, 1, 2>::new([quarter(0.05)], excitation).unwrap();
        let measured = made(Excitation::Measured { channel: 1, volts_per_count: 3.3e-6 });
        let steady = made(Excitation::Steady { volts: 3.3 });
        for count in [-4e6, -1.0, 0.0, 12_345.0, 8_388_606.0] {
            let strain = steady.strain(&Vector2::new(count, 0.0)).unwrap().x;
            let ratio = count / 8_388_608.0 * 0.05 / 3.3;
            assert!((strain - 2.0 * ratio / (1.0 - 2.0 * ratio)).abs() < 1e-15, "{count}");
            assert!((strain - measured.strain(&Vector2::new(count, 1e6)).unwrap().x).abs() < 1e-15);
        }
        // A thousand counts are an excitation, of either sign.
        let at = |count| measured.strain(&Vector2::new(100.0, count));
        assert!(at(1000.0).is_ok() && at(-1000.0).is_ok());
        assert_eq!((at(999.0), at(-999.0)), (Err(BridgeFault::NoExcitation), Err(BridgeFault::NoExcitation)));
        // What is taken for strain, and what is not any more.
        let full = BridgeCircuit::<f64>::full();
        assert_eq!((full.change(0.5), full.change(-0.5)), (Some(0.5), Some(-0.5)));
        assert_eq!((full.change(0.5_f64.next_up()), full.change(f64::NAN)), (None, None));
    }

    #[test]
    fn numbers_that_cannot_be_are_refused() {
        let made = |bridge, excitation| BridgeFrontEnd::<f64, 1, 1>::new([bridge], excitation).map(|_| ());
        let good = quarter(0.02);
        assert_eq!(made(good, Excitation::Reference), Ok(()));
        let absent = BridgeFrontEndError::NoSuchInput { channel: 0 };
        assert_eq!(made(BridgeChannel { input: 1, ..good }, Excitation::Reference), Err(absent));
        for bad in [0.0, f64::NAN, f64::INFINITY, 1e-320] {
            assert!(made(BridgeChannel { gauge_factor: bad, ..good }, Excitation::Reference).is_err());
            assert!(made(quarter(bad), Excitation::Reference).is_err());
            assert_eq!(
                made(good, Excitation::Steady { volts: bad }),
                Err(BridgeFrontEndError::BadExcitation)
            );
        }
        assert!(made(good.noise(-1.0), Excitation::Reference).is_err());
        assert!(made(good.gauge_factor_within(1.0), Excitation::Reference).is_err());
        let measured = Excitation::Measured { channel: 1, volts_per_count: 1.0 };
        assert_eq!(made(good, measured), Err(BridgeFrontEndError::NoSuchInput { channel: 1 }));
    }
}
