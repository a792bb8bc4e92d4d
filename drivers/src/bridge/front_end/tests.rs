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
    let bridge = BridgeChannel::new(0, BridgeCircuit::quarter(), 2.0, CountScale::bits24(0.02)).noise(50.0);
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
        assert_eq!(made(good, Excitation::Steady { volts: bad }), Err(BridgeFrontEndError::BadExcitation));
    }
    assert!(made(good.noise(-1.0), Excitation::Reference).is_err());
    assert!(made(good.gauge_factor_within(1.0), Excitation::Reference).is_err());
    let measured = Excitation::Measured { channel: 1, volts_per_count: 1.0 };
    assert_eq!(made(good, measured), Err(BridgeFrontEndError::NoSuchInput { channel: 1 }));
}
