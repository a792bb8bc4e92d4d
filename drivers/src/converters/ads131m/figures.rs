//! What an ADS131M can be set to.

use crate::converters::{ConverterFigures, NoiseFigure, RateFigure, ReferenceSource};

const fn at(conversions: f64) -> RateFigure {
    RateFigure { conversions, settled: conversions }
}

/// The noise of a gain \[µV\] at 250 Hz, 500 Hz and so on to 32 kHz.
const fn noise<const M: usize>(
    mut figures: [NoiseFigure; M],
    from: usize,
    gain: f64,
    microvolts: [f64; 8],
) -> [NoiseFigure; M] {
    let (mut place, mut conversions) = (0, 250.0);
    while place < 8 {
        figures[from + place] = NoiseFigure { gain, conversions, volts: microvolts[place] * 1e-6 };
        (place, conversions) = (place + 1, conversions * 2.0);
    }
    figures
}

/// Noise Measurements, table 7-1: the chips of the family have one table. Gains of 64 and 128 are as 32; that of 16 lies
/// between 8 and 32 and is taken as 8.
const NOISE: [NoiseFigure; 40] = {
    let none = [NoiseFigure { gain: 0.0, conversions: 0.0, volts: 0.0 }; 40];
    let one = noise(none, 0, 1.0, [1.90, 2.39, 3.38, 4.25, 5.35, 7.56, 10.68, 21.31]);
    let two = noise(one, 8, 2.0, [1.69, 2.13, 2.99, 3.91, 4.68, 6.62, 9.56, 15.26]);
    let four = noise(two, 16, 4.0, [1.56, 2.13, 2.88, 3.79, 4.52, 6.37, 9.09, 13.52]);
    let eight = noise(four, 24, 8.0, [0.95, 1.29, 1.74, 2.27, 2.70, 3.82, 5.42, 7.89]);
    noise(eight, 32, 32.0, [0.42, 0.57, 0.77, 1.00, 1.20, 1.69, 2.40, 3.42])
};

/// Of an ADS131M08 at 8.192 MHz, in the mode of high resolution, with the reference inside.
pub(super) const FIGURES: ConverterFigures = ConverterFigures {
    gains: &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0],
    range: 1.0,
    reference: ReferenceSource::Inside { volts: 1.2 },
    inputs: 8,
    together: true,
    rates: &[at(250.0), at(500.0), at(1e3), at(2e3), at(4e3), at(8e3), at(16e3), at(32e3)],
    noise: &NOISE,
};

#[cfg(test)]
mod tests {
    use super::FIGURES;
    use crate::converters::ReferenceSource;
    use crate::converters::ads131m::{Configuration, Gain, Oversampling};

    #[test]
    fn figures_are_those_of_the_driver() {
        use Gain::{X1, X2, X4, X8, X16, X32, X64, X128};
        let gains = [X1, X2, X4, X8, X16, X32, X64, X128];
        assert_eq!(FIGURES.gains, gains.map(Gain::factor));
        assert_eq!(FIGURES.reference, ReferenceSource::Inside { volts: Configuration::<8>::REFERENCE });
        for gain in gains {
            let full_scale = Configuration::<8>::default().gain(gain).full_scale(0, 1.2);
            assert_eq!(full_scale, Some(FIGURES.range * 1.2 / gain.factor()));
        }
        use Oversampling::{X128 as O128, X256, X512, X1024, X2048, X4096, X8192, X16384};
        let slow_first = [X16384, X8192, X4096, X2048, X1024, X512, X256, O128];
        let rate =
            |oversampling| Configuration::<8> { oversampling, ..Configuration::default() }.data_rate(8.192e6);
        assert!(FIGURES.rates.iter().map(|figure| figure.conversions).eq(slow_first.map(rate)));
    }
}
