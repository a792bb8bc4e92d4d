//! Spectra against a transform that is written out, and lines against the swings that made them.

use core::f64::consts::{PI, TAU};

use super::lines::{self, SpectralLine};
use super::spectrum::Spectra;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

const LENGTH: usize = Spectra::LENGTH;

fn normal(random: &mut Pcg64Mcg) -> f64 {
    StandardNormal.sample(random)
}

/// The periodogram of readings less their line, through von Hann's window, one frequency at a time.
fn periodogram(readings: &[f64]) -> Vec<f64> {
    let n = readings.len() as f64;
    let mean = readings.iter().sum::<f64>() / n;
    let off = |i: usize| i as f64 - (n - 1.0) / 2.0;
    let alone: f64 = (0..readings.len()).map(|i| off(i) * off(i)).sum();
    let slope = readings.iter().enumerate().map(|(i, x)| off(i) * x).sum::<f64>() / alone;
    let window = |i: usize| (PI * (i as f64 + 0.5) / n).sin().powi(2);
    let squares: f64 = (0..readings.len()).map(|i| window(i) * window(i)).sum();
    let left: Vec<f64> =
        readings.iter().enumerate().map(|(i, x)| (x - mean - slope * off(i)) * window(i)).collect();
    let power = |bin: usize| {
        let angle = |i: usize| TAU * (bin * i % readings.len()) as f64 / n;
        let real: f64 = left.iter().enumerate().map(|(i, x)| x * angle(i).cos()).sum();
        let imaginary: f64 = left.iter().enumerate().map(|(i, x)| x * angle(i).sin()).sum();
        2.0 * (real * real + imaginary * imaginary) / squares
    };
    (0..=readings.len() / 2).map(power).collect()
}

fn same(one: &[f64], other: &[f64]) {
    let most = other.iter().copied().fold(0.0, f64::max);
    assert_eq!(one.len(), other.len());
    assert!(one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-9 * most));
}

fn taken(readings: &[f64], from: u64) -> Spectra {
    let mut spectra = Spectra::new(2);
    readings.iter().zip(from..).for_each(|(x, at)| spectra.add(at, &[*x, -2.0 * x]));
    spectra
}

/// Three stretches that overlap by half; means over those in a span, or over all where fewer than two lie there.
#[test]
fn spectra_are_means_of_periodograms() {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let readings: Vec<f64> =
        (0..2 * LENGTH + 100).map(|i| normal(&mut random) + 0.05 * i as f64 + 9.0).collect();
    let spectra = taken(&readings, 5000);
    let each: Vec<Vec<f64>> =
        (0..3).map(|k| periodogram(&readings[k * LENGTH / 2..k * LENGTH / 2 + LENGTH])).collect();
    let mean = |which: &[usize]| -> Vec<f64> {
        (0..=LENGTH / 2)
            .map(|b| which.iter().map(|k| each[*k][b]).sum::<f64>() / which.len() as f64)
            .collect()
    };
    let end = |k: u64| 5000 + k * LENGTH as u64 / 2;
    for (from, to, which, is_of_span) in [
        (0, u64::MAX, vec![0, 1, 2], true),
        (5000, end(4), vec![0, 1, 2], true),
        (5000, end(3), vec![0, 1], true),
        (5001, end(4), vec![1, 2], true),
        (5001, end(4) - 1, vec![0, 1, 2], false),
        (5000, end(2), vec![0, 1, 2], false),
        (0, 0, vec![0, 1, 2], false),
    ] {
        let found = spectra.mean(0, from, to).unwrap();
        assert_eq!((found.stretches as usize, found.is_of_span), (which.len(), is_of_span), "{from} {to}");
        same(&found.powers, &mean(&which));
        let twice: Vec<f64> = found.powers.iter().map(|power| 4.0 * power).collect();
        same(&spectra.mean(1, from, to).unwrap().powers, &twice);
    }
    assert!(spectra.mean(2, 0, u64::MAX).is_none());
    assert!(taken(&readings[..LENGTH - 1], 0).mean(0, 0, u64::MAX).is_none());
    assert_eq!(taken(&readings[..LENGTH], 0).mean(0, 0, u64::MAX).unwrap().stretches, 1);
}

/// However many stretches are joined, each counts once.
#[test]
fn joined_stretches_count_once_each() {
    let mut random = Pcg64Mcg::seed_from_u64(2);
    let count = 150;
    // Louder and louder, so that a stretch that counted twice would show.
    let readings: Vec<f64> =
        (0..(count + 1) * LENGTH / 2).map(|i| normal(&mut random) * (i as f64 / 1000.0)).collect();
    let spectra = taken(&readings, 0);
    assert!(spectra.segments.len() <= 64);
    let stretches: u32 = spectra.segments.iter().map(|segment| segment.stretches).sum();
    assert_eq!(stretches as usize, count);
    let each: Vec<Vec<f64>> = (0..count)
        .map(|k| taken(&readings[k * LENGTH / 2..][..LENGTH], 0).segments[0].powers[0].clone())
        .collect();
    let mean: Vec<f64> =
        (0..=LENGTH / 2).map(|b| each.iter().map(|p| p[b]).sum::<f64>() / count as f64).collect();
    same(&spectra.mean(0, 0, u64::MAX).unwrap().powers, &mean);
    // Joined in pairs from the first on: all alike but the last.
    let (last, whole) = spectra.segments.split_last().unwrap();
    assert!(whole.iter().all(|segment| segment.stretches == 4) && last.stretches == 2);
    let mut at = 0;
    for segment in &spectra.segments {
        assert_eq!(segment.from, at);
        at += u64::from(segment.stretches) * LENGTH as u64 / 2;
        assert_eq!(segment.to, at + LENGTH as u64 / 2);
    }
}

fn found(stretches: usize, seed: u64, swing: impl Fn(f64) -> f64) -> Vec<SpectralLine> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let samples = (stretches + 1) * LENGTH / 2;
    let readings: Vec<f64> = (0..samples).map(|i| normal(&mut random) + swing(i as f64 / 2000.0)).collect();
    let mean = taken(&readings, 0).mean(0, 0, u64::MAX).unwrap();
    lines::find(&mean.powers, mean.stretches, 2000.0)
}

/// Swings of any frequency between the bins are told to a tenth of a bin, and their size to some hundredths.
#[test]
fn swings_are_told_with_frequency_and_size() {
    let mut random = Pcg64Mcg::seed_from_u64(3);
    for seed in 0..60 {
        let (frequency, size) = (random.random_range(15.0..985.0), random.random_range(0.5..3.0));
        let lines = found(30, seed, |t| size * (TAU * frequency * t + 1.0).sin());
        assert_eq!(lines.len(), 1, "{frequency}: {lines:?}");
        assert!((lines[0].frequency - frequency).abs() < 0.3, "{frequency}: {lines:?}");
        assert!((lines[0].rms / (size / 2_f64.sqrt()) - 1.0).abs() < 0.08, "{frequency} {size}: {lines:?}");
    }
    // Strongest first, twelve at most.
    let many =
        found(60, 99, |t| (1..=20).map(|k| f64::from(k) * (TAU * 47.3 * f64::from(k) * t).sin()).sum());
    assert_eq!(many.len(), 12);
    assert!(
        many.iter().zip((9..=20).rev()).all(|(line, k)| (line.frequency - 47.3 * f64::from(k)).abs() < 0.3)
    );
}

/// A line must stand out by six deviations, of one stretch or of many, over the median of what is around it: never once
/// among noise alone, and always where it is by twice as much.
#[test]
fn lines_stand_out() {
    for (stretches, size) in [(1, 0.6), (4, 0.35), (40, 0.15)] {
        let (mut alone, mut told) = (0, 0);
        for seed in 0..25 {
            alone += found(stretches, 500 + seed, |_| 0.0).len();
            let lines = found(stretches, 500 + seed, |t| size * 1.5 * (TAU * 300.3 * t).sin());
            told += usize::from(lines.len() == 1 && (lines[0].frequency - 300.3).abs() < 1.5);
        }
        assert_eq!((alone, told), (0, 25), "{stretches}");
    }
    // By powers that are made: the floor is the median beside the line, and the power what is above it.
    let mut powers = vec![2.0; LENGTH / 2 + 1];
    let stretches = 100;
    let spread = 0.55 * f64::from(stretches);
    let cube = |deviations: f64| (1.0 - 1.0 / (9.0 * spread) + deviations / (9.0 * spread).sqrt()).powi(3);
    let threshold = 2.0 * 1.4 * cube(6.0) / cube(0.0);
    for (power, count) in [(threshold * 0.999, 0), (threshold * 1.001, 1)] {
        powers[100] = power;
        let lines = lines::find(&powers, stretches, 1024.0);
        assert_eq!(lines.len(), count);
        for line in lines {
            assert!((line.frequency - 100.0).abs() < 1e-9);
            assert!((line.rms - ((power - 2.0) / 1024.0).sqrt()).abs() < 1e-12);
        }
    }
    // Of the bins beside, those above the floor count; the place is their mean.
    (powers[98], powers[99], powers[100], powers[101], powers[102]) = (2.0, 20.0, 102.0, 42.0, 1.0);
    let line = &lines::find(&powers, stretches, 1024.0)[0];
    assert!((line.frequency - (99.0 * 18.0 + 100.0 * 100.0 + 101.0 * 40.0) / 158.0).abs() < 1e-9, "{line:?}");
    assert!((line.rms - (158.0_f64 / 1024.0).sqrt()).abs() < 1e-12);
    // The first bins hold what is slow, the last have nothing beside them.
    for bin in [0, 1, 2, LENGTH / 2 - 1, LENGTH / 2] {
        let mut powers = vec![2.0; LENGTH / 2 + 1];
        powers[bin] = 1000.0;
        assert!(lines::find(&powers, stretches, 1024.0).is_empty(), "{bin}");
    }
    for bin in [3, LENGTH / 2 - 2] {
        let mut powers = vec![2.0; LENGTH / 2 + 1];
        powers[bin] = 1000.0;
        assert_eq!(lines::find(&powers, stretches, 1024.0).len(), 1, "{bin}");
    }
    // Half of the bins around may be high: the median is not moved by the rest.
    let mut powers = vec![2.0; LENGTH / 2 + 1];
    (181..=224).step_by(2).for_each(|bin| powers[bin] = 90.0);
    powers[200] = 100.0;
    assert!(lines::find(&powers, stretches, 1024.0).iter().any(|line| (line.frequency - 200.0).abs() < 1.0));
    assert!(lines::find(&[], 1, 1024.0).is_empty() && lines::find(&[1.0; 4], 1, 1024.0).is_empty());
}

/// A swing just between two bins is one line.
#[test]
fn between_two_bins_is_one_line() {
    let mut powers = vec![2.0; LENGTH / 2 + 1];
    (powers[99], powers[100], powers[101], powers[102]) = (30.0, 300.0, 300.0, 30.0);
    let lines = lines::find(&powers, 30, 1024.0);
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert!((lines[0].frequency - 100.5).abs() < 0.05);
}

/// Mains and their harmonics are named within their slack, folded or not, and the nearest of them.
#[test]
fn mains_are_named_where_they_are() {
    let name = |frequency: f64, rate: f64| {
        let mut powers = vec![1.0; LENGTH / 2 + 1];
        let place = frequency / rate * LENGTH as f64;
        let bin = place.floor();
        let share = place - bin;
        (powers[bin as usize], powers[bin as usize + 1]) = (1.0 + 1e6 * (1.0 - share), 1.0 + 1e6 * share);
        let lines = lines::find(&powers, 50, rate);
        assert_eq!(lines.len(), 1, "{frequency} {rate}: {lines:?}");
        assert!((lines[0].frequency - frequency).abs() < 1e-3 * frequency);
        lines[0].name.clone()
    };
    // At 2048 samples a second a bin is 2 Hz: the slack is 1.2 Hz and four thousandths.
    for (frequency, named) in [
        (50.0, "mains, 50 Hz"),
        (51.3, "mains, 50 Hz"),
        (51.5, ""),
        (48.7, "mains, 50 Hz"),
        (48.5, ""),
        (60.0, "mains, 60 Hz"),
        (120.4, "mains, harmonic 2 of 60 Hz"),
        (100.4, "mains, harmonic 2 of 50 Hz"),
        (451.0, "mains, harmonic 9 of 50 Hz"),
        (502.9, "mains, harmonic 10 of 50 Hz"),
        (503.6, ""),
        (600.0, "mains, harmonic 10 of 60 Hz"),
        (550.0, ""),
        (660.0, ""),
    ] {
        assert_eq!(name(frequency, 2048.0), named, "{frequency}");
    }
    // Folded at 256 samples a second: 256 − 150 and so on, up to the third harmonic.
    for (frequency, named) in [
        (106.0, "mains, harmonic 3 of 50 Hz, folded by the sample rate"),
        (76.0, "mains, harmonic 3 of 60 Hz, folded by the sample rate"),
        (100.0, "mains, harmonic 2 of 50 Hz"),
        (56.0, ""),
        (16.0, ""),
    ] {
        assert_eq!(name(frequency, 256.0), named, "{frequency}");
    }
    assert_eq!(name(30.0, 80.0), "mains, 50 Hz, folded by the sample rate");
    // Where the slack is a fiftieth of the rate, everything would be near to something.
    assert_eq!(name(2.0, 12.0), "mains, 50 Hz, folded by the sample rate");
    assert_eq!(name(0.5, 9.9), "");
}
