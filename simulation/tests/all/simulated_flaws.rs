//! Each flaw of the simulated sensor alone, against what it is said to be.
//!
//! Random ones are judged over many seeds, within five standard deviations of what their number allows.

use fingertip_simulation::{
    Imperfections, Options, Script, SimulatedFingertip, SimulatedSample, SurfacePoint, ThermalDrift,
};
use fingertip_wrench::gauge_layout::{Gauge, GaugeLayout};
use nalgebra::Matrix6;

/// No flaws, no noise, no warming, 24 bits.
fn flawless(seed: u64) -> Options {
    let mut options = Options {
        seed,
        imperfections: Imperfections::none(),
        thermal_drift: ThermalDrift::none(),
        ..Options::default()
    };
    options.electronics.input_noise = 0.0;
    options.electronics.bits = 24;
    options
}

fn made(options: Options, script: &Script) -> SimulatedFingertip {
    SimulatedFingertip::new(script, options).unwrap()
}

fn resting(options: Options, duration: f64) -> Vec<SimulatedSample> {
    made(options, &Script::default().rest(duration)).collect()
}

/// Whether numbers are normal with a mean and a standard deviation, as far as so many can tell.
fn are_normal(numbers: &[f64], mean: f64, deviation: f64) {
    let count = numbers.len() as f64;
    let found_mean = numbers.iter().sum::<f64>() / count;
    assert!((found_mean - mean).abs() <= 5.0 * deviation / count.sqrt(), "mean {found_mean}, not {mean}");
    let square = numbers.iter().map(|number| (number - mean).powi(2)).sum::<f64>() / count;
    // The variance of so many numbers has the relative standard deviation √(2/n).
    let off = square / deviation.powi(2) - 1.0;
    assert!(off.abs() <= 5.0 * (2.0 / count).sqrt(), "deviation {}, not {deviation}", square.sqrt());
}

/// A changed option, over seeds: what `look` says of each sensor.
fn over_seeds(
    seeds: u64,
    change: impl Fn(&mut Options),
    look: impl Fn(&SimulatedFingertip) -> Vec<f64>,
) -> Vec<f64> {
    (0..seeds)
        .flat_map(|seed| {
            let mut options = flawless(seed);
            change(&mut options);
            look(&made(options, &Script::default().rest(0.1)))
        })
        .collect()
}

fn normalised(fingertip: &SimulatedFingertip) -> [Matrix6<f64>; 3] {
    [fingertip.nominal_matrix(), fingertip.true_matrix(), fingertip.calibrated_matrix()]
        .map(|matrix| *matrix.normalised())
}

#[test]
fn gains_scale_rows_and_what_is_read() {
    let ratios = over_seeds(
        300,
        |options| options.imperfections.gain = 0.01,
        |fingertip| {
            let [drawn, built, calibrated] = normalised(fingertip);
            assert_eq!(built, calibrated);
            let ratio = |row: usize| built.row(row).dot(&drawn.row(row)) / drawn.row(row).norm_squared();
            (0..6)
                .map(|row| {
                    assert!((built.row(row) - drawn.row(row) * ratio(row)).norm() < 1e-12);
                    ratio(row)
                })
                .collect()
        },
    );
    are_normal(&ratios, 1.0, 0.01);
    // What is read is what the matrix says, but for the bridge that falls short by the strain.
    let mut options = flawless(3);
    options.imperfections.gain = 0.2;
    let script = Script::default().press(SurfacePoint::degrees(50.0, 20.0), 10.0, 0.1).hold(0.01);
    let fingertip = made(options, &script);
    let (matrix, nominal) =
        (*fingertip.true_matrix().normalised(), fingertip.options().design.nominal_loads());
    for sample in fingertip {
        let expected = matrix * sample.truth.wrench.components().component_div(&nominal);
        for channel in 0..6 {
            let volts = sample.raw[channel] - 2.5;
            assert!((volts - expected[channel]).abs() <= 5e-4 * expected[channel].abs() + 5.0 / 16_777_216.0);
        }
    }
}

#[test]
fn gauges_are_glued_off_their_places() {
    type Place = fn(&mut Gauge<f64>) -> &mut f64;
    type Flaw = fn(&mut Imperfections) -> &mut f64;
    let places: [(Place, Flaw, f64); 3] = [
        (|gauge| &mut gauge.z, |flaws| &mut flaws.axial_placement, 1e-5),
        (|gauge| &mut gauge.theta, |flaws| &mut flaws.circumferential_placement, 1e-3),
        (|gauge| &mut gauge.q, |flaws| &mut flaws.angle, 1e-3),
    ];
    for (place, flaw, deviation) in places {
        let errors = over_seeds(
            200,
            |options| *flaw(&mut options.imperfections) = deviation,
            |fingertip| {
                let [drawn, built, _] = normalised(fingertip);
                // How the matrix changes by the place of each gauge, by a difference.
                let design = fingertip.options().design;
                let moved = |by: f64| {
                    let mut gauges = design.gauges;
                    gauges.iter_mut().for_each(|gauge| *place(gauge) += by);
                    let layout = GaugeLayout::new(&design.beam, gauges).unwrap();
                    let gain = fingertip.options().electronics.gain();
                    *layout.sensor_matrix(gain, design.nominal_loads()).unwrap().normalised()
                };
                let slope = (moved(deviation) - moved(-deviation)) / (2.0 * deviation);
                (0..6)
                    .map(|row| {
                        let slope = slope.row(row);
                        (built.row(row) - drawn.row(row)).dot(&slope) / slope.norm_squared()
                    })
                    .collect()
            },
        );
        are_normal(&errors, 0.0, deviation);
    }
}

#[test]
fn a_calibration_has_a_common_error_and_one_of_each_entry() {
    let scales = over_seeds(
        300,
        |options| {
            options.imperfections.calibration_scale = 0.02;
            options.imperfections.gain = 0.01;
        },
        |fingertip| {
            let [_, built, calibrated] = normalised(fingertip);
            let scale = calibrated.norm() / built.norm();
            assert!((calibrated - built * scale).norm() < 1e-12 * built.norm());
            vec![scale]
        },
    );
    assert!(scales.iter().all(|scale| ((scale - 1.0).abs() - 0.02).abs() < 1e-12));
    let above = scales.iter().filter(|scale| **scale > 1.0).count();
    // Half of 300, within five times the root of 75.
    assert!((107..=193).contains(&above), "{above}");
    let entries = over_seeds(
        100,
        |options| options.imperfections.calibration_entry = 0.001,
        |fingertip| {
            let [_, built, calibrated] = normalised(fingertip);
            let largest = |row: usize| built.row(row).iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
            let error = |row, column| (calibrated[(row, column)] - built[(row, column)]) / largest(row);
            (0..36).map(|at| error(at / 6, at % 6)).collect()
        },
    );
    are_normal(&entries, 0.0, 0.001);
}

/// What the seven channels give beyond the offset, at the amplifier's input \[V\].
fn inputs(sample: &SimulatedSample) -> impl Iterator<Item = f64> {
    sample.raw.into_iter().map(|volts| (volts - 2.5) / 2000.0).collect::<Vec<_>>().into_iter()
}

#[test]
fn bridges_are_unbalanced() {
    let unbalance = over_seeds(
        150,
        |options| options.imperfections.unbalance = 30e-6,
        |fingertip| inputs(&fingertip.clone().next().unwrap()).collect(),
    );
    are_normal(&unbalance, 0.0, 30e-6);
}

/// Warm by 10 K from the second sample on.
fn warm(options: &mut Options) {
    options.thermal_drift.warming = 10.0;
    options.thermal_drift.time_constant = 1e-5;
    options.electronics.dummy_averaging = 0.0;
}

#[test]
fn warmth_feigns_strain_and_moves_offsets() {
    let second = |fingertip: &SimulatedFingertip| {
        let sample = fingertip.clone().nth(1).unwrap();
        assert!((sample.truth.temperature - 10.0).abs() < 1e-12);
        inputs(&sample).map(|input| input / 10.0).collect::<Vec<_>>()
    };
    let strain = over_seeds(
        150,
        |options| {
            warm(options);
            options.thermal_drift.apparent_strain = -2e-6;
            options.thermal_drift.spread = 0.1;
            options.thermal_drift.offset_drift = 0.0;
        },
        second,
    );
    // A quarter bridge of 5 V and gauge factor 2 gives 2.5 V per unit of strain.
    are_normal(&strain, -2e-6 * 2.5, 0.2e-6 * 2.5);
    let offset = over_seeds(
        150,
        |options| {
            warm(options);
            options.thermal_drift.apparent_strain = 0.0;
            options.thermal_drift.offset_drift = 0.25e-6;
        },
        second,
    );
    are_normal(&offset, 0.0, 0.25e-6);
}

#[test]
fn the_temperature_rises_to_its_end_and_walks() {
    let mut options = flawless(1);
    options.thermal_drift =
        ThermalDrift { warming: 3.0, time_constant: 0.2, random_walk: 0.0, ..ThermalDrift::default() };
    for sample in resting(options, 1.0) {
        let expected = 3.0 * (1.0 - (-sample.time / 0.2).exp());
        assert!((sample.truth.temperature - expected).abs() < 1e-14);
    }
    options.thermal_drift.warming = 0.0;
    options.thermal_drift.random_walk = 0.5;
    options.sample_rate = 400.0;
    let ends: Vec<f64> = (0..300)
        .map(|seed| resting(Options { seed, ..options }, 0.25).last().unwrap().truth.temperature)
        .collect();
    // A hundred steps: half of 0.5 K/√s times the root of a quarter of a second.
    are_normal(&ends, 0.0, 0.25);
}

#[test]
fn noise_is_that_of_the_input_and_less_by_averaging() {
    for (conversions, deviation) in [(1, 1.06e-3), (16, 0.265e-3)] {
        let mut options = flawless(5);
        options.electronics.input_noise = 0.53e-6;
        options.electronics.conversions = conversions;
        let samples = resting(options, 1.0);
        let volts: Vec<f64> =
            samples.iter().flat_map(|sample| sample.raw.into_iter().take(6).copied()).collect();
        are_normal(&volts, 2.5, deviation);
    }
}

#[test]
fn the_dummy_gauge_is_averaged_from_its_first_sample_on() {
    let mut options = flawless(2);
    options.electronics.input_noise = 0.53e-6;
    options.thermal_drift = ThermalDrift { warming: 10.0, time_constant: 0.3, ..ThermalDrift::default() };
    options.electronics.dummy_averaging = 0.0;
    let plain: Vec<f64> = resting(options, 0.4).iter().map(|sample| sample.raw[6]).collect();
    options.electronics.dummy_averaging = 0.1;
    let averaged = resting(options, 0.4);
    let (mut sum, mut settled) = (0.0, 0.0);
    for (number, (plain, averaged)) in plain.iter().zip(&averaged).enumerate() {
        if number < 100 {
            // The plain mean of all so far.
            sum += plain;
            settled = sum / (number + 1) as f64;
        } else {
            settled = 0.99 * settled + 0.01 * plain;
        }
        assert!((averaged.raw[6] - settled).abs() < 1e-12, "{number}");
    }
    assert_eq!(averaged.len(), plain.len());
}

#[test]
fn the_converter_gives_whole_steps_between_its_ends() {
    let electronics = Options::default().electronics;
    // 12 bits over 5 V; 2000 times 2 steps is a five-hundredth of 2 steps at the input.
    let step = 5.0 / 4096.0;
    assert_eq!((electronics.step(), electronics.gain()), (step, 5000.0));
    let at_code = |code: f64| electronics.convert((code * step - 2.5) / 2000.0);
    for code in [0.0, 1.0, 2047.0, 2048.0, 4094.0, 4095.0] {
        assert_eq!(at_code(code), code * step);
        assert_eq!(electronics.is_saturated(code * step), code == 0.0 || code == 4095.0);
    }
    assert_eq!((at_code(7.49), at_code(7.51)), (7.0 * step, 8.0 * step));
    assert_eq!((at_code(-0.6), at_code(1e6), at_code(4095.6)), (0.0, 4095.0 * step, 4095.0 * step));
    // U·kε/(4 + 2kε) with k = 2 and U = 5 V.
    for strain in [4e-4_f64, -4e-4] {
        let expected = 10.0 * strain / (4.0 + 4.0 * strain);
        assert!((electronics.bridge(strain) - expected).abs() <= 4.0 * f64::EPSILON * expected.abs());
    }
}

#[test]
fn one_conversion_at_an_end_is_told() {
    for (offset, saturated) in [(0.0, true), (2.5, false), (5.0, true)] {
        let mut options = flawless(1);
        options.electronics.offset = offset;
        assert_eq!(resting(options, 0.01)[3].truth.saturated, saturated);
    }
    // With noise, one of sixteen is enough: four deviations from the end some samples have one.
    let mut options = flawless(1);
    options.electronics.input_noise = 1e-6;
    options.electronics.offset = 6e-3;
    let samples = resting(options, 2.0);
    let told = samples.iter().filter(|sample| sample.truth.saturated).count();
    // 7 × 16 conversions beyond three deviations of 2 mV: one in 741.
    let expected = 2000.0 * (1.0 - (1.0 - 1.35e-3_f64).powi(112));
    assert!((told as f64 - expected).abs() < 5.0 * expected.sqrt(), "{told}, not {expected}");
}
