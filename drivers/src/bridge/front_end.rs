//! All bridges of a fingertip.

use fingertip_wrench::Real;
use nalgebra::SVector;
use thiserror::Error;

use super::channel::{BridgeChannel, Excitation};
use crate::{SourceError, SourceErrorKind};

/// Why a front end cannot be made. Channels count from 0.
///
/// ```
/// use fingertip_drivers::bridge::{BridgeChannel, BridgeCircuit, BridgeFrontEnd, CountScale, Excitation};
///
/// // A converter with two channels has no input 2.
/// let bridge = BridgeChannel::new(2, BridgeCircuit::full(), 2.0, CountScale::bits24(0.02));
/// let refused = BridgeFrontEnd::<f64, 1, 2>::new([bridge], Excitation::Reference).unwrap_err();
/// assert_eq!(refused.to_string(), "bridge 0 is at an input that the converter does not have");
/// ```
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
///
/// [`BridgeFrontEnd`] shows what gives one.
///
/// ```
/// use fingertip_drivers::bridge::BridgeFault;
/// use fingertip_drivers::{SourceError, SourceErrorKind};
///
/// assert_eq!(BridgeFault::Saturated { channel: 2 }.kind(), SourceErrorKind::Overload);
/// let told = "bridge 2 gives more than any strain does: is a gauge or a wire broken?";
/// assert_eq!(BridgeFault::Implausible { channel: 2 }.to_string(), told);
/// ```
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
///
/// ```
/// use fingertip_drivers::bridge::{BridgeChannel, BridgeCircuit, BridgeFrontEnd, CountScale, Excitation};
/// use nalgebra::Vector2;
///
/// let bridge =
///     |input| BridgeChannel::new(input, BridgeCircuit::full(), 2.0, CountScale::bits24(0.02)).noise(50.0);
/// let front_end = BridgeFrontEnd::<f64, 2, 2>::new([bridge(0), bridge(1)], Excitation::Reference)?;
/// let strains = front_end.strain_with_bounds(&Vector2::new(419_430.4, 8_388_607.0))?;
/// assert!((strains.strain.x - 500e-6).abs() < 1e-15);
/// assert!((strains.noise.x - 0.06e-6).abs() < 0.001e-6 && strains.resolution.x < 0.001e-6);
/// assert_eq!(strains.saturated, [false, true]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
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
///
/// ```
/// use fingertip_drivers::bridge::{
///     BridgeChannel, BridgeCircuit, BridgeFault, BridgeFrontEnd, CountScale, Excitation,
/// };
/// use nalgebra::Vector1;
///
/// let bridge = BridgeChannel::new(0, BridgeCircuit::quarter(), 2.0, CountScale::bits24(1.0));
/// let front_end = BridgeFrontEnd::<f64, 1, 1>::new([bridge], Excitation::Reference)?;
/// let strain = front_end.strain(&Vector1::new(4190.0))?; // 0.4995 mV/V
/// assert!((strain.x - 1000e-6).abs() < 0.1e-6);
/// // An open gauge gives half the excitation.
/// let broken = front_end.strain(&Vector1::new(4_194_304.0));
/// assert_eq!(broken, Err(BridgeFault::Implausible { channel: 0 }));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
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
mod tests;
