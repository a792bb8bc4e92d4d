//! What an ADS1256 can be set to.

use crate::converters::{ConverterFigures, NoiseFigure, RateFigure, ReferenceSource};

/// A rate, and the microseconds after which another input has settled; commands take 18.6 µs besides, so that it goes
/// through 4374 inputs a second at the fastest (table 14).
const fn at(conversions: f64, settling: f64) -> RateFigure {
    RateFigure { conversions, settled: 1e6 / (settling + 18.6) }
}

/// Of an ADS1256 at 7.68 MHz with its buffer on. The noise is that of the first page of the data sheet: 27 nV at gain 64
/// and the slowest rate, 21.3 effective bits of 10 V where inputs are cycled at 1.45 kHz.
pub(super) const FIGURES: ConverterFigures = ConverterFigures {
    gains: &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0],
    range: 2.0,
    reference: ReferenceSource::Pins { least: 0.5, greatest: 2.6 },
    inputs: 4,
    together: false,
    rates: &[
        at(2.5, 400_180.0),
        at(5.0, 200_180.0),
        at(10.0, 100_180.0),
        at(15.0, 66_840.0),
        at(25.0, 40_180.0),
        at(30.0, 33_510.0),
        at(50.0, 20_180.0),
        at(60.0, 16_840.0),
        at(100.0, 10_180.0),
        at(500.0, 2180.0),
        at(1000.0, 1180.0),
        at(2000.0, 680.0),
        at(3750.0, 440.0),
        at(7500.0, 310.0),
        at(15_000.0, 250.0),
        at(30_000.0, 210.0),
    ],
    noise: &[
        NoiseFigure { gain: 1.0, conversions: 2000.0, volts: 3.9e-6 },
        NoiseFigure { gain: 64.0, conversions: 2.5, volts: 27e-9 },
    ],
};

#[cfg(test)]
mod tests {
    use super::FIGURES;
    use crate::converters::ads1256::{Gain, Rate};

    #[test]
    fn figures_are_those_of_the_driver() {
        use Gain::{X1, X2, X4, X8, X16, X32, X64};
        let gains = [X1, X2, X4, X8, X16, X32, X64];
        assert_eq!(FIGURES.gains, gains.map(Gain::factor));
        for gain in gains {
            assert_eq!(gain.full_scale(), FIGURES.range / gain.factor());
        }
        assert_eq!(FIGURES.rates.len(), Rate::ALL.len());
        for (figure, rate) in FIGURES.rates.iter().rev().zip(Rate::ALL) {
            let settled = 1e6 / (f64::from(rate.settling()) + 18.6);
            assert!((figure.settled / settled - 1.0).abs() < 1e-12, "{rate:?}");
            // The rate by its own name.
            let name = format!("{rate:?}").replace("Hz", "").replace('_', ".");
            assert_eq!(name.parse(), Ok(figure.conversions));
        }
        assert!((FIGURES.rates[15].settled - 4374.0).abs() < 1.0);
        // Effective bits: the range, from −2·VREF to 2·VREF, over the noise.
        assert!(((10.0 / FIGURES.noise[0].volts).log2() - 21.3).abs() < 0.05);
    }
}
