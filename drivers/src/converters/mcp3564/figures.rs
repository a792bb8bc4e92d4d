//! What an MCP3564 can be set to.

use crate::converters::{ConverterFigures, NoiseFigure, RateFigure, ReferenceSource};

/// Clocks of the modulator a second, a quarter of the clock inside.
const MODULATOR: f64 = 1_228_800.0;

/// The rates of an oversampling. The filter is three deep up to 512, so that another input takes three times as long; what
/// is beyond is averaged.
const fn at(oversampling: f64) -> RateFigure {
    let filtered = if oversampling > 512.0 { 512.0 } else { oversampling };
    RateFigure { conversions: MODULATOR / oversampling, settled: MODULATOR / (oversampling + 2.0 * filtered) }
}

/// Of an MCP3564 with the clock inside and the reference at its pins. The noise is that of the first page of the data
/// sheet: 90 nV at gain 16 and 12.5 Hz.
pub(super) const FIGURES: ConverterFigures = ConverterFigures {
    gains: &[1.0 / 3.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0],
    range: 1.0,
    reference: ReferenceSource::Pins { least: 0.6, greatest: 3.6 },
    inputs: 4,
    together: false,
    rates: &[
        at(98304.0),
        at(81920.0),
        at(49152.0),
        at(40960.0),
        at(24576.0),
        at(20480.0),
        at(16384.0),
        at(8192.0),
        at(4096.0),
        at(2048.0),
        at(1024.0),
        at(512.0),
        at(256.0),
        at(128.0),
        at(64.0),
        at(32.0),
    ],
    noise: &[NoiseFigure { gain: 16.0, conversions: 12.5, volts: 90e-9 }],
};

#[cfg(test)]
mod tests {
    use super::FIGURES;
    use crate::converters::mcp3564::{Channel, Configuration, Gain, Oversampling};

    #[test]
    fn figures_are_those_of_the_driver() {
        use Gain::{Third, X1, X2, X4, X8, X16, X32, X64};
        let gains = [Third, X1, X2, X4, X8, X16, X32, X64];
        assert_eq!(FIGURES.gains, gains.map(Gain::factor));
        for gain in gains {
            assert_eq!(gain.full_scale(), FIGURES.range / gain.factor());
        }
        let all = [
            Oversampling::X32,
            Oversampling::X64,
            Oversampling::X128,
            Oversampling::X256,
            Oversampling::X512,
            Oversampling::X1024,
            Oversampling::X2048,
            Oversampling::X4096,
            Oversampling::X8192,
            Oversampling::X16384,
            Oversampling::X20480,
            Oversampling::X24576,
            Oversampling::X40960,
            Oversampling::X49152,
            Oversampling::X81920,
            Oversampling::X98304,
        ];
        assert_eq!(FIGURES.rates.len(), all.len());
        for (figure, oversampling) in FIGURES.rates.iter().rev().zip(all) {
            let configuration = Configuration { oversampling, ..Configuration::new([Channel::PairA]) };
            assert!((figure.conversions / configuration.data_rate(4.9152e6) - 1.0).abs() < 1e-12);
            let slower = figure.conversions / figure.settled;
            // Three times up to 512, and 1 + 1024/98304 at the slowest.
            assert!((1.01..3.0 + 1e-12).contains(&slower), "{oversampling:?}: {slower}");
            assert_eq!(oversampling.ratio() <= 512, slower > 2.999);
        }
    }
}
