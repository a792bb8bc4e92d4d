//! One bridge at one input.

use fingertip_wrench::Real;

use super::circuit::BridgeCircuit;

/// Where the excitation of the bridges is known from.
///
/// ```
/// use fingertip_drivers::bridge::{BridgeChannel, BridgeCircuit, BridgeFrontEnd, CountScale, Excitation};
/// use nalgebra::Vector2;
///
/// // The bridge is at input 0, and its excitation, over a divider, at input 1.
/// let bridge = BridgeChannel::new(0, BridgeCircuit::full(), 2.0, CountScale::bits24(1.2 / 32.0));
/// let excitation = Excitation::Measured { channel: 1, volts_per_count: 0.6e-6 };
/// let front_end = BridgeFrontEnd::<f64, 1, 2>::new([bridge], excitation)?;
/// // The same strain from 3.0 V as from a battery that has sunk to 2.7 V.
/// let fresh = front_end.strain(&Vector2::new(1e6, 5e6))?;
/// let sunk = front_end.strain(&Vector2::new(0.9e6, 4.5e6))?;
/// assert!((fresh - sunk).amax() < 1e-15 && (fresh.x - 745e-6).abs() < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Excitation<T> {
    /// The reference of the converter is taken from it, so that its drift falls out. Full scales are then
    /// in volts per volt of excitation: 0.5 over the gain for HX711 and NAU7802; for an ADS1256 or MCP3564
    /// with its reference at the excitation 2 or 1 over the gain.
    Reference,
    /// It stays at this voltage \[V\]. What it drifts by is an error of the strain.
    Steady {
        /// Voltage \[V\].
        volts: T,
    },
    /// The converter measures it at one of its channels, at the same moment as the bridges.
    Measured {
        /// The channel.
        channel: usize,
        /// Volts of excitation for each count of that channel, its divider included.
        volts_per_count: T,
    },
}

/// What the counts of an input are.
///
/// ```
/// use fingertip_drivers::bridge::CountScale;
///
/// // An HX711 at gain 128, with the excitation as its reference: a count is half a nanovolt per volt.
/// let scale = CountScale::bits24(0.5 / 128.0);
/// assert!((scale.full_scale / scale.full_scale_counts - 0.466e-9_f64).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountScale<T> {
    /// Counts at full scale: 2²³ for a converter of 24 bits and two signs. A count beyond the last but one
    /// is taken for clipped.
    pub full_scale_counts: T,
    /// Volts between the inputs at full scale, or volts per volt of excitation (see
    /// [`Excitation::Reference`]): the gain is in it.
    pub full_scale: T,
    /// Share by which the full scale may be off, gain and reference error together: 0.001 for 0.1 %.
    pub tolerance: T,
}

impl<T: Real> CountScale<T> {
    /// A converter of 24 bits, as all in this crate, whose full scale is exact.
    #[must_use]
    pub fn bits24(full_scale: T) -> Self {
        Self { full_scale_counts: T::literal(8_388_608.0), full_scale, tolerance: T::zero() }
    }
}

/// One bridge at one input of a converter.
///
/// ```
/// use fingertip_drivers::bridge::{BridgeChannel, BridgeCircuit, BridgeFrontEnd, CountScale, Excitation};
/// use nalgebra::Vector1;
///
/// // Two gauges on a beam, whose factor is 2.1 within 1 %.
/// let beam = BridgeChannel::new(0, BridgeCircuit::half_bending(), 2.1, CountScale::bits24(0.5 / 128.0))
///     .gauge_factor_within(0.01);
/// let front_end = BridgeFrontEnd::<f64, 1, 1>::new([beam], Excitation::Reference)?;
/// let strains = front_end.strain_with_bounds(&Vector1::new(1e6))?;
/// // Ratio 0.466 mV/V, half a gauge's change, over the factor; and 1 % of that.
/// assert!((strains.strain.x - 443.5e-6).abs() < 0.1e-6);
/// assert!((strains.scale_error.x - 4.5e-6).abs() < 0.1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeChannel<T> {
    /// Index of the converter's channel.
    pub input: usize,
    /// Which gauges it has.
    pub circuit: BridgeCircuit<T>,
    /// Relative change of resistance per strain: about 2 for metal; negative ones turn the sign round.
    pub gauge_factor: T,
    /// Share by which the gauge factor may be off: 0.01 for 1 %.
    pub gauge_factor_tolerance: T,
    /// What the counts are.
    pub scale: CountScale<T>,
    /// Standard deviation of the noise, in counts: that of the converter's data sheet at this gain and
    /// rate, or better one that was measured with the bridge at rest.
    pub noise_counts: T,
}

impl<T: Real> BridgeChannel<T> {
    /// A bridge whose numbers are exact and free of noise.
    #[must_use]
    pub fn new(input: usize, circuit: BridgeCircuit<T>, gauge_factor: T, scale: CountScale<T>) -> Self {
        Self {
            input,
            circuit,
            gauge_factor,
            gauge_factor_tolerance: T::zero(),
            scale,
            noise_counts: T::zero(),
        }
    }

    /// With noise in counts.
    #[must_use]
    pub fn noise(self, noise_counts: T) -> Self {
        Self { noise_counts, ..self }
    }

    /// With a tolerance of the gauge factor.
    #[must_use]
    pub fn gauge_factor_within(self, gauge_factor_tolerance: T) -> Self {
        Self { gauge_factor_tolerance, ..self }
    }
}
