//! Channels that are saturated, clipped or stuck, reading by reading.

use fingertip_wrench::{BadLimits, ChannelFault, ChannelLimits, ChannelMonitor, Real};

use crate::support::{generator, normal};

const STUCK: Option<ChannelFault> = Some(ChannelFault::Stuck);
const HIGH: Option<ChannelFault> = Some(ChannelFault::PlateauHigh);
const LOW: Option<ChannelFault> = Some(ChannelFault::PlateauLow);

fn monitor<T: Real>() -> ChannelMonitor<T> {
    ChannelMonitor::new(ChannelLimits::none())
}

/// What is said of readings in whole steps, with a noise of so many steps, of a level that `level` changes.
fn said<T: Real>(noise: f64, readings: u32, level: impl Fn(u32, f64) -> f64) -> Vec<Option<ChannelFault>> {
    let mut random = generator(17);
    let mut monitor = monitor::<T>();
    (0..readings)
        .map(|i| {
            let reading = level(i, noise * normal(&mut random)).round();
            monitor.update(T::literal(reading * 0.125), true)
        })
        .collect()
}

/// The first reading that is faulty, and how many are.
fn faults(said: &[Option<ChannelFault>], of: Option<ChannelFault>) -> (usize, usize) {
    let first = said.iter().position(|fault| *fault == of).unwrap_or(usize::MAX);
    assert!(said.iter().all(|fault| fault.is_none() || *fault == of), "another fault than {of:?}");
    (first, said.iter().filter(|fault| **fault == of).count())
}

#[test]
fn plateaus_and_stuck_channels_are_told_apart() {
    fn check<T: Real>() {
        let wave = |i: u32| 400.0 * (f64::from(i) * 0.002).sin();
        // Half of a wave is beyond, less what it takes to be sure: 12 readings of a noise of four steps.
        let high = said::<T>(4.0, 20_000, |i, noise| (wave(i) + noise).min(0.0));
        let (first, count) = faults(&high, HIGH);
        assert!(first < 5000 && (8500..=10_000).contains(&count), "{first} {count}");
        let low = said::<T>(4.0, 20_000, |i, noise| (wave(i) + noise).max(0.0));
        assert!((8500..=10_000).contains(&faults(&low, LOW).1));
        // A wire breaks at a value that is none of the extremes.
        let stuck = said::<T>(4.0, 20_000, |i, noise| if i < 10_000 { wave(i) + noise } else { 37.0 });
        let (first, count) = faults(&stuck, STUCK);
        assert!((10_008..10_050).contains(&first) && count == 20_000 - first, "{first} {count}");
        // Between two neighbouring values is as bad.
        let between =
            said::<T>(
                4.0,
                20_000,
                |i, noise| if i < 10_000 { wave(i) + noise } else { 37.0 + f64::from(i % 7 % 2) },
            );
        assert!(faults(&between, STUCK).1 > 9900);
        // Behind the fault the channel is sound at once.
        let mended =
            said::<T>(4.0, 20_000, |i, noise| if (8000..9000).contains(&i) { 37.0 } else { wave(i) + noise });
        let (first, count) = faults(&mended, STUCK);
        assert!((8008..8050).contains(&first) && (950..1000).contains(&count), "{first} {count}");
    }
    check::<f64>();
    check::<f32>();
}

/// Sound channels of all kinds: fine and coarse steps, at rest, in motion, and resting between motions.
#[test]
fn a_sound_channel_is_not_accused() {
    for (noise, ramp) in
        [(0.0, 0.0), (0.05, 0.0), (0.3, 0.0), (0.5, 0.0), (0.7, 0.0), (1.5, 0.0), (40.0, 0.0)]
            .into_iter()
            .flat_map(|(noise, _)| [0.0, 0.01, 1.0, 20.0].map(|ramp| (noise, ramp)))
    {
        for rest in [0.0, 0.25, 0.5] {
            let level = |i: u32, noise: f64| {
                let phase = f64::from(i % 4000);
                let moved = if phase < 1000.0 { phase } else { 1000.0 };
                rest + ramp * moved + noise
            };
            let said = said::<f64>(noise, 60_000, level);
            assert!(said.iter().all(Option::is_none), "noise {noise}, ramp {ramp}, rest {rest}");
        }
    }
}

#[test]
fn what_nobody_witnesses_is_a_buffer_read_again() {
    for (witness, expected) in [(true, STUCK), (false, None)] {
        let mut random = generator(3);
        let mut monitor = monitor::<f64>();
        (0..2000).for_each(|_| assert_eq!(monitor.update(normal(&mut random), true), None));
        let mut last = None;
        (0..100).for_each(|_| last = monitor.update(0.5, witness));
        assert_eq!((last, monitor.held(), monitor.held_between()), (expected, 100, [0.5, 0.5]));
        // What is missing breaks it off.
        monitor.interrupt();
        assert_eq!((monitor.update(0.5, true), monitor.held()), (None, 1));
    }
}

#[test]
fn noise_and_step_are_learnt_beside_motion() {
    let mut random = generator(5);
    let mut monitor = monitor::<f64>();
    assert_eq!((monitor.noise(), monitor.step()), (None, None));
    for i in 0..20_000 {
        // A quarter of the time it moves, faster than its noise.
        let moved = if i % 4000 < 1000 { 3.0 * f64::from(i % 4000) } else { 0.0 };
        monitor.update((0.02 * normal(&mut random) / 0.01).round() * 0.01 + moved, true);
    }
    // With rounding: 2² + 1/12 steps. The lower quartile of blocks of 32 is a tenth below.
    let expected = 0.01 * (4.0_f64 + 1.0 / 12.0).sqrt();
    let noise = monitor.noise().expect("known");
    assert!((0.8..1.05).contains(&(noise / expected)), "{noise} for {expected}");
    assert!((monitor.step().expect("known") / 0.01 - 1.0).abs() < 1e-6);
}

#[test]
fn limits_are_kept_to_and_come_first() {
    let limits = ChannelLimits::new(-1.0, 8.0).expect("valid");
    let said = [-1.0, -0.9, 8.0, f64::NAN, f64::INFINITY].map(|reading| limits.fault(reading));
    let (low, high) = (Some(ChannelFault::SaturatedLow), Some(ChannelFault::SaturatedHigh));
    let broken = Some(ChannelFault::NotFinite);
    assert_eq!(said, [low, None, high, broken, broken]);
    let none = ChannelLimits::none();
    assert_eq!([f64::MAX, -f64::MAX, 0.0].map(|reading| none.fault(reading)), [None; 3]);
    let mut random = generator(7);
    let mut monitor = ChannelMonitor::new(limits);
    (0..2000).for_each(|_| assert_eq!(monitor.update(4.0 + 0.1 * normal(&mut random), true), None));
    (0..100).for_each(|_| assert_eq!(monitor.update(8.0, true), high));
    assert_eq!(monitor.update(f64::NAN, true), broken);
    assert_eq!(monitor.held(), 0);
    for (least, greatest) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (1.0, f64::NAN)] {
        assert_eq!(ChannelLimits::new(least, greatest), Err(BadLimits::Empty));
    }
}

#[test]
fn any_readings_are_taken() {
    let mut monitor = monitor::<f32>();
    for i in 0..10_000_u32 {
        // Bits in no order: subnormal, huge and broken ones among them.
        let bits = i.wrapping_mul(0x9E37_79B9).rotate_left(i % 32);
        monitor.update(f32::from_bits(bits), i.is_multiple_of(3));
    }
}

/// At a glance is as one by one, to the last bit, whatever comes: faults, gaps, NaN, and blocks that end anywhere.
#[test]
fn what_is_sound_at_a_glance_is_as_one_by_one() {
    fn check<T: Real>() {
        let mut random = generator(23);
        let mut glances = 0;
        for trial in 0..200_u32 {
            // From a noise of less than a step to one of thousands.
            let noise = 10.0_f64.powf(f64::from(trial % 50) * 0.1 - 1.0);
            let limits = if trial % 3 == 0 {
                ChannelLimits::new(T::literal(-0.25 * noise), T::literal(0.25 * noise)).unwrap()
            } else {
                ChannelLimits::none()
            };
            let (mut at_once, mut singly) =
                (ChannelMonitor::<T>::new(limits), ChannelMonitor::<T>::new(limits));
            for piece in 0..60_usize {
                let length = [1, 7, 32, 64][(trial as usize + piece) % 4];
                let readings: Vec<T> = (0..length)
                    .map(|_| {
                        let drawn = normal(&mut random);
                        let is_odd = drawn > 3.3;
                        T::literal(if is_odd { f64::NAN } else { (noise * drawn).round() * 0.125 })
                    })
                    .collect();
                let before = at_once;
                let sound = at_once.update_sound(&readings);
                let faults: Vec<_> = readings.iter().map(|reading| singly.update(*reading, true)).collect();
                if sound {
                    glances += readings.len();
                    assert!(faults.iter().all(Option::is_none), "{faults:?}");
                } else {
                    assert_eq!(at_once, before);
                    for reading in &readings {
                        let _ = at_once.update(*reading, true);
                    }
                }
                assert_eq!(at_once, singly);
                if piece % 17 == 16 {
                    at_once.interrupt();
                    singly.interrupt();
                }
            }
            assert!(at_once.update_sound(&[]));
            // A change without a size is looked at.
            assert!(!at_once.update_sound(&[T::GREATEST, -T::GREATEST]));
        }
        assert!(glances > 20_000, "{glances}");
    }
    check::<f64>();
    check::<f32>();
}
