//! What a watch says as a whole, against the same told from all readings at once.

use fingertip_wrench::{ChannelFault, ChannelLimits};

use super::zero_steps::StepKind;
use super::{Depth, Health, HealthWatch, Kind, WatchedChannel};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

fn normal(random: &mut Pcg64Mcg) -> f64 {
    StandardNormal.sample(random)
}

fn gauges(names: &[&str]) -> Vec<WatchedChannel> {
    names.iter().map(|name| WatchedChannel::new(name, "V", Kind::Signal)).collect()
}

/// Two gauges with noise of 0.5 about 3 and −2, so many a second.
fn noise(seed: u64, count: usize) -> Vec<[f64; 2]> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    (0..count).map(|_| [3.0 + 0.5 * normal(&mut random), -2.0 + 0.5 * normal(&mut random)]).collect()
}

fn watched(readings: &[[f64; 2]], rate: f64, depth: Depth) -> Health {
    let mut watch = HealthWatch::new(gauges(&["a", "b"]), depth);
    for (i, reading) in readings.iter().enumerate() {
        watch.add(Some(10.0 + i as f64 / rate), reading);
    }
    assert_eq!(watch.samples(), readings.len() as u64);
    watch.finish()
}

#[test]
fn the_course_is_that_of_its_parts() {
    for (count, depth, part) in
        [(16 * 100, Depth::Full, 16), (16 * 1500, Depth::Full, 48), (16 * 1500, Depth::Brief, 128)]
    {
        let readings = noise(1, count);
        let health = watched(&readings, 100.0, depth);
        for (number, channel) in health.channels.iter().enumerate() {
            let own: Vec<f64> = readings.iter().map(|r| r[number]).collect();
            let extremes = |own: &[f64]| {
                [own.iter().copied().fold(f64::MAX, f64::min), own.iter().copied().fold(f64::MIN, f64::max)]
            };
            let kept = count / part * part;
            assert_eq!(channel.range, Some(extremes(&own[..kept])));
            assert_eq!(channel.course.len(), count / part, "{count} {depth:?}");
            for (place, (excursion, readings)) in channel.course.iter().zip(own.chunks(part)).enumerate() {
                let mean = readings.iter().sum::<f64>() / part as f64;
                assert!((excursion.mean - mean).abs() < 1e-12);
                assert_eq!([excursion.least, excursion.greatest], extremes(readings));
                // Between the times of its first and its last block.
                let time = 10.0 + (place * part) as f64 / 100.0;
                assert!(excursion.time >= time && excursion.time < time + part as f64 / 100.0);
            }
        }
        assert_eq!(health.rest_share, 1.0);
        let [from, to] = health.rest.unwrap();
        assert!(
            (from - 10.0).abs() < 1e-9 && (to - 10.0 - count as f64 / 100.0).abs() < part as f64 / 100.0,
            "{from} {to}"
        );
    }
}

/// White noise of deviation σ has the density σ√(2/rate) at every frequency up to half the rate, timed or not.
#[test]
fn white_noise_has_a_white_spectrum() {
    for rate in [50.0, 2000.0] {
        let readings = noise(2, 60_000);
        let timed = watched(&readings, rate, Depth::Full);
        let mut untimed = HealthWatch::new(gauges(&["a", "b"]), Depth::Full).with_rate(rate);
        readings.iter().for_each(|reading| untimed.add(None, reading));
        for health in [timed, untimed.finish()] {
            assert!((health.rate.rate.unwrap() / rate - 1.0).abs() < 1e-6);
            for channel in &health.channels {
                assert!(channel.spectrum_at_rest && channel.lines.is_empty());
                assert_eq!(channel.spectrum.len(), 512);
                for (i, (frequency, _)) in channel.spectrum.iter().enumerate() {
                    assert!((frequency / ((i + 1) as f64 * rate / 1024.0) - 1.0).abs() < 1e-6);
                }
                for part in channel.spectrum.chunks(128) {
                    let mean = part[..127].iter().map(|(_, density)| density * density).sum::<f64>() / 127.0;
                    assert!((mean / (0.25 * 2.0 / rate) - 1.0).abs() < 0.06, "{rate}: {mean}");
                }
            }
            assert!(health.findings.is_empty(), "{:?}", health.findings);
        }
        let brief = watched(&readings, rate, Depth::Brief);
        assert!(brief.channels.iter().all(|channel| channel.spectrum.is_empty() && channel.lines.is_empty()));
    }
    let mut none = HealthWatch::new(gauges(&["a", "b"]), Depth::Full).with_rate(f64::NAN);
    noise(2, 3000).iter().for_each(|reading| none.add(None, reading));
    let health = none.finish();
    assert!(health.rate.rate.is_none() && health.channels[0].spectrum.is_empty());
    // Without a rate a second is a sample.
    assert!((health.rest.unwrap()[1] - 2992.0).abs() < 1.0, "{:?}", health.rest);
}

/// What never moves has no line, however its number is rounded; a faint one beside it is seen.
#[test]
fn what_never_moves_has_no_lines() {
    for still in [0.2, -1e9, 1e-300, 1.0 / 3.0] {
        let faint = |i: usize| 1e-9 * (core::f64::consts::TAU * 50.0 * i as f64 / 1000.0).sin();
        let readings: Vec<[f64; 2]> = (0..1500).map(|i| [still, 2.0 + faint(i)]).collect();
        let health = watched(&readings, 1000.0, Depth::Full);
        let lines = |number: usize| &health.channels[number].lines;
        assert_eq!(lines(0), &[], "{still}");
        assert_eq!(lines(1).first().map(|line| line.name.as_str()), Some("mains, 50 Hz"), "{:?}", lines(1));
    }
}

#[test]
fn samples_that_hold_or_repeat_or_are_missing_are_counted() {
    let mut watch = HealthWatch::new(gauges(&["a", "b"]), Depth::Full);
    for (i, reading) in noise(3, 1000).iter().enumerate() {
        let time = i as f64 * 0.01;
        watch.add(Some(time), reading);
        match i {
            100 | 200 | 300 => watch.add(Some(time + 0.005), reading),
            400 | 500 => watch.add(Some(time), &[9.0, 9.0]),
            600 => watch.add(Some(time - 5.0), &[9.0, 9.0]),
            700 => watch.add(Some(time + 0.001), &[f64::NAN, reading[1]]),
            _ => {}
        }
    }
    let health = watch.finish();
    assert_eq!(health.rate.held, 3);
    assert_eq!(health.rate.not_advancing, 3);
    // What does not advance is left out.
    assert_eq!(health.samples, 1000 + 3 + 1);
    assert!(health.channels[0].range.unwrap()[1] < 8.0);
    assert_eq!((health.channels[0].not_finite, health.channels[1].not_finite), (1, 0));
}

/// Readings at the end of the range: each stretch with its first and last time, its readings and extremes; sixteen of them,
/// and all that are at fault counted.
#[test]
fn stretches_at_the_end_of_the_range_are_told_exactly() {
    let limits = ChannelLimits::new(-5.0, 5.0).unwrap();
    let channels = vec![
        WatchedChannel::new("a", "V", Kind::Signal).within(limits),
        WatchedChannel::new("b", "V", Kind::Signal),
    ];
    let mut watch = HealthWatch::new(channels, Depth::Brief);
    let mut expected = Vec::new();
    for (i, reading) in noise(4, 4000).iter().enumerate() {
        let (start, within) = (i / 200 * 200, i % 200);
        // Twenty stretches, of 3, 4, 5 and so on, up and down in turn.
        let length = 3 + start / 200;
        let high = start % 400 == 0;
        let own = if within < length {
            let size = 5.0 + 0.5 * (within % 2) as f64;
            if high { size } else { -size }
        } else {
            reading[0].clamp(-4.5, 4.5)
        };
        if within == 0 {
            expected.push((i, length, high));
        }
        watch.add(Some(i as f64 * 0.01), &[own, reading[1]]);
    }
    let health = watch.finish();
    let channel = &health.channels[0];
    assert_eq!(channel.stretches.len(), 16);
    assert_eq!(channel.at_fault, (3..23).sum::<u64>());
    assert!(health.channels[1].stretches.is_empty() && health.channels[1].at_fault == 0);
    for (stretch, (first, length, high)) in channel.stretches.iter().zip(expected) {
        let fault = if high { ChannelFault::SaturatedHigh } else { ChannelFault::SaturatedLow };
        assert_eq!((stretch.fault, stretch.readings), (fault, length as u64));
        assert!((stretch.from - first as f64 * 0.01).abs() < 1e-9, "{stretch:?} {first}");
        assert!((stretch.to - (first + length - 1) as f64 * 0.01).abs() < 1e-9, "{stretch:?}");
        assert_eq!([stretch.low, stretch.high], if high { [5.0, 5.5] } else { [-5.5, -5.0] });
    }
}

/// What sticks was stuck from its first reading on.
#[test]
fn a_stretch_that_sticks_begins_where_it_began() {
    let mut readings = noise(5, 4000);
    readings[2000..2300].iter_mut().for_each(|reading| reading[0] = 3.125);
    let health = watched(&readings, 100.0, Depth::Brief);
    let stretches = &health.channels[0].stretches;
    assert_eq!(stretches.len(), 1, "{stretches:?}");
    let stretch = stretches[0];
    assert_eq!(
        (stretch.fault, stretch.readings, stretch.low, stretch.high),
        (ChannelFault::Stuck, 300, 3.125, 3.125)
    );
    assert!((stretch.from - 30.0).abs() < 1e-6 && (stretch.to - 32.99).abs() < 1e-6, "{stretch:?}");
    assert_eq!(health.channels[0].at_fault, 300);
}

/// Where a channel that never moves says nothing, it says nothing of its mean either.
#[test]
fn readings_that_are_missing_have_no_mean() {
    let mut readings = noise(14, 1600);
    readings.iter_mut().for_each(|reading| reading[1] = 2.0);
    readings[320..384].iter_mut().for_each(|reading| reading[1] = f64::NAN);
    let health = watched(&readings, 100.0, Depth::Full);
    assert!(health.rest_share == 1.0 && health.channels[1].not_finite == 64, "{:?}", health.rest);
    let noise = health.channels[1].noise.as_ref().unwrap();
    assert_eq!((noise.mean, noise.deviation), (2.0, 0.0));
    let drift = health.channels[1].drift.as_ref();
    assert!(drift.is_none_or(|drift| drift.moved == 0.0), "{drift:?}");
}

/// Each sensor has steps of its own, told in the order of time; what is calculated from others has none, and a channel
/// beside it is alone: it is not one of several.
#[test]
fn steps_are_those_of_each_sensor() {
    let mut random = Pcg64Mcg::seed_from_u64(6);
    let mut channels = gauges(&["a", "b", "c", "d", "e"]);
    for (channel, sensor) in channels.iter_mut().zip(["left", "left", "right", "right", "right"]) {
        channel.sensor = sensor.to_owned();
    }
    channels.push(WatchedChannel::new("f", "N", Kind::Force).of_sensor("left").derived());
    channels.push(WatchedChannel::new("g", "N", Kind::Force).of_sensor("left"));
    let mut watch = HealthWatch::new(channels, Depth::Brief);
    for i in 0..3200 {
        let step = |at: usize| if i >= at { 20.0 } else { 0.0 };
        let mut readings = [step(2000), 50.0, step(1000), step(1000), 50.0, step(500), step(1500)];
        readings.iter_mut().for_each(|reading| *reading += 90.0 + normal(&mut random));
        watch.add(Some(i as f64 * 0.01), &readings);
    }
    let found: Vec<(u64, StepKind, Vec<usize>)> = watch
        .finish()
        .steps
        .iter()
        .map(|step| (step.sample, step.kind, step.channels.iter().map(|(number, _)| *number).collect()))
        .collect();
    let wanted = [
        (1000, StepKind::Several, vec![2, 3]),
        (1500, StepKind::Several, vec![6]),
        (2000, StepKind::One, vec![0]),
    ];
    assert_eq!(found, wanted);
}

/// Readings to both sides of a gap are not one stretch: what would stick if it were, does not.
#[test]
fn nothing_sticks_across_a_gap() {
    let sticks = |held: usize, gap: bool| {
        let mut readings = noise(7, 4000);
        readings[2000..2000 + held].iter_mut().for_each(|reading| reading[0] = 3.125);
        let mut watch = HealthWatch::new(gauges(&["a", "b"]), Depth::Brief);
        for (i, reading) in readings.iter().enumerate() {
            let late = if gap && i >= 2000 + held / 2 { 1.0 } else { 0.0 };
            watch.add(Some(i as f64 * 0.01 + late), reading);
        }
        watch.finish().channels[0].at_fault > 0
    };
    let fewest = (2..200).find(|held| sticks(*held, false)).unwrap();
    assert!(fewest > 2 && sticks(2 * fewest, false));
    assert!(!sticks(fewest, true) && !sticks(2 * fewest - 2, true), "{fewest}");
    assert!(sticks(2 * fewest + 2, true), "{fewest}");
}

/// A level that is another one behind a gap made no step; without the gap it did.
#[test]
fn nothing_jumps_across_a_gap() {
    for gap in [false, true] {
        let mut readings = noise(8, 3200);
        readings[1605..].iter_mut().for_each(|reading| reading[0] += 20.0);
        let mut watch = HealthWatch::new(gauges(&["a", "b"]), Depth::Brief);
        for (i, reading) in readings.iter().enumerate() {
            let late = if gap && i >= 1605 { 1.0 } else { 0.0 };
            watch.add(Some(i as f64 * 0.01 + late), reading);
        }
        assert_eq!(watch.finish().steps.len(), usize::from(!gap));
    }
}

/// Noise in common is looked for among the gauges of one sensor, not beyond, and not in a wrench, whose components share it.
#[test]
fn noise_in_common_is_that_of_one_sensor() {
    let couplings = |kind, sensors: [&str; 2]| {
        let channel = |sensor: &str| WatchedChannel::new("x", "V", kind).of_sensor(sensor);
        let mut watch = HealthWatch::new(sensors.map(channel).to_vec(), Depth::Full);
        noise(9, 8000)
            .iter()
            .for_each(|reading| watch.add(None, &[reading[0], reading[0] + 0.5 * reading[1]]));
        watch.finish().couplings.len()
    };
    assert_eq!(couplings(Kind::Signal, ["l", "l"]), 1);
    assert_eq!(couplings(Kind::Signal, ["l", "r"]), 0);
    assert_eq!(couplings(Kind::Force, ["l", "l"]), 0);
}
