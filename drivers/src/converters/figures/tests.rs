use nalgebra::Vector1;
use proptest::prelude::*;

use super::*;
use crate::bridge::{BridgeChannel, BridgeCircuit, BridgeFrontEnd, CountScale, Excitation};
use crate::devices::devices;

fn all() -> Vec<(&'static str, &'static ConverterFigures)> {
    let all: Vec<_> = devices().iter().filter_map(|device| Some((device.name, device.converter?))).collect();
    assert_eq!(all.len(), 5, "the five converters");
    all
}

fn of(name: &str) -> &'static ConverterFigures {
    all().into_iter().find(|(known, _)| *known == name).unwrap().1
}

const SIX: BridgeDemand = BridgeDemand { bridges: 7, supply: 5.0, greatest_ratio: 2e-3, rate: 200.0 };

#[test]
fn figures_are_in_order() {
    for (name, figures) in all() {
        assert!(figures.gains.is_sorted() && figures.gains[0] > 0.0, "{name}");
        assert!(
            figures.rates.is_sorted_by(|a, b| a.conversions < b.conversions && a.settled < b.settled),
            "{name}"
        );
        assert!(
            figures.rates.iter().all(|rate| 0.0 < rate.settled && rate.settled <= rate.conversions),
            "{name}"
        );
        let order = |a: &NoiseFigure, b: &NoiseFigure| (a.gain, a.conversions) < (b.gain, b.conversions);
        assert!(figures.noise.is_sorted_by(order) && !figures.noise.is_empty(), "{name}");
        // From 20 nV to 100 µV.
        assert!(figures.noise.iter().all(|noise| (2e-8..1e-4).contains(&noise.volts)), "{name}");
    }
}

#[test]
fn settings_for_six_gauges_are_those_that_one_would_choose() {
    let found = |name: &str| of(name).setting(&SIX).unwrap();
    // Seven gauges and the supply at one chip; ±1.2 V over 64 is 18.8 mV for 10 mV.
    let ads131m = found("ads131m");
    assert_eq!((ads131m.chips, ads131m.gain, ads131m.reference, ads131m.divider), (1, 64.0, 1.2, None));
    assert_eq!((ads131m.conversions, ads131m.samples), (250.0, 250.0));
    assert!((ads131m.full_scale - 1.2 / 64.0 / 5.0).abs() < 1e-15);
    // Four pairs on the one and three on the other; the reference of 2.5 V is half the supply.
    let ads1256 = found("ads1256");
    assert_eq!((ads1256.chips, ads1256.gain, ads1256.reference, ads1256.divider), (2, 64.0, 2.5, Some(2.0)));
    assert_eq!(ads1256.conversions, 1000.0);
    assert!((ads1256.samples - 837.0 / 4.0).abs() < 1.0, "{}", ads1256.samples);
    assert!((ads1256.full_scale - 1.0 / 64.0).abs() < 1e-15);
    let mcp3564 = found("mcp3564");
    assert_eq!((mcp3564.chips, mcp3564.gain, mcp3564.divider), (2, 64.0, Some(2.0)));
    // The fastest there is, a chip for each.
    let hx711 = found("hx711");
    assert_eq!((hx711.chips, hx711.gain, hx711.samples, hx711.divider), (7, 128.0, 80.0, Some(1.0)));
    assert_eq!((hx711.full_scale, hx711.noise), (0.5 / 128.0, 90e-9));
    let nau7802 = found("nau7802");
    assert_eq!((nau7802.chips, nau7802.gain, nau7802.samples), (7, 128.0, 320.0));
}

proptest! {
    /// Whatever is asked: the range holds what the bridges give and twice the gain would not; the rate is the slowest
    /// that suffices.
    #[test]
    fn a_setting_is_the_best_that_holds(
        bridges in 1_usize..64, supply in 1.0_f64..12.0, ratio in 1e-6_f64..1.0, rate in 1.0_f64..1e5,
    ) {
        let demand = BridgeDemand { bridges, supply, greatest_ratio: ratio, rate };
        for (name, figures) in all() {
            let Ok(found) = figures.setting(&demand) else { continue };
            prop_assert!(ratio <= 0.9 * found.full_scale * (1.0 + 1e-12), "{}: {:?}", name, found);
            let next = figures.gains.iter().find(|gain| **gain > found.gain);
            if let Some(next) = next {
                prop_assert!(ratio > 0.9 * found.full_scale * found.gain / next * (1.0 - 1e-12), "{}: {:?}", name, found);
            }
            let slower = figures.rates.iter().rfind(|figure| figure.conversions < found.conversions);
            if let Some(slower) = slower {
                let samples = found.samples / found.conversions * slower.conversions;
                // Those of one input after the other do not grow in proportion: by a seventh of it at the fastest.
                prop_assert!(samples * 0.1 < rate, "{}: {:?}", name, found);
                let again = BridgeDemand { rate: 0.999 * found.samples, ..demand };
                prop_assert_eq!(figures.setting(&again).unwrap().conversions, found.conversions);
            }
            if found.samples < rate {
                prop_assert_eq!(Some(found.conversions), figures.rates.last().map(|figure| figure.conversions));
            }
            prop_assert!(found.chips <= bridges && found.noise > 0.0 && found.noise.is_finite());
            let free = figures.inputs - usize::from(found.divider.is_none());
            prop_assert!(found.chips * free >= bridges && (found.chips - 1) * free < bridges);
            if let Some(divider) = found.divider {
                prop_assert!((found.reference * divider / supply - 1.0).abs() < 1e-12 && divider.fract() == 0.0);
            }
        }
    }

    /// The counts that a setting promises are those that the driver's own bridges turn into the strain again.
    #[test]
    fn counts_become_the_strain_that_they_were(microstrain in -1500.0_f64..1500.0, supply in 3.0_f64..5.0) {
        let quarter = BridgeCircuit::quarter();
        let ratio = quarter.ratio(2.0 * microstrain * 1e-6);
        for (name, figures) in all() {
            let found = figures.setting(&BridgeDemand { supply, ..SIX }).unwrap();
            let counts = (ratio * found.counts_per_ratio()).round();
            let (scale, excitation) = match found.divider {
                Some(divider) => (figures.range / (found.gain * divider), Excitation::Reference),
                None => (figures.range * found.reference / found.gain, Excitation::Steady { volts: supply }),
            };
            let channel = BridgeChannel::new(0, quarter, 2.0, CountScale::bits24(scale));
            let front_end = BridgeFrontEnd::<f64, 1, 1>::new([channel], excitation).unwrap();
            let strain = front_end.strain(&Vector1::new(counts)).unwrap().x;
            // Half a count.
            let lost = 2.0 / found.counts_per_ratio();
            prop_assert!((strain - microstrain * 1e-6).abs() < lost, "{}: {} {}", name, strain, microstrain);
        }
    }
}

#[test]
fn noise_is_that_of_the_data_sheet_and_beyond_it_on_the_side_of_more() {
    let ads131m = of("ads131m");
    let volts = |gain, rate| ads131m.noise(gain, rate);
    // Between two rates that of the faster; above 32 as of 32, between 8 and 32 as of 8; beyond the rates by the root.
    for (gain, rate, expected) in [
        (1.0, 4000.0, 5.35e-6),
        (2.0, 250.0, 1.69e-6),
        (4.0, 500.0, 2.13e-6),
        (16.0, 2000.0, 2.27e-6),
        (32.0, 1000.0, 0.77e-6),
        (64.0, 900.0, 0.77e-6),
        (128.0, 32_000.0, 3.42e-6),
        (128.0, 128_000.0, 6.84e-6),
    ] {
        assert!(
            (volts(gain, rate) / expected - 1.0).abs() < 1e-12,
            "{gain} at {rate}: {}",
            volts(gain, rate)
        );
    }
    let hx711 = of("hx711");
    // Of a lower gain than any that is stated: in inverse proportion.
    assert_eq!((hx711.noise(128.0, 10.0), hx711.noise(64.0, 10.0)), (50e-9, 100e-9));
    let ads1256 = of("ads1256");
    assert!((ads1256.noise(64.0, 1000.0) / (27e-9 * 20.0) - 1.0).abs() < 1e-12);
    let none = ConverterFigures { noise: &[], ..*hx711 };
    assert!(none.noise(1.0, 1.0).is_nan());
}

#[test]
fn what_does_not_suit_is_said() {
    let hx711 = of("hx711");
    let refused = |demand: BridgeDemand| hx711.setting(&demand).unwrap_err();
    let supply = refused(BridgeDemand { supply: 12.0, ..SIX });
    assert_eq!(supply.to_string(), "it needs a supply of 2.6 to 5.5 V, not of 12 V");
    assert!(matches!(
        of("ads1256").setting(&BridgeDemand { supply: 0.1, ..SIX }),
        Err(UnsuitableConverter::Supply { .. })
    ));
    let large = refused(BridgeDemand { greatest_ratio: 0.1, ..SIX });
    assert_eq!(large, UnsuitableConverter::TooLarge { ratio: 0.1, greatest: 0.9 * 0.5 / 32.0 });
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for demand in [
            BridgeDemand { supply: bad, ..SIX },
            BridgeDemand { greatest_ratio: bad, ..SIX },
            BridgeDemand { rate: bad, ..SIX },
        ] {
            assert_eq!(refused(demand), UnsuitableConverter::BadDemand);
        }
    }
    assert_eq!(refused(BridgeDemand { bridges: 0, ..SIX }), UnsuitableConverter::BadDemand);
}
