//! What an NAU7802 can be set to.

use crate::converters::{ConverterFigures, NoiseFigure, RateFigure, ReferenceSource};

/// Four conversions are thrown away after a change of input.
const fn at(conversions: f64) -> RateFigure {
    RateFigure { conversions, settled: conversions / 5.0 }
}

/// Of one input of a chip: all chips have one address, so that each stands on a bus of its own or behind a switch. The
/// noise is as the list of features has it, 50 nV at 10 Hz and 150 nV at 80 Hz.
pub(super) const FIGURES: ConverterFigures = ConverterFigures {
    gains: &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0],
    range: 0.5,
    reference: ReferenceSource::Supply { least: 2.4, greatest: 5.5 },
    inputs: 1,
    together: true,
    rates: &[at(10.0), at(20.0), at(40.0), at(80.0), at(320.0)],
    noise: &[
        NoiseFigure { gain: 128.0, conversions: 10.0, volts: 50e-9 },
        NoiseFigure { gain: 128.0, conversions: 80.0, volts: 150e-9 },
    ],
};

#[cfg(test)]
mod tests {
    use super::FIGURES;
    use crate::converters::nau7802::{Gain, Rate};

    #[test]
    fn figures_are_those_of_the_driver() {
        use Gain::{X1, X2, X4, X8, X16, X32, X64, X128};
        let gains = [X1, X2, X4, X8, X16, X32, X64, X128];
        assert_eq!(FIGURES.gains, gains.map(Gain::factor));
        for gain in gains {
            assert_eq!(gain.full_scale(), FIGURES.range / gain.factor());
        }
        let rates = [Rate::Hz10, Rate::Hz20, Rate::Hz40, Rate::Hz80, Rate::Hz320];
        assert!(FIGURES.rates.iter().map(|figure| figure.conversions).eq(rates.map(Rate::hertz)));
    }
}
