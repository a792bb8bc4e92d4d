//! A recording of a reciprocating tribometer: 100 strokes with displacement.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::path::PathBuf;

use fingertip_friction::{
    ForceNoise, IncipientSlip, KineticFriction, NormalForceGate, SlipVerdict, StaticFriction,
};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;

/// The columns of a file of numbers; `None` where it is absent.
fn read(name: &str) -> Option<Vec<Vec<f64>>> {
    let folder = std::env::var_os("FINGERTIP_DATA")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data"), PathBuf::from);
    let path = folder.join("friction_tribometer").join(name);
    let Ok(text) = std::fs::read_to_string(&path) else {
        println!("skipped: no {}", path.display());
        return None;
    };
    Some(text.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect())
}

fn force(normal: f64, friction: f64) -> ContactForce<f64> {
    ContactForce { normal, tangential: Vector3::new(friction, 0.0, 0.0), spin: 0.0 }
}

/// The recording's own noise, rounded up.
fn noise() -> ForceNoise<f64> {
    ForceNoise { normal: 1e-3, tangential: 2e-4 }
}

#[test]
fn peaks_match_the_strokes() {
    let (Some(samples), Some(strokes)) = (read("reciprocating.csv"), read("strokes.csv")) else { return };
    let mut worst = 0.0_f64;
    let (mut within, mut total) = (0, 0);
    for stroke in &strokes {
        // A window over the whole stroke, since the peak comes up to half a second after onset.
        let mut friction = StaticFriction::<f64, 256>::new(noise(), 0.05, 0.01).unwrap();
        for row in samples.iter().filter(|row| row[0] >= stroke[0] && row[0] <= stroke[1]) {
            // The stroke starts with the friction of the last one: only force along it counts.
            if row[3] * stroke[2] < 0.0 {
                friction.observe(&force(row[1], row[3]));
            }
        }
        let found = friction.onset().unwrap().coefficient;
        let error = (found / stroke[3] - 1.0).abs();
        worst = worst.max(error);
        within += usize::from(error < 0.01);
        total += 1;
    }
    println!("peak within 1 % in {within} of {total} strokes, worst {:.3} %", worst * 100.0);
    assert_eq!(total, 100);
    assert_eq!(within, total);
}

#[test]
fn kinetic_friction_matches_the_sliding_part() {
    let (Some(samples), Some(strokes)) = (read("reciprocating.csv"), read("strokes.csv")) else { return };
    for direction in [1.0, -1.0] {
        let (mut sum, mut reference, mut count) = (0.0, 0.0, 0.0);
        for stroke in strokes.iter().filter(|stroke| stroke[2] == direction) {
            // The friction itself wanders along the stroke by far more than the sensor's noise.
            let roughness = ForceNoise { normal: 0.013, tangential: 0.1 };
            let mut friction = KineticFriction::new(roughness, 10.0).unwrap();
            // The last fifth of a second of the motion.
            let mut plain = (0.0, 0.0);
            for row in samples.iter().filter(|row| row[0] >= stroke[1] - 0.25 && row[0] <= stroke[1] - 0.05) {
                friction.observe(&force(row[1], row[3]), 5e-3);
                plain = (plain.0 + row[3].abs(), plain.1 + row[1]);
            }
            sum += friction.estimate().unwrap().coefficient;
            reference += plain.0 / plain.1;
            count += 1.0;
        }
        println!(
            "direction {direction}: kinetic {:.4}, mean force over mean load {:.4}",
            sum / count,
            reference / count
        );
        assert!((sum / reference - 1.0).abs() < 0.01);
    }
}

/// When the fingertip had slipped by 5 µm for good, were the stiffness of the stroke `share` of the
/// one in its row: how the labels are made, from the motion and the force of the recording itself.
fn slipped_for_good(samples: &[Vec<f64>], stroke: &[f64], share: f64) -> f64 {
    let direction = stroke[2];
    let (start, peak) = (stroke[0], stroke[4]);
    let within: Vec<_> = samples.iter().filter(|row| row[0] >= start && row[0] <= peak).collect();
    let first = within[0];
    let slip = |row: &[f64]| {
        let force = (row[3] - first[3]) * -direction;
        direction * (row[2] - first[2]) - force / (stroke[7] * share)
    };
    let last = within.iter().rposition(|row| slip(row) <= 5e-3).unwrap();
    within[(last + 1).min(within.len() - 1)][0]
}

/// The stiffness of a stroke scatters by 0.74 % and 0.91 % among the strokes of one direction, the
/// first left out; the lesser is taken for what is not known of it. It moves a label by up to 20 ms.
const STIFFNESS_DEVIATION: f64 = 0.0074;
/// The recording's sample time \[s\], by which each label and each onset may be late.
const SAMPLE: f64 = 5e-3;

/// 97 of the 100 onsets are within 50 ms of the published label. The other three:
/// - stroke 5's label marks where the apparent slip *falls* through 5 µm (the pad is at its
///   stiffest, 52 N/mm, there). It passes 5 µm for good 120 ms later, and there the onset is found.
/// - strokes 56 and 86: 54 ms late, less than one sample above 50 ms, while a stiffness lower by its
///   own standard deviation puts their labels 20 ms later.
#[test]
fn onsets_match_the_labels() {
    let (Some(samples), Some(strokes)) = (read("reciprocating.csv"), read("strokes.csv")) else { return };
    let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.05).unwrap());
    let mut detector = IncipientSlip::new(gate, 4e-6, 0.65).unwrap();
    let mut onsets = Vec::new();
    let mut last = SlipVerdict::Holding;
    let mut slips = 0;
    for row in &samples {
        let verdict = detector.update(&force(row[1], row[3]), &Vector3::new(row[2] * 1e-3, 0.0, 0.0));
        if verdict == SlipVerdict::Warning && last != SlipVerdict::Warning {
            onsets.push(row[0]);
        }
        slips += usize::from(verdict == SlipVerdict::Slipping && last == SlipVerdict::Warning);
        last = verdict;
    }
    let (mut errors, mut corrected, mut beyond) = (Vec::new(), Vec::new(), Vec::new());
    let mut outside = onsets.len();
    for (number, stroke) in strokes.iter().enumerate() {
        let within: Vec<_> = onsets.iter().filter(|t| **t >= stroke[0] && **t <= stroke[1]).collect();
        outside -= within.len();
        assert_eq!(within.len(), 1, "stroke {number}: {within:?}");
        let onset = *within[0];
        errors.push(onset - stroke[8]);
        if (onset - stroke[8]).abs() > 0.05 + 1e-9 {
            beyond.push(number);
        }
        // The label can be made again from the recording, but for one that is not an onset.
        let label = slipped_for_good(&samples, stroke, 1.0);
        let made_again = (label - stroke[8]).abs() <= SAMPLE + 1e-9;
        assert_eq!(made_again, number != 5, "stroke {number}: {label} {}", stroke[8]);
        let early = slipped_for_good(&samples, stroke, 1.0 + STIFFNESS_DEVIATION);
        let late = slipped_for_good(&samples, stroke, 1.0 - STIFFNESS_DEVIATION);
        assert!(early <= label && label <= late);
        corrected.push(onset - onset.clamp(early, late));
    }
    errors.sort_by(f64::total_cmp);
    corrected.sort_by(f64::total_cmp);
    let close = errors.len() - beyond.len();
    println!(
        "onsets found in {} strokes, {close} within 50 ms of the label, median {:.1} ms, from {:.1} to {:.1} ms, \
         beyond: strokes {beyond:?}; from where the label lies within one deviation of the stiffness: {:.1} to \
         {:.1} ms; {outside} alarms in the dwells; gross slip called in {slips}",
        errors.len(),
        errors[errors.len() / 2] * 1e3,
        errors[0] * 1e3,
        errors[errors.len() - 1] * 1e3,
        corrected[0] * 1e3,
        corrected[corrected.len() - 1] * 1e3,
    );
    assert_eq!(errors.len(), 100);
    assert_eq!(outside, 0);
    assert_eq!(slips, 100);
    assert!(close >= 97, "{close}");
    assert!(corrected.iter().all(|e| e.abs() <= 0.05 + 1e-9), "{corrected:?}");
}
