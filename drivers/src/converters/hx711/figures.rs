//! What an HX711 can be set to.

use crate::converters::{ConverterFigures, NoiseFigure, RateFigure, ReferenceSource};

/// Input B, at gain 32, is for a bridge that needs the range; a chip converts one input. The noise is that of the Key
/// Electrical Characteristics.
pub(super) const FIGURES: ConverterFigures = ConverterFigures {
    gains: &[32.0, 64.0, 128.0],
    range: 0.5,
    reference: ReferenceSource::Supply { least: 2.6, greatest: 5.5 },
    inputs: 1,
    together: true,
    // Four conversions after a change of input.
    rates: &[RateFigure { conversions: 10.0, settled: 2.5 }, RateFigure { conversions: 80.0, settled: 20.0 }],
    noise: &[
        NoiseFigure { gain: 128.0, conversions: 10.0, volts: 50e-9 },
        NoiseFigure { gain: 128.0, conversions: 80.0, volts: 90e-9 },
    ],
};

#[cfg(test)]
mod tests {
    use super::FIGURES;
    use crate::converters::hx711::Mode;

    #[test]
    fn figures_are_those_of_the_driver() {
        let modes = [Mode::B32, Mode::A64, Mode::A128];
        assert_eq!(FIGURES.gains, modes.map(Mode::gain));
        for mode in modes {
            assert_eq!(mode.full_scale(), FIGURES.range / mode.gain());
        }
    }
}
