//! The bounds of strain at their worst cases: they hold there, and hardly more.

use fingertip_drivers::bridge::{
    BridgeChannel, BridgeCircuit, BridgeFrontEnd, CountScale, Excitation, Strains,
};
use nalgebra::{Vector1, Vector2};

const FULL: f64 = 8_388_608.0;

fn bridge(circuit: BridgeCircuit<f64>, full_scale: f64) -> BridgeChannel<f64> {
    BridgeChannel::new(0, circuit, 2.0, CountScale::bits24(full_scale))
}

/// What a bridge of ±10 mV per volt makes of a count.
fn strains(bridge: BridgeChannel<f64>, count: f64) -> Strains<f64, 1> {
    let front_end = BridgeFrontEnd::<f64, 1, 1>::new([bridge], Excitation::Reference).unwrap();
    front_end.strain_with_bounds(&Vector1::new(count)).unwrap()
}

/// Whether an error is within its bound and comes near it.
fn is_reached(error: f64, bound: f64, share: f64) {
    assert!(error <= bound && error >= share * bound, "{error:e} of {bound:e}");
}

#[test]
fn the_worst_scale_and_gauge_factor_reach_their_bound() {
    for (scale, gauge) in [(0.05, 0.0), (0.0, 0.03), (0.05, 0.03)] {
        for sign in [1.0, -1.0] {
            let mut full = bridge(BridgeCircuit::full(), 10e-3).gauge_factor_within(gauge);
            full.scale.tolerance = scale;
            let count = sign * 0.7 * FULL;
            let found = strains(full, count);
            let ratio = sign * 0.7 * 10e-3;
            assert!((found.strain.x - ratio / 2.0).abs() < 1e-17);
            // A full scale that is more by as much as can be, and a gauge factor that is less.
            let worst = ratio / (1.0 - scale) / (2.0 * (1.0 - gauge));
            is_reached((worst - found.strain.x).abs(), found.scale_error.x * (1.0 + 1e-12), 1.0 - 1e-12);
        }
    }
}

#[test]
fn where_the_bridge_is_not_linear_the_steepest_end_is_the_bound() {
    // A quarter bridge: the strain grows faster than the ratio. Both ends of the tolerance, at either sign.
    for strain in [0.02, -0.02] {
        let circuit = BridgeCircuit::quarter();
        let ratio = circuit.ratio(2.0 * strain);
        let mut quarter = bridge(circuit, 20e-3);
        quarter.scale.tolerance = 0.05;
        let found = strains(quarter, ratio / 20e-3 * FULL);
        for share in [1.0 / 0.95, 1.0 / 1.05] {
            let error = (circuit.change(ratio * share).unwrap() / 2.0 - found.strain.x).abs();
            is_reached(error, found.scale_error.x, 0.85);
        }
    }
}

#[test]
fn half_a_count_of_bridge_and_excitation_reach_their_bound() {
    // Without a measured excitation it is half a count of the bridge.
    let found = strains(bridge(BridgeCircuit::full(), 10e-3), 1e6);
    let half = 0.5 / FULL * 10e-3 / 2.0;
    assert!(found.resolution.x >= half && found.resolution.x < half * 1.000_001);
    // With one of a few counts: half a count more of the bridge, and half a count less of the excitation.
    for excitation in [1000.0, -1000.0, 4000.0] {
        for count in [3.0, 1e3, 2e5] {
            let measured = Excitation::Measured { channel: 1, volts_per_count: 1e-3 };
            let full = bridge(BridgeCircuit::full(), 2e-2);
            let front_end = BridgeFrontEnd::<f64, 1, 2>::new([full], measured).unwrap();
            let found = front_end.strain_with_bounds(&Vector2::new(count, excitation)).unwrap();
            let strain = |count: f64, excitation: f64| count / FULL * 2e-2 / (excitation * 1e-3) / 2.0;
            let worst = strain(count + 0.5, excitation - 0.5_f64.copysign(excitation));
            let error = (worst - strain(count, excitation)).abs();
            is_reached(error, found.resolution.x, 1.0 - 1e-6);
        }
    }
}

#[test]
fn noise_is_that_of_the_counts() {
    let found = strains(bridge(BridgeCircuit::full(), 10e-3).noise(40.0), 1e6);
    let expected = 40.0 / FULL * 10e-3 / 2.0;
    assert!((found.noise.x / expected - 1.0).abs() < 1e-14);
    let turned = BridgeChannel { gauge_factor: -2.0, ..bridge(BridgeCircuit::full(), 10e-3).noise(40.0) };
    let turned = strains(turned, 1e6);
    assert!((turned.noise.x / expected - 1.0).abs() < 1e-14);
    assert_eq!((turned.strain.x, turned.resolution.x), (-found.strain.x, found.resolution.x));
}

#[test]
fn numbers_at_the_edge_of_what_can_be() {
    let made = |bridge| BridgeFrontEnd::<f64, 1, 1>::new([bridge], Excitation::Reference).is_ok();
    let good = bridge(BridgeCircuit::full(), 10e-3);
    for (tolerance, fits) in [(0.0, true), (0.999, true), (1.0, false), (-1e-9, false), (f64::NAN, false)] {
        assert_eq!(made(good.gauge_factor_within(tolerance)), fits, "{tolerance}");
        let scale = CountScale { tolerance, ..good.scale };
        assert_eq!(made(BridgeChannel { scale, ..good }), fits, "{tolerance}");
    }
    for (counts, fits) in
        [(1.0, false), (1.5, true), (-8.0, false), (f64::INFINITY, false), (f64::NAN, false)]
    {
        let scale = CountScale { full_scale_counts: counts, ..good.scale };
        assert_eq!(made(BridgeChannel { scale, ..good }), fits, "{counts}");
    }
    for (noise, fits) in [(0.0, true), (5.0, true), (-1e-9, false), (f64::INFINITY, false), (f64::NAN, false)]
    {
        assert_eq!(made(good.noise(noise)), fits, "{noise}");
    }
    let measured = |volts_per_count| {
        BridgeFrontEnd::<f64, 1, 2>::new([good], Excitation::Measured { channel: 1, volts_per_count })
    };
    for bad in [0.0, f64::NAN, f64::INFINITY, 1e-320] {
        assert!(measured(bad).is_err());
    }
    // A thousand counts of excitation are one, fewer are noise.
    let front_end = measured(1e-3).unwrap();
    for (excitation, fits) in [(1000.0, true), (-1000.0, true), (999.0, false), (0.0, false)] {
        assert_eq!(front_end.strain(&Vector2::new(5.0, excitation)).is_ok(), fits, "{excitation}");
    }
    // The last count but one is within the range.
    for (count, fits) in
        [(8_388_606.0, true), (-8_388_606.0, true), (8_388_607.0, false), (-8_388_607.0, false)]
    {
        let front_end = BridgeFrontEnd::<f64, 1, 1>::new([good], Excitation::Reference).unwrap();
        assert_eq!(front_end.strain(&Vector1::new(count)).is_ok(), fits, "{count}");
        assert_eq!(strains(good, count).first_saturated(), (!fits).then_some(0), "{count}");
    }
}
