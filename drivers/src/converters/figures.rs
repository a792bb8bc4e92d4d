//! What a converter can be set to, as its data sheet says, and which of it suits bridges.

use thiserror::Error;

/// Where the full scale of a converter comes from.
///
/// ```
/// use fingertip_drivers::converters::ReferenceSource;
/// use fingertip_drivers::devices;
///
/// let figures = devices::devices().iter().find(|device| device.name == "hx711").unwrap().converter.unwrap();
/// assert_eq!(figures.reference, ReferenceSource::Supply { least: 2.6, greatest: 5.5 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ReferenceSource {
    /// Its analogue supply, which is that of the bridges too.
    Supply {
        /// Least \[V\].
        least: f64,
        /// Greatest \[V\].
        greatest: f64,
    },
    /// Its pins, at which a share of the bridges' supply is put.
    Pins {
        /// Least \[V\].
        least: f64,
        /// Greatest \[V\].
        greatest: f64,
    },
    /// Itself: the supply of the bridges has to be measured at an input of its own.
    Inside {
        /// Its voltage \[V\].
        volts: f64,
    },
}

/// One of the rates of a converter.
///
/// ```
/// use fingertip_drivers::devices;
///
/// // An HX711 that changes its input has to settle for four conversions.
/// let figures = devices::devices().iter().find(|device| device.name == "hx711").unwrap().converter.unwrap();
/// assert!(figures.rates.iter().all(|rate| rate.settled == rate.conversions / 4.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateFigure {
    /// Conversions of one input a second \[Hz\]: what the setting is called by.
    pub conversions: f64,
    /// Conversions a second \[Hz\] where each is of another input, which has to settle.
    pub settled: f64,
}

/// The noise that a data sheet states for a gain and a rate.
///
/// ```
/// use fingertip_drivers::devices;
///
/// // At gain 128 the data sheet of an HX711 states 50 nV at 10 Hz, and 90 nV at 80 Hz.
/// let figures = devices::devices().iter().find(|device| device.name == "hx711").unwrap().converter.unwrap();
/// let volts: Vec<_> = figures.noise.iter().map(|noise| (noise.conversions, noise.volts)).collect();
/// assert_eq!(volts, [(10.0, 50e-9), (80.0, 90e-9)]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseFigure {
    /// The gain.
    pub gain: f64,
    /// The conversions a second \[Hz\].
    pub conversions: f64,
    /// Standard deviation, at the input \[V\].
    pub volts: f64,
}

/// What a converter can be set to.
///
/// [`devices`](crate::devices::devices) has those of each chip. Which of them give 1000 samples of six bridges a
/// second, and how many chips does it take?
///
/// ```
/// use fingertip_drivers::converters::BridgeDemand;
/// use fingertip_drivers::devices;
///
/// let demand = BridgeDemand { bridges: 6, supply: 3.3, greatest_ratio: 0.003, rate: 1000.0 };
/// let mut quick: Vec<_> = devices::devices()
///     .iter()
///     .filter_map(|device| {
///         let setting = device.converter?.setting(&demand).ok()?;
///         (setting.samples >= demand.rate).then_some((device.name, setting.chips))
///     })
///     .collect();
/// quick.sort();
/// assert_eq!(quick, [("ads1256", 2), ("ads131m", 1), ("mcp3564", 2)]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConverterFigures {
    /// The gains, rising.
    pub gains: &'static [f64],
    /// Volts at the input that make full scale, 2²³ counts, at gain 1, for each volt of the reference.
    pub range: f64,
    /// Where the reference comes from.
    pub reference: ReferenceSource,
    /// Inputs of a chip for bridges.
    pub inputs: usize,
    /// All inputs are converted at the same moment, rather than one after the other.
    pub together: bool,
    /// The rates, rising.
    pub rates: &'static [RateFigure],
    /// The noise, as far as it is stated, by rising gain and then by rising rate.
    pub noise: &'static [NoiseFigure],
}

/// What bridges ask of a converter.
///
/// ```
/// use fingertip_drivers::converters::BridgeDemand;
/// use fingertip_drivers::devices;
///
/// // Bridges that give up to 10 mV/V do not bear the greatest gain, at which full scale is 3.9 mV/V.
/// let figures = devices::devices().iter().find(|device| device.name == "hx711").unwrap().converter.unwrap();
/// let demand = BridgeDemand { bridges: 6, supply: 3.3, greatest_ratio: 0.010, rate: 10.0 };
/// assert_eq!(figures.setting(&demand)?.gain, 32.0);
/// assert_eq!(figures.setting(&BridgeDemand { greatest_ratio: 0.003, ..demand })?.gain, 128.0);
/// # Ok::<(), fingertip_drivers::converters::UnsuitableConverter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeDemand {
    /// Bridges, one for the dummy included.
    pub bridges: usize,
    /// Their supply \[V\].
    pub supply: f64,
    /// The greatest output of a bridge, of either sign, over its supply: what it is out of balance at rest by,
    /// and what the loads add.
    pub greatest_ratio: f64,
    /// Samples of all bridges a second that are wanted \[Hz\].
    pub rate: f64,
}

/// The settings of a converter for bridges, and what is to be expected of it.
///
/// ```
/// use fingertip_drivers::converters::BridgeDemand;
/// use fingertip_drivers::devices;
///
/// let figures = devices::devices().iter().find(|device| device.name == "hx711").unwrap().converter.unwrap();
/// let demand = BridgeDemand { bridges: 6, supply: 3.3, greatest_ratio: 0.003, rate: 10.0 };
/// let setting = figures.setting(&demand)?;
/// assert_eq!((setting.chips, setting.gain, setting.samples), (6, 128.0, 10.0));
/// // 1 mV/V is a quarter of the range.
/// assert!((setting.counts_per_ratio() * 0.001 - 2_147_483.6).abs() < 0.1);
/// # Ok::<(), fingertip_drivers::converters::UnsuitableConverter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeSetting {
    /// How many chips it takes.
    pub chips: usize,
    /// The gain.
    pub gain: f64,
    /// The reference \[V\].
    pub reference: f64,
    /// The supply of the bridges over the reference, where that is made of it; `None` where it is not.
    pub divider: Option<f64>,
    /// The rate to set \[Hz\].
    pub conversions: f64,
    /// Samples of all bridges a second that come of it \[Hz\].
    pub samples: f64,
    /// Output of a bridge over its supply that makes full scale, 2²³ counts.
    pub full_scale: f64,
    /// Noise of the converter \[V\], standard deviation at its input, as its data sheet has it for inputs that are
    /// shorted.
    pub noise: f64,
}

/// Why a converter does not suit bridges.
///
/// ```
/// use fingertip_drivers::converters::BridgeDemand;
/// use fingertip_drivers::devices;
///
/// let figures = devices::devices().iter().find(|device| device.name == "hx711").unwrap().converter.unwrap();
/// let demand = BridgeDemand { bridges: 6, supply: 10.0, greatest_ratio: 0.003, rate: 10.0 };
/// let told = figures.setting(&demand).unwrap_err().to_string();
/// assert_eq!(told, "it needs a supply of 2.6 to 5.5 V, not of 10 V");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum UnsuitableConverter {
    /// No such supply, or no reference can be made of it.
    #[error("it needs a supply of {least} to {greatest} V, not of {supply} V")]
    Supply {
        /// What the supply is \[V\].
        supply: f64,
        /// Least \[V\].
        least: f64,
        /// Greatest \[V\].
        greatest: f64,
    },
    /// The bridges give more than its least gain bears.
    #[error("a bridge gives up to {ratio} V/V, and its least gain bears {greatest} V/V")]
    TooLarge {
        /// What the bridges give.
        ratio: f64,
        /// What the converter bears.
        greatest: f64,
    },
    /// There are no bridges, or a number is not positive and finite.
    #[error("bridges, their supply, their output and the rate must be positive and finite")]
    BadDemand,
}

/// Part of the full scale that bridges may take, so that an overload is seen before the range ends.
const USED: f64 = 0.9;

impl ConverterFigures {
    /// The settings for bridges: the greatest gain at which what they give stays within nine tenths of the range, and the
    /// slowest rate that is not slower than the wanted one (or the fastest there is). Slow is quiet.
    ///
    /// # Errors
    /// [`UnsuitableConverter`].
    pub fn setting(&self, demand: &BridgeDemand) -> Result<BridgeSetting, UnsuitableConverter> {
        let BridgeDemand { bridges, supply, greatest_ratio, rate } = *demand;
        let is_good = |number: f64| number > 0.0 && number.is_finite();
        if bridges == 0 || ![supply, greatest_ratio, rate].into_iter().all(is_good) {
            return Err(UnsuitableConverter::BadDemand);
        }
        let (reference, divider) = self.reference(supply)?;
        let full_scale = |gain: f64| self.range * reference / (gain * supply);
        let bears = |gain: &&f64| greatest_ratio <= USED * full_scale(**gain);
        let Some(&gain) = self.gains.iter().rev().find(bears) else {
            let greatest = USED * self.gains.first().map_or(0.0, |gain| full_scale(*gain));
            return Err(UnsuitableConverter::TooLarge { ratio: greatest_ratio, greatest });
        };
        // One input measures the supply, if nothing else tells it.
        let free = if divider.is_none() { self.inputs.saturating_sub(1) } else { self.inputs };
        let chips = bridges.div_ceil(free.max(1));
        let on_a_chip = bridges.div_ceil(chips);
        let samples = |figure: &RateFigure| {
            if self.together || on_a_chip == 1 {
                figure.conversions
            } else {
                figure.settled / on_a_chip as f64
            }
        };
        let chosen = self.rates.iter().find(|figure| samples(figure) >= rate).or(self.rates.last());
        let chosen = chosen.ok_or(UnsuitableConverter::BadDemand)?;
        Ok(BridgeSetting {
            chips,
            gain,
            reference,
            divider,
            conversions: chosen.conversions,
            samples: samples(chosen),
            full_scale: full_scale(gain),
            noise: self.noise(gain, chosen.conversions),
        })
    }

    /// The reference \[V\], and the supply over it.
    fn reference(&self, supply: f64) -> Result<(f64, Option<f64>), UnsuitableConverter> {
        let within = |reference: f64, least: f64, greatest: f64| (least..=greatest).contains(&reference);
        match self.reference {
            ReferenceSource::Inside { volts } => Ok((volts, None)),
            ReferenceSource::Supply { least, greatest } if within(supply, least, greatest) => {
                Ok((supply, Some(1.0)))
            }
            ReferenceSource::Pins { least, greatest } => {
                // Equal resistors make whole parts.
                let parts = (supply / greatest).ceil().max(1.0);
                if within(supply / parts, least, greatest) {
                    Ok((supply / parts, Some(parts)))
                } else {
                    Err(UnsuitableConverter::Supply { supply, least, greatest: f64::INFINITY })
                }
            }
            ReferenceSource::Supply { least, greatest } => {
                Err(UnsuitableConverter::Supply { supply, least, greatest })
            }
        }
    }

    /// The noise \[V\] of a gain and a rate, from the figures there are, on the side of more: that of the greatest gain
    /// up to this one (noise at the input falls as the gain rises), at the slowest rate that is not slower. Beyond the
    /// figures noise grows as the root of the rate, and in inverse proportion to the gain. NaN without figures.
    #[must_use]
    pub fn noise(&self, gain: f64, conversions: f64) -> f64 {
        let known = self.noise.iter().rev().find(|figure| figure.gain <= gain).or(self.noise.first());
        let Some(known) = known else { return f64::NAN };
        let mut alike = self.noise.iter().filter(|figure| figure.gain == known.gain);
        let figure = alike.find(|figure| figure.conversions >= conversions).unwrap_or(known);
        let faster = (conversions / figure.conversions).max(1.0);
        let weaker = (figure.gain / gain).max(1.0);
        figure.volts * faster.sqrt() * weaker
    }
}

impl BridgeSetting {
    /// Counts for each part of a bridge's output over its supply.
    #[must_use]
    pub fn counts_per_ratio(&self) -> f64 {
        8_388_608.0 / self.full_scale
    }
}

#[cfg(test)]
mod tests;
