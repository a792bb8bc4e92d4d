//! What is kept of readings, and what is told of it, against the same taken from all readings at once.

use super::block::Cell;
use super::drift::Drift;
use super::noise::{Line, Noise};
use super::rest::{self, Quiet};
use super::trace::Trace;
use super::zero_steps::{self, StepKind};
use super::{Coupling, coupling};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

fn normal(random: &mut Pcg64Mcg) -> f64 {
    StandardNormal.sample(random)
}

/// Samples of two channels as a trace of at most so many blocks.
fn trace(readings: &[[f64; 2]], most: usize) -> Trace {
    let mut trace = Trace::new(2, vec![(0, 0), (0, 1), (1, 1)], most);
    for (i, reading) in readings.iter().enumerate() {
        trace.add(0.5 * i as f64, reading);
    }
    trace
}

fn white(seed: u64, count: usize) -> Vec<[f64; 2]> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    (0..count).map(|_| [10.0 + normal(&mut random), 5.0 - 2.0 * normal(&mut random)]).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn near(one: f64, other: f64) -> bool {
    (one - other).abs() <= 1e-9 * one.abs().max(other.abs()) + 1e-12
}

/// Blocks of 128 readings, which were joined three times: means, squares, extremes, the two largest changes, products and
/// Allan sums are those of the readings. Differences of means are taken within the block in which readings came, and from
/// then on within what is joined.
#[test]
fn blocks_are_what_their_readings_are() {
    let readings = white(1, 4096);
    let trace = trace(&readings, 64);
    assert_eq!((trace.length(), trace.octave(), trace.blocks.len()), (128, 7, 32));
    for (number, block) in trace.blocks.iter().enumerate() {
        let start = 128 * number;
        // How long blocks were when these readings came.
        let first = [16, 32, 64][(start / 1024).min(2)];
        assert_eq!((block.start, block.samples, block.time), (start as u64, 128, 0.5 * start as f64));
        let change = |i: usize, k: usize| {
            if i > 0 { readings[i][k] - readings[i - 1][k] } else { 0.0 }
        };
        for (place, (one, other)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
            let sum: f64 = (start..start + 128).map(|i| change(i, one) * change(i, other)).sum();
            assert!(near(block.products[place], sum));
        }
        for (channel, cell) in block.cells.iter().enumerate() {
            let own: Vec<f64> = readings[start..start + 128].iter().map(|r| r[channel]).collect();
            let squares: f64 = own.iter().map(|x| (x - mean(&own)).powi(2)).sum();
            assert!(cell.count == 128 && near(cell.mean, mean(&own)) && near(cell.squares, squares));
            assert!(near(cell.variance().unwrap(), squares / 127.0));
            assert_eq!(cell.least, own.iter().copied().fold(f64::MAX, f64::min));
            assert_eq!(cell.greatest, own.iter().copied().fold(f64::MIN, f64::max));
            let mut jumps: Vec<(f64, usize)> =
                (start.max(1)..start + 128).map(|i| (change(i, channel), i)).collect();
            jumps.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
            assert_eq!((cell.jump.size, cell.jump.at), (jumps[0].0, jumps[0].1 as u64));
            assert_eq!(cell.jump.second, jumps[1].0.abs());
            for octave in 0..7 {
                let length = 1 << octave;
                let means: Vec<f64> = own.chunks(length).map(mean).collect();
                // Within a first block, or in pairs.
                let apart = (first >> octave).max(2);
                let changes: Vec<f64> =
                    means.chunks(apart).flat_map(|m| m.windows(2).map(|w| (w[1] - w[0]).powi(2))).collect();
                let (sum, pairs) = cell.allan[octave];
                assert!(near(sum, changes.iter().sum()) && pairs as usize == changes.len(), "{octave}");
            }
            let single = cell.variance_of_changes().unwrap();
            assert!(near(single, 0.5 * cell.allan[0].0 / f64::from(cell.allan[0].1)));
        }
    }
}

/// Noise about the straight line through the blocks, and the Allan deviation above the length of a block.
#[test]
fn noise_is_that_of_its_readings_about_a_line() {
    let readings: Vec<[f64; 2]> =
        white(2, 4096).iter().enumerate().map(|(i, r)| [r[0] + 1e-3 * i as f64, r[1]]).collect();
    let trace = trace(&readings, 64);
    for channel in 0..2 {
        let own: Vec<f64> = readings.iter().map(|r| r[channel]).collect();
        let noise = Noise::of(&trace.blocks, channel, trace.octave()).unwrap();
        // By the means of blocks, whose numbers are 0 to 31.
        let means: Vec<f64> = own.chunks(128).map(mean).collect();
        let (with, alone): (f64, f64) = means.iter().enumerate().fold((0.0, 0.0), |(with, alone), (i, m)| {
            let off = i as f64 - 15.5;
            (with + off * m, alone + off * off)
        });
        let (slope, centre) = (with / alone, mean(&means));
        let at = |block: usize| centre + slope * (block as f64 - 15.5);
        let squares: f64 = own.iter().enumerate().map(|(i, x)| (x - at(i / 128)).powi(2)).sum();
        assert!(near(noise.deviation, (squares / 4094.0).sqrt()) && near(noise.mean, centre));
        assert_eq!(noise.independent, noise.allan[0].deviation);
        let cells = Cell::of_channel(&trace.blocks, channel);
        let line = Line::through(&cells).unwrap();
        let left: f64 = means.iter().enumerate().map(|(i, m)| (m - at(i)).powi(2)).sum();
        assert!(near(line.slope, slope) && near(line.squares, left));
        assert!(near(line.slope_error, (left / 30.0 / alone).sqrt()) && near(line.at(3.0), at(3)));
        for (octave, point) in noise.allan.iter().enumerate() {
            assert_eq!(point.readings, 1 << octave);
            if octave >= 7 {
                let means: Vec<f64> = own.chunks(1 << octave).map(mean).collect();
                let sum: f64 = means.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum();
                let pairs = means.len() - 1;
                assert!(near(point.deviation, (0.5 * sum / pairs as f64).sqrt()), "{octave}");
                assert_eq!(point.pairs as usize, pairs);
            }
        }
        // Three differences are the fewest: eight means of 512 readings, four of 1024.
        assert_eq!(noise.allan.len(), 11);
    }
}

/// Two blocks are no line; three are. What does not change has no noise.
#[test]
fn few_blocks_and_no_noise() {
    let still = trace(&[[1e6, 0.1]; 48], 64);
    assert_eq!(still.blocks.len(), 3);
    for (channel, level) in [1e6, 0.1].into_iter().enumerate() {
        assert!(Noise::of(&still.blocks[..2], channel, 4).is_none());
        let noise = Noise::of(&still.blocks, channel, 4).unwrap();
        assert_eq!((noise.deviation, noise.independent), (0.0, 0.0));
        assert!(near(noise.mean, level));
        assert!(Drift::of(&still.blocks[..2], channel, 1.0).is_none());
        assert!(!Drift::of(&still.blocks, channel, 1.0).unwrap().is_significant());
    }
    let quiet = Quiet::of(&still, 0, Some(0.25));
    assert!(!quiet.votes && quiet.step == 0.25 && quiet.variance == 0.0);
}

/// What falls off like an exponential from the first block to the last, by formula: how far it went, how far it goes.
#[test]
fn settling_is_that_of_its_exponential() {
    for (share, size) in [(0.1, 3.0), (0.25, -2.0), (0.8, 5.0)] {
        let blocks = 40_usize;
        // Constant within a block, so that its mean is the exponential where the block stands.
        let of = |block: usize| 7.0 + size * (-(block as f64) / (blocks - 1) as f64 / share).exp();
        let readings: Vec<[f64; 2]> = (0..16 * blocks).map(|i| [of(i / 16), 1e-9 * (i % 3) as f64]).collect();
        let drift = Drift::of(&trace(&readings, 2048).blocks, 0, 20.0).unwrap();
        assert!(near(drift.settles_in.unwrap(), share * 20.0), "{drift:?}");
        let left = (-1.0 / share).exp();
        assert!(
            (drift.moved + size * (1.0 - left)).abs() < 1e-9
                && (drift.to_go.unwrap() + size * left).abs() < 1e-9
        );
        assert!(drift.is_significant());
    }
    // Eleven blocks are too few for an exponential, and twelve are enough.
    for (blocks, settles) in [(11, false), (12, true)] {
        let of = |block: usize| (-(block as f64) / 2.0).exp();
        let readings: Vec<[f64; 2]> = (0..16 * blocks).map(|i| [of(i / 16), 0.0]).collect();
        let drift = Drift::of(&trace(&readings, 2048).blocks, 0, 1.0).unwrap();
        assert_eq!(drift.settles_in.is_some(), settles, "{blocks}");
    }
}

/// The stated error of a drift is that of repetition, and where nothing drifts its squares average to one.
#[test]
fn errors_of_a_drift_are_honest() {
    let (mut squares, mut count) = (0.0, 0.0);
    for seed in 0..200 {
        let readings: Vec<[f64; 2]> =
            white(100 + seed, 1600).iter().enumerate().map(|(i, r)| [r[0], r[1] - 1e-3 * i as f64]).collect();
        let blocks = trace(&readings, 2048).blocks;
        // From the first block to the last, by 99 times 16 readings.
        for (channel, moved) in [(0, 0.0), (1, -1.584)] {
            let drift = Drift::of(&blocks, channel, 1.0).unwrap();
            squares += ((drift.moved - moved) / drift.error).powi(2);
            count += 1.0;
        }
    }
    assert!((squares / count - 1.0_f64).abs() < 4.0 * (2.0_f64 / count).sqrt() + 0.02, "{}", squares / count);
}

/// Low quantiles of the variances of blocks tell the variance, as χ² spreads them.
#[test]
fn quantiles_of_variances_tell_the_variance() {
    let mut random = Pcg64Mcg::seed_from_u64(8);
    for (count, degrees) in [(16, 15.0), (64, 63.0)] {
        let mut estimate = || {
            let values: Vec<f64> = (0..count).map(|_| 3.0 * normal(&mut random)).collect();
            values.iter().map(|x| (x - mean(&values)).powi(2)).sum::<f64>() / degrees
        };
        let estimates: Vec<f64> = (0..6000).map(|_| estimate()).collect();
        for quantile in [(0.25, -0.674), (0.02, -2.054), (0.5, 0.0), (0.975, 1.96)] {
            let told = rest::variance_at(estimates.clone(), degrees, quantile).unwrap();
            assert!((told / 9.0 - 1.0).abs() < 0.04, "{degrees} {quantile:?}: {told}");
        }
    }
    assert_eq!(rest::variance_at(Vec::new(), 15.0, (0.25, -0.674)), None);
}

/// The quiet variance of white noise is its own, whether all of the recording rests or a twentieth of it; and never below
/// what steps make.
#[test]
fn quiet_is_the_noise_and_not_the_motion() {
    let mut random = Pcg64Mcg::seed_from_u64(9);
    for (resting, most) in [(1.0, 0.1), (0.5, 0.4), (0.06, 1.3)] {
        let readings: Vec<[f64; 2]> = (0..32_000)
            .map(|i| {
                let moves =
                    if i as f64 / 32_000.0 < resting { 0.0 } else { 30.0 * (0.3 * f64::from(i)).sin() };
                [moves + normal(&mut random), 0.0]
            })
            .collect();
        let trace = trace(&readings, 2048);
        let quiet = Quiet::of(&trace, 0, None);
        assert!(quiet.votes && quiet.step == 0.0);
        assert!((quiet.variance - 1.0).abs() < most, "{resting}: {}", quiet.variance);
        assert_eq!(Quiet::of(&trace, 0, Some(12.0)).variance, 12.0);
    }
    // A slow motion everywhere is much more than its changes tell: nine times their variance is left at most,
    // as the quartile of blocks tells it.
    let slow: Vec<[f64; 2]> =
        (0..32_000).map(|i| [30.0 * (0.2 * f64::from(i)).sin() + normal(&mut random), 0.0]).collect();
    let changes = 0.5 * mean(&slow.windows(2).map(|w| (w[1][0] - w[0][0]).powi(2)).collect::<Vec<_>>());
    let variance = Quiet::of(&trace(&slow, 2048), 0, None).variance;
    assert!(variance <= 13.0 * changes && variance > 5.0 * changes, "{variance} {changes}");
}

/// It rests where it does not move: between motions, after a slow one, and not for less than four blocks.
#[test]
fn rests_are_where_nothing_moves() {
    let mut random = Pcg64Mcg::seed_from_u64(10);
    let motion = |i: usize| match i {
        0..3200 => 0.0,
        // Up within a sample, and still.
        3200..6400 => 40.0,
        // A ramp of a deviation in 16 readings.
        6400..9600 => 40.0 + (i - 6400) as f64 / 16.0,
        9600..9648 => 240.0,
        9648..9664 => 240.0 + 50.0 * ((i % 2) as f64),
        _ => 240.0,
    };
    let readings: Vec<[f64; 2]> = (0..12_800).map(|i| [motion(i) + normal(&mut random), 3.0]).collect();
    let trace = trace(&readings, 2048);
    let quiet = [0, 1].map(|channel| Quiet::of(&trace, channel, None));
    let rests = rest::rests(&trace, &quiet);
    let found: Vec<(u64, u64)> = rests
        .iter()
        .filter(|rest| rest.len() > 8)
        .map(|rest| (rest.start as u64 * 16, rest.end as u64 * 16))
        .collect();
    assert!(rests.iter().all(|rest| rest.len() >= 4), "{rests:?}");
    assert!(found.len() >= 3, "{found:?}");
    assert_eq!((found[0], found[1].0), ((0, 3200), 3200));
    // The ramp is noticed within eight blocks, by the means of four.
    assert!((6400..=6528).contains(&found[1].1), "{found:?}");
    let last = found.last().unwrap();
    assert_eq!(*last, (9664, 12_800));
    let (samples, times) = rest::samples(&trace.blocks[604..800]).unwrap();
    assert_eq!((samples, times), (9664..12_800, 4832.0..6400.0));
    let (samples, times) = rest::samples(&trace.blocks[3..4]).unwrap();
    assert_eq!((samples, times), (48..64, 24.0..24.0));
    assert!(rest::samples(&[]).is_none());
}

/// Up by 0.6 of a deviation in each block: no more than noise from one mean to the next, but too much from four to the next
/// four. The rest ends with the block by which there are eight.
#[test]
fn a_slow_motion_ends_a_rest_as_soon_as_eight_blocks_tell_it() {
    let moving = |i: u32| 0.6 * f64::from(i / 16) + if i.is_multiple_of(2) { 1.0 } else { -1.0 };
    let readings: Vec<[f64; 2]> = (0..28 * 16).map(|i| [moving(i), 3.0]).collect();
    let quiet = [(1.0, true), (0.0, false)].map(|(variance, votes)| Quiet { variance, step: 0.0, votes });
    assert_eq!(rest::rests(&trace(&readings, 2048), &quiet), [0..7, 7..14, 14..21, 21..28]);
}

/// A tare may leave two hundredths of what it took away, beside noise; more is another load.
#[test]
fn a_tare_of_a_great_load_may_leave_a_little() {
    let mut random = Pcg64Mcg::seed_from_u64(15);
    for (left, kind) in [(23.0, StepKind::Tare), (40.0, StepKind::Several)] {
        let mut reading = |i: u32| 2.0 * normal(&mut random) + if i < 800 { 1000.0 } else { left };
        let readings: Vec<[f64; 2]> = (0..1600).map(|i| [reading(i), -reading(i)]).collect();
        let trace = trace(&readings, 2048);
        let quiet = [0, 1].map(|channel| Quiet::of(&trace, channel, None));
        let found = zero_steps::find(&trace, &quiet, &[0, 1]);
        assert!(matches!(found.as_slice(), [step] if step.kind == kind && step.sample == 800), "{found:?}");
    }
}

/// A step is told with its sample, time and size, of the channels that it moved and of the kind that it is.
#[test]
fn steps_of_the_zero_are_told_exactly() {
    let mut random = Pcg64Mcg::seed_from_u64(12);
    let base: Vec<[f64; 2]> =
        (0..1600).map(|_| [20.0 + normal(&mut random), 50.0 + normal(&mut random)]).collect();
    let step = |at: usize, by: [f64; 2]| {
        let mut readings = base.clone();
        readings[at..].iter_mut().for_each(|r| (r[0], r[1]) = (r[0] + by[0], r[1] + by[1]));
        let trace = trace(&readings, 2048);
        let quiet = [0, 1].map(|channel| Quiet::of(&trace, channel, None));
        zero_steps::find(&trace, &quiet, &[0, 1])
    };
    assert_eq!(step(800, [0.0, 0.0]), []);
    for at in [805, 800, 815] {
        for (by, kind) in [
            ([15.0, 0.0], StepKind::One),
            ([0.0, -15.0], StepKind::One),
            ([15.0, -20.0], StepKind::Several),
            // Behind it both read zero.
            ([-20.0, -50.0], StepKind::Tare),
            ([-20.0, 0.0], StepKind::One),
        ] {
            let found = step(at, by);
            assert_eq!(found.len(), 1, "{at} {by:?}: {found:?}");
            assert_eq!((found[0].sample, found[0].kind), (at as u64, kind), "{at} {by:?}");
            assert!((found[0].time - 0.5 * at as f64).abs() < 1e-9);
            for (channel, size) in &found[0].channels {
                assert!((size - by[*channel]).abs() < 1.5, "{found:?}");
            }
            assert_eq!(found[0].channels.len(), by.iter().filter(|by| **by != 0.0).count());
        }
    }
    // What comes back, or goes on moving, is no step of the zero; nor is one near an end.
    let mut readings = base.clone();
    readings[805..820].iter_mut().for_each(|r| r[0] += 20.0);
    readings[405..].iter_mut().enumerate().for_each(|(i, r)| r[1] += 20.0 + 0.4 * i as f64);
    let trace = trace(&readings, 2048);
    let quiet = [0, 1].map(|_| Quiet { variance: 1.0, step: 0.0, votes: true });
    assert_eq!(zero_steps::find(&trace, &quiet, &[0, 1]), []);
    assert_eq!((step(20, [30.0, 0.0]), step(1580, [30.0, 0.0])), (vec![], vec![]));
    // A step of five deviations may be noise.
    assert_eq!(step(805, [5.0, 0.0]), []);
    // Where noise hides in the steps of the converter, eight deviations of √(1/12) and three steps are none: 5.31.
    for (size, count) in [(5.3, 0), (5.32, 1), (-5.3, 0), (-5.32, 1)] {
        let readings: Vec<[f64; 2]> =
            (0..800).map(|i| [if i < 405 { 7.0 } else { 7.0 + size }, 0.0]).collect();
        let quiet = [0, 1].map(|_| Quiet { variance: 1.0 / 12.0, step: 1.0, votes: true });
        let found = zero_steps::find(&self::trace(&readings, 2048), &quiet, &[0, 1]);
        assert_eq!(found.len(), count, "{size}: {found:?}");
    }
}

/// A jump stands out from all that changes within three blocks to either side, or is no step.
#[test]
fn a_step_beside_a_spike_is_none() {
    for blocks in -4..=4_i32 {
        let spike = 808 + 16 * blocks;
        let reading = |i: i32| {
            let level = if i < 805 { 50.0 } else { 70.0 };
            level + if i == spike && blocks != 0 { 15.0 } else { 0.0 }
        };
        let readings: Vec<[f64; 2]> = (0..1600).map(|i| [reading(i), 0.0]).collect();
        let quiet = [true, false].map(|votes| Quiet { variance: 1.0, step: 0.0, votes });
        let found = zero_steps::find(&trace(&readings, 2048), &quiet, &[0, 1]);
        assert_eq!(found.len(), usize::from(blocks == 0 || blocks.abs() == 4), "{blocks}: {found:?}");
    }
}

/// Correlations of changes are those of all readings; weak ones, and those of few readings, are not told.
#[test]
fn couplings_are_correlations_of_changes() {
    let mut random = Pcg64Mcg::seed_from_u64(13);
    for (share, told) in [(0.3, true), (-0.6, true), (0.04, false)] {
        let readings: Vec<[f64; 2]> = (0..64_000)
            .map(|_| {
                let one = normal(&mut random);
                [one, 3.0 * (share * one + (1.0_f64 - share * share).sqrt() * normal(&mut random))]
            })
            .collect();
        let pairs = [(0, 0), (0, 1), (1, 1)];
        let changes = |k: usize| readings.windows(2).map(move |w| w[1][k] - w[0][k]).collect::<Vec<f64>>();
        let (one, other) = (changes(0), changes(1));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let expected = dot(&one, &other) / (dot(&one, &one) * dot(&other, &other)).sqrt();
        let found = coupling::of(&trace(&readings, 8192).blocks, &pairs);
        assert_eq!(found.len(), usize::from(told), "{found:?}");
        for Coupling { first, second, correlation } in found {
            assert_eq!((first, second), (0, 1));
            assert!((correlation - expected).abs() < 1e-9 && (correlation - share).abs() < 0.03);
        }
        // In 320 readings seven standard errors are 0.48.
        let few = coupling::of(&trace(&readings[..320], 2048).blocks, &pairs);
        assert_eq!(few.len(), usize::from(share.abs() > 0.5), "{few:?}");
    }
    let mut still = trace(&[[1.0, 2.0]; 64], 64);
    assert!(coupling::of(&still.blocks, &[(0, 0), (0, 1), (1, 1)]).is_empty());
    // A gap is bridged by no product.
    still.interrupt();
    (0..32).for_each(|i| still.add(f64::from(i), &[100.0, 200.0]));
    assert!(still.blocks.iter().all(|block| block.products == [0.0; 3] && block.cells[0].jump.size == 0.0));
    // Readings that are missing leave the others; a change is taken between what is there.
    let mut random = Pcg64Mcg::seed_from_u64(14);
    let gappy: Vec<[f64; 2]> =
        (0..64).map(|i| [if i % 5 == 2 { f64::NAN } else { random.random_range(-1.0..1.0) }, 0.0]).collect();
    let kept = trace(&gappy, 64);
    let counted: u32 = kept.blocks.iter().map(|block| block.cells[0].count).sum();
    assert_eq!(counted, 51);
    assert!(kept.blocks.iter().all(|block| block.products[0].is_finite() && block.cells[1].count == 16));
}
