//! Taring only at rest, and channels that lie, over simulated readings and recordings.

use crate::support::{generator, normal};
use fingertip_test_support::recording_text;
use fingertip_wrench::{
    ChannelLimits, Compensation, NotAtRest, Real, RestTest, Tare, TareAccumulator, TareError,
};
use nalgebra::{SVector, Vector6};

const RATE: f64 = 0.02;

/// How often a sensor that does `motion` besides noise is called restless.
fn alarms<T: Real>(
    seed: u128,
    runs: usize,
    samples: u32,
    step: f64,
    motion: impl Fn(u32, &mut Vector6<f64>),
) -> f64 {
    let mut random = generator(seed);
    let mut alarms = 0;
    for _ in 0..runs {
        let mut test = RestTest::<T, 6>::new(RATE)
            .and_then(|test| test.with_resolution(Vector6::repeat(T::literal(step))))
            .expect("valid");
        for i in 0..samples {
            let mut reading = Vector6::from_fn(|gauge, _| 0.3 - gauge as f64 + 1e-3 * normal(&mut random));
            motion(i, &mut reading);
            if step > 0.0 {
                reading = reading.map(|x| (x / step).round() * step);
            }
            test.add(&reading.map(T::literal));
        }
        alarms += usize::from(test.finish().is_err());
    }
    alarms as f64 / runs as f64
}

#[test]
fn a_resting_sensor_is_refused_as_seldom_as_stated() {
    for (samples, runs) in [(32, 20_000), (200, 5_000), (2_000, 500)] {
        let rate = alarms::<f64>(samples.into(), runs, samples, 0.0, |_, _| {});
        println!("{samples} readings: {rate} refused of {RATE} stated");
        let spread = (RATE / runs as f64).sqrt();
        assert!(rate < RATE + 4.0 * spread, "{rate}");
        assert!(rate > 0.4 * RATE - 4.0 * spread, "{rate}");
    }
    // Single precision, and converters with steps of a third, one and five standard deviations.
    for (seed, step) in [(1, 0.0), (2, 3e-4), (3, 1e-3), (4, 5e-3)] {
        let rate = alarms::<f32>(seed, 2_000, 300, step, |_, _| {});
        println!("f32, steps of {step}: {rate}");
        assert!(rate < 2.0 * RATE, "{rate}");
    }
}

/// The step that is found is the smallest change of each gauge, by the verdicts of one that is told it.
#[test]
fn the_resolution_is_found_in_the_readings() {
    let mut random = generator(20);
    let new = || RestTest::<f64, 6>::new(RATE).expect("valid");
    let (mut finding, mut compensated, mut plain) =
        (new().finding_resolution(), new().finding_resolution(), new());
    let (mut readings, mut steps) = (Vec::<Vector6<f64>>::new(), Vector6::repeat(f64::INFINITY));
    for i in 0..200 {
        // Gauge g in steps of g + 1 or more, gauge 5 without any change; gauge 2 drifts.
        let mut reading = Vector6::from_fn(|gauge, _| {
            let size = (gauge + 1) as f64;
            let noise = if gauge == 5 { 0.0 } else { normal(&mut random).round() };
            (noise + if gauge == 2 { (f64::from(i) / 10.0).round() } else { 0.0 }) * size
        });
        // In the end none changes, and then each but gauge 5 by three of its steps.
        if i >= 198 {
            let change = Vector6::new(3.0, 6.0, 9.0, 12.0, 15.0, 0.0);
            reading = readings[197] + if i == 198 { Vector6::zeros() } else { change };
        }
        if let Some(before) = readings.last() {
            let change: Vector6<f64> = (reading - before).abs();
            steps =
                steps.zip_map(&change, |least, change| if change > 0.0 { least.min(change) } else { least });
        }
        assert!(finding.add(&reading) && plain.add(&reading));
        // Of a reading with drift taken off, what came from the converter counts.
        assert!(compensated.add_compensated(&reading, &(reading * 1e-3)));
        readings.push(reading);
    }
    // What is not finite is no step.
    for test in [&mut finding, &mut compensated] {
        assert!(!test.clone().add(&Vector6::repeat(f64::INFINITY)));
    }
    assert_eq!(steps.fixed_rows::<5>(0), Vector6::new(1.0, 2.0, 3.0, 4.0, 5.0, 0.0).fixed_rows::<5>(0));
    steps[5] = 0.0;
    let told = |steps: &Vector6<f64>, size: f64| {
        let mut told = new().with_resolution(*steps).expect("valid");
        readings.iter().for_each(|reading| assert!(told.add(&(reading * size))));
        told.finish()
    };
    assert!(matches!(finding.finish(), Err(NotAtRest::Drifts { gauge: 2, .. })));
    assert_eq!(finding.finish(), told(&steps, 1.0));
    assert_ne!(finding.finish(), plain.finish());
    assert_eq!(compensated.finish(), told(&steps, 1e-3));
    // The mean is there, at rest or not.
    let mean = readings.iter().sum::<Vector6<f64>>() / 200.0;
    assert!((finding.tare().expect("readings").zero() - mean).amax() < 1e-12);
    assert!(new().tare().is_err());
}

#[test]
fn a_tremble_within_the_tolerance_is_forgiven() {
    let mut random = generator(19);
    let mut test = RestTest::<f64, 6>::new(RATE).expect("valid");
    for i in 0..1_000 {
        let tremble = 5e-4 * (f64::from(i) * 0.02).sin();
        test.add(&Vector6::from_fn(|_, _| tremble + 1e-3 * normal(&mut random)));
    }
    assert!(matches!(test.finish(), Err(NotAtRest::Unsteady { .. } | NotAtRest::Drifts { .. })));
    let rested = test.with_tolerance(Vector6::repeat(5e-4)).expect("valid").finish().expect("at rest");
    assert!(rested.tare_noise.iter().all(|noise| *noise > 1.5e-3 / 1_000.0_f64.sqrt()));
}

#[test]
fn motion_is_noticed() {
    let drift = |i: u32, reading: &mut Vector6<f64>| reading[2] += 1e-5 * f64::from(i);
    let knock = |i: u32, reading: &mut Vector6<f64>| reading[5] += if i == 150 { 8e-3 } else { 0.0 };
    let swing = |i: u32, reading: &mut Vector6<f64>| reading[0] += 1.5e-3 * (f64::from(i) * 0.2).sin();
    let jump = |i: u32, reading: &mut Vector6<f64>| reading[3] += if i > 150 { 1e-3 } else { 0.0 };
    assert!(alarms::<f64>(10, 200, 300, 0.0, drift) > 0.99);
    assert!(alarms::<f64>(11, 200, 300, 0.0, knock) > 0.99);
    assert!(alarms::<f64>(12, 200, 300, 0.0, swing) > 0.99);
    assert!(alarms::<f64>(13, 200, 300, 0.0, jump) > 0.99);
    assert!(alarms::<f32>(14, 200, 300, 1e-4, swing) > 0.99);
}

fn at_rest<T: Real>(samples: u32) -> RestTest<T, 6> {
    let mut random = generator(20);
    let mut test = RestTest::new(1e-4).expect("valid");
    for _ in 0..samples {
        test.add(&Vector6::from_fn(|gauge, _| T::literal(gauge as f64 + 1e-3 * normal(&mut random))));
    }
    test
}

#[test]
fn the_verdict_names_gauge_and_reason() {
    let rested = at_rest::<f64>(500).finish().expect("at rest");
    assert_eq!(rested.samples, 500);
    for gauge in 0..6 {
        assert!((rested.tare.zero()[gauge] - gauge as f64).abs() < 5.0 * rested.tare_noise[gauge]);
        assert!((rested.noise[gauge] / 1e-3 - 1.0).abs() < 0.15);
        let ratio = rested.tare_noise[gauge] * 500.0_f64.sqrt() / rested.noise[gauge];
        assert!((1.0..2.0).contains(&ratio), "{ratio}");
    }
    assert_eq!(at_rest::<f64>(31).finish(), Err(NotAtRest::TooFewSamples { samples: 31, needed: 32 }));
    let mut broken = at_rest::<f64>(100);
    assert!(!broken.add(&Vector6::new(0.0, f64::NAN, 0.0, 0.0, 0.0, 0.0)));
    assert_eq!(broken.finish(), Err(NotAtRest::NotFinite { rejected: 1 }));
    let mut knocked = at_rest::<f32>(100);
    knocked.add(&Vector6::new(0.0, 1.0, 2.0, 3.0, 4.5, 5.0));
    assert!(matches!(knocked.finish(), Err(NotAtRest::Outlier { gauge: 4, over_noise }) if over_noise > 9.0));
    // Twice the noise that is known.
    let known = at_rest::<f64>(500).with_known_noise(Vector6::new(1e-3, 1e-3, 1e-3, 5e-4, 1e-3, 1e-3));
    assert_eq!(known.expect("valid").finish(), Err(NotAtRest::Unsteady { gauge: 3 }));
    for bad in [0.0, 1.0, f64::NAN, -1.0] {
        assert_eq!(RestTest::<f64, 6>::new(bad), Err(NotAtRest::BadParameter));
    }
    let test = at_rest::<f64>(50);
    assert!(test.with_resolution(Vector6::repeat(-1.0)).is_err());
    assert!(test.with_known_noise(Vector6::repeat(0.0)).is_err());
    assert!(test.with_tolerance(Vector6::repeat(f64::NAN)).is_err());
    // No noise at all is no motion.
    let mut constant = RestTest::<f32, 6>::new(0.01).expect("valid");
    (0..100).for_each(|_| assert!(constant.add(&Vector6::repeat(0.125))));
    assert_eq!(constant.finish().expect("at rest").noise, Vector6::zeros());
}

/// Mean and variance against two passes in `f64`, far from zero, where naive sums cancel.
fn moments<T: Real>(offset: f64) {
    let mut random = generator(21);
    let readings: Vec<Vector6<T>> =
        (0..1_000).map(|_| Vector6::from_fn(|_, _| T::literal(offset + normal(&mut random)))).collect();
    let mut accumulator = TareAccumulator::<T, 6>::default();
    assert_eq!(accumulator.finish(), Err(TareError::TooFewSamples { samples: 0 }));
    readings.iter().for_each(|reading| assert!(accumulator.add(reading)));
    assert!(!accumulator.add(&Vector6::repeat(T::literal(f64::INFINITY))));
    assert_eq!(accumulator.samples(), 1_000);
    let (tare, noise) = (accumulator.finish().expect("enough"), accumulator.noise().expect("enough"));
    for gauge in 0..6 {
        let values = readings.iter().map(|reading| reading[gauge].to_f64());
        let mean = values.clone().sum::<f64>() / 1e3;
        let variance = values.map(|x| (x - mean) * (x - mean)).sum::<f64>() / 999.0;
        let resolution = offset.abs().max(1.0) * T::EPSILON.to_f64();
        assert!((tare.zero()[gauge].to_f64() - mean).abs() < 20.0 * resolution);
        assert!((noise[gauge].to_f64() / variance.sqrt() - 1.0).abs() < 50.0 * resolution);
        let raw = readings[7];
        assert_eq!(tare.compensate(&raw), raw - Tare::new(*tare.zero()).zero());
    }
}

#[test]
fn moments_do_not_cancel() {
    moments::<f64>(0.0);
    moments::<f64>(1e6);
    moments::<f32>(0.0);
    moments::<f32>(1e3);
}

/// Poses of an 8-channel optical sensor, 13 of 60 beyond its linear range of 50 to 950 counts, well
/// inside the 1024 of the converter.
#[test]
fn saturated_poses_of_a_real_sensor_are_found() {
    let Some(text) = recording_text("jonurce_fts8/poses.csv") else { return };
    let limits = ChannelLimits::new(50.0, 950.0).expect("valid");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let columns: Vec<usize> = (0..8)
        .map(|channel| {
            let candidates = [format!("s{channel}_mean"), format!("s{channel}")];
            names.iter().position(|name| candidates.iter().any(|c| c == name)).expect("channel")
        })
        .collect();
    let saturated = lines
        .filter(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
            let raw = SVector::<f64, 8>::from_fn(|channel, _| cells[columns[channel]]);
            raw.iter().any(|reading| limits.fault(*reading).is_some())
        })
        .count();
    assert_eq!(saturated, 13);
}

/// 14 s of a sensor on which nothing moves, at 1 kHz, 16 bits.
#[test]
fn a_real_sensor_at_rest_passes_and_its_noise_is_known() {
    let Some(text) = recording_text("ati_delta_raw_1khz/quiet_drives_off.csv") else { return };
    let readings: Vec<Vector6<f64>> = text
        .lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
            Vector6::from_fn(|gauge, _| cells[1 + gauge])
        })
        .collect();
    assert!(readings.len() > 14_000);
    // Published: standard deviations of the whole recording, in millivolts.
    let published = [0.436, 0.351, 0.425, 0.383, 0.416, 0.367];
    let mut accumulator = TareAccumulator::<f64, 6>::default();
    readings.iter().for_each(|reading| assert!(accumulator.add(reading)));
    let noise = accumulator.noise().expect("enough");
    for gauge in 0..6 {
        assert!((noise[gauge] * 1e3 - published[gauge]).abs() < 6e-4, "{}", noise[gauge]);
    }
    let (mut rested, mut refused) = (0, 0);
    for second in readings.chunks_exact(1_000) {
        let mut test = RestTest::new(0.01)
            .and_then(|test| test.with_resolution(Vector6::repeat(0.3218e-3)))
            .expect("valid");
        second.iter().for_each(|reading| assert!(test.add(reading)));
        match test.finish() {
            Ok(_) => rested += 1,
            Err(error) => {
                println!("{error}");
                refused += 1;
            }
        }
    }
    println!("seconds at rest {rested}, refused {refused}");
    assert!(rested >= 12);
    // The foil on it swings at 8 Hz, by half a step of the converter: seen, if nothing is forgiven.
    let mut strict = RestTest::<f64, 6>::new(0.01).expect("valid");
    readings.iter().take(1_000).for_each(|reading| assert!(strict.add(reading)));
    assert_eq!(strict.finish(), Err(NotAtRest::Unsteady { gauge: 0 }));
    // The same second while a drive heaves the sensor.
    let Some(text) = recording_text("ati_delta_raw_1khz/heave_1hz_after_recal.csv") else { return };
    let mut test = RestTest::<f64, 6>::new(0.01).expect("valid");
    for line in text.lines().skip(5_000).take(1_000) {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
        assert!(test.add(&Vector6::from_fn(|gauge, _| cells[3 + gauge])));
    }
    assert!(test.finish().is_err());
}
