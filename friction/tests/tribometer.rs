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
    let mut errors = Vec::new();
    let mut outside = onsets.len();
    for stroke in &strokes {
        let within: Vec<_> = onsets.iter().filter(|t| **t >= stroke[0] && **t <= stroke[1]).collect();
        outside -= within.len();
        assert!(within.len() <= 1, "{stroke:?} {within:?}");
        if let Some(onset) = within.first() {
            errors.push(**onset - stroke[8]);
        }
    }
    errors.sort_by(f64::total_cmp);
    let close = errors.iter().filter(|e| e.abs() <= 0.05 + 1e-9).count();
    println!(
        "onsets found in {} strokes, {close} within 50 ms of the label, median {:.1} ms, from {:.1} to {:.1} ms; \
         {outside} alarms in the dwells; gross slip called in {slips}",
        errors.len(),
        errors[errors.len() / 2] * 1e3,
        errors[0] * 1e3,
        errors[errors.len() - 1] * 1e3
    );
    assert_eq!(errors.len(), 100);
    assert_eq!(outside, 0);
    assert!(close >= 95, "{close}");
}
