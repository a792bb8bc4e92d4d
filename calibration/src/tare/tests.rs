//! Tares of rests that are none, and of those that are.

use super::RestError;
use crate::Axis;
use crate::file::{CalibrationFile, FileError, SignalUnit, Temperature};
use crate::fit::testing::gaussian;
use nalgebra::DMatrix;
use rand::SeedableRng as _;

fn file() -> CalibrationFile {
    let matrix = DMatrix::from_diagonal_element(6, 6, 2.0);
    CalibrationFile::new(matrix, vec![10.0; 6], vec![0.5; 6], SignalUnit::Volt).unwrap()
}

#[test]
fn zero_and_noise_are_those_of_the_rest() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
    let signals = DMatrix::from_fn(2000, 6, |_, j| j as f64 + 0.01 * gaussian(&mut random));
    let tared = file().tared_by(&signals, false).unwrap();
    for j in 0..6 {
        assert!((tared.file.zero[j] - j as f64).abs() < 0.001);
        assert!((tared.file.noise.as_ref().unwrap()[j] - 0.01).abs() < 0.001);
        // A reading of 2 V is the nominal load of 10.
        assert!((tared.load_before[j] - 5.0 * (j as f64 - 0.5)).abs() < 0.01);
    }
    assert!(tared.warnings.is_empty());
}

fn random(seed: u64) -> rand_pcg::Pcg64Mcg {
    rand_pcg::Pcg64Mcg::seed_from_u64(seed)
}

/// Readings with a noise of 1 mV, of which gauge 3 moves; 1 mV of it are 0.05 % of the nominal load.
fn tared(samples: usize, seed: u64, moves: impl Fn(f64) -> f64) -> Result<super::Tared, RestError> {
    let mut random = random(seed);
    let signals = DMatrix::from_fn(samples, 6, |i, j| {
        let moved = if j == 2 { moves(i as f64 / samples as f64) } else { 0.0 };
        0.5 + moved + 1e-3 * gaussian(&mut random)
    });
    file().tared_by(&signals, false)
}

#[test]
fn what_moves_is_refused_and_what_wanders_a_little_is_said() {
    for seed in 0..100 {
        assert!(tared(500, seed, |_| 0.0).unwrap().warnings.is_empty(), "{seed}");
        assert!(tared(20, seed, |_| 0.0).unwrap().warnings.is_empty(), "{seed}");
    }
    // Of a nominal load of 10 at 2 V: ±20, a drift, and a knock.
    type Motion = fn(f64) -> f64;
    let motions: [(Motion, f64); 3] =
        [(|t| 4.0 * (30.0 * t).sin(), 40.0), (|t| 0.1 * t, 0.5), (|t| if t > 0.5 { -0.2 } else { 0.0 }, 1.0)];
    for samples in [24, 500, 20_000] {
        // A swing of a few readings cannot be told from noise.
        let skipped = usize::from(samples < 32);
        for (motion, wanted) in motions.into_iter().skip(skipped) {
            let error = tared(samples, 1, motion).unwrap_err();
            let RestError::NotAtRest { axis, range, seen } = &error else { panic!("{error}") };
            assert_eq!(*axis, Axis::Fz, "{error}");
            assert!((0.8..1.1).contains(&(range / wanted)) && seen.contains("gauge 3"), "{samples} {error}");
            assert!(error.to_string().starts_with("this is no rest: Fz ranged over "), "{error}");
        }
    }
    let little = tared(2000, 2, |t| 5e-3 * t).unwrap();
    assert!(little.warnings.len() == 1 && little.warnings[0].contains("gauge 3 moved by"), "{little:?}");
    assert!(little.warnings[0].contains("Fz by 2.") && (0.02..0.03).contains(&little.load_range[2]));
    // Asked for, any motion is taken.
    let moving = DMatrix::from_fn(500, 6, |i, j| if j == 2 { i as f64 } else { 0.0 });
    assert!(file().tared_by(&moving, false).is_err());
    assert_eq!(file().tared_by(&moving, true).unwrap().file.zero[2], 249.5);
    // Nor has a gauge moved whose readings flicker by a count in one half and stand still in the other.
    for flickers in [0..10, 10..20] {
        let count = |i: usize, j: usize| j == 2 && flickers.contains(&i) && i.is_multiple_of(3);
        let still = DMatrix::from_fn(20, 6, |i, j| if count(i, j) { 0.501 } else { 0.5 });
        assert_eq!(file().tared_by(&still, false).unwrap().warnings, [""; 0]);
    }
    // Readings that do not change at all are at rest.
    assert!(file().tared_by(&DMatrix::from_element(10, 6, 3.0), false).unwrap().warnings.is_empty());
}

#[test]
fn the_noise_of_the_load_is_that_of_the_gauges_through_the_calibration() {
    let rested = tared(5000, 3, |_| 0.0).unwrap();
    for noise in &rested.load_noise {
        assert!((noise / 5e-3 - 1.0).abs() < 0.05, "{noise}");
    }
    // Means of 313 readings.
    assert!(rested.load_range.iter().all(|range| *range < 6.0 * 5e-3 / 313_f64.sqrt()));
}

#[test]
fn what_was_tared_is_not_to_be_tared() {
    let mut untared = file();
    untared.quality.reasons = vec![super::UNTARED.to_owned(), "it is old".to_owned()];
    let tared = untared.tared_by(&DMatrix::from_element(10, 6, 3.0), false).unwrap();
    assert_eq!(tared.file.quality.reasons, ["it is old"]);
}

/// Two readings: their mean, half their difference times √2, and what changed.
#[test]
fn two_readings_are_enough() {
    let mut before = file();
    before.range = Some([-10.0, 10.0]);
    let signals = DMatrix::from_fn(2, 6, |i, j| j as f64 + 1e6 * f64::EPSILON * i as f64);
    let tared = before.tared_by(&signals, false).unwrap();
    assert_eq!(tared.samples, 2);
    for j in 0..6 {
        let mean = j as f64 + 0.5e6 * f64::EPSILON;
        assert_eq!((tared.file.zero[j], tared.moved[j]), (mean, mean - 0.5));
        let noise = tared.file.noise.as_ref().unwrap()[j];
        assert!((noise / (1e6 * f64::EPSILON * 0.5_f64.sqrt()) - 1.0).abs() < 1e-5);
    }
    // One reading within the range is enough for a zero, at its ends none is.
    let mut end = DMatrix::from_element(3, 6, 10.0);
    end[(1, 0)] = 9.9;
    assert!(matches!(before.tared_by(&end, false), Err(RestError::Saturated { gauge: 2 })));
    end.row_mut(1).fill(9.9);
    assert!(before.tared_by(&end, false).is_ok());
    let low = DMatrix::from_element(3, 6, -10.0);
    assert!(matches!(before.tared_by(&low, false), Err(RestError::Saturated { gauge: 1 })));
    let five = DMatrix::zeros(3, 5);
    let error = before.tared_by(&five, false).unwrap_err();
    assert!(
        matches!(error, RestError::Calibration(FileError::WrongGauges { found: 6, expected: 5 })),
        "{error}"
    );
}

#[test]
fn mistakes_are_named() {
    let text = "v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n1,2,3,4,5,6\n1,2,3,4,5,6\n";
    assert_eq!(file().tared(text.as_bytes(), None, false).unwrap().file.zero[4], 5.0);
    let counts = text.replace("_V", "_count");
    assert!(matches!(file().tared(counts.as_bytes(), None, false), Err(RestError::WrongUnit { .. })));
    assert!(matches!(file().tared("v1_V\n1\n2\n".as_bytes(), None, false), Err(RestError::Calibration(_))));
    assert!(matches!(file().tared("a\n1\n".as_bytes(), None, false), Err(RestError::Recording(_))));
    let mut ranged = file();
    ranged.range = Some([-5.0, 5.0]);
    assert!(matches!(ranged.tared(text.as_bytes(), None, false), Err(RestError::Saturated { gauge: 5 })));
    // A zero that drifts: 0.01 V/K.
    let mut drifting = file();
    drifting.temperature = Some(Temperature {
        reference_celsius: 20.0,
        range_celsius: [10.0, 30.0],
        zero_drift: vec![0.01; 6],
        zero_curvature: vec![0.0; 6],
        gain_drift: vec![0.1; 6],
    });
    let needs = |error| matches!(error, RestError::Calibration(FileError::NeedsTemperature { .. }));
    assert!(needs(drifting.tared(text.as_bytes(), None, false).unwrap_err()));
    assert!(needs(drifting.tared_by(&DMatrix::zeros(3, 6), false).unwrap_err()));
    for wrong in [f64::NAN, f64::INFINITY] {
        assert!(needs(drifting.tared(text.as_bytes(), Some(wrong), false).unwrap_err()), "{wrong}");
    }
    let warm =
        "v1_V,v2_V,v3_V,v4_V,v5_V,v6_V,temperature_C\n1,1,1,1,1,1,22\n1.05,1.05,1.05,1.05,1.05,1.05,27\n";
    assert!((drifting.tared(warm.as_bytes(), None, false).unwrap().file.zero[2] - 0.98).abs() < 1e-12);
    assert!((drifting.tared(text.as_bytes(), Some(25.0), false).unwrap().file.zero[4] - 4.95).abs() < 1e-12);
    let one = DMatrix::from_element(1, 6, 0.0);
    assert!(matches!(file().tared_by(&one, false), Err(RestError::TooFewSamples { samples: 1 })));
}
