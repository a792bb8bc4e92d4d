//! The laws of every slip detector, on both scalars.

use std::fs;
use std::path::Path;

use fingertip_friction::testing::{SlipTrial, detector_laws};
use fingertip_friction::{
    AdaptiveDropDetector, DropDetector, ForceNoise, LikelihoodRatioDetector, NormalForceGate, RatioThreshold,
    SlipDetector, StickSlipDetector,
};
use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;

fn pull<T: Real>(normal: f64, sideways: f64) -> ContactForce<T> {
    let direction = Vector3::new(0.6, 0.8, 0.0).map(|x| T::literal(x * sideways));
    ContactForce::new(T::literal(normal), direction, T::literal(1e-3))
}

/// A cup that is held and then slips, at 1 kHz.
pub(crate) fn trial<T: Real>() -> SlipTrial<T> {
    SlipTrial {
        hold: pull(4.0, 1.0),
        peak: pull(4.0, 3.0),
        sliding: pull(4.0, 2.0),
        noise: T::literal(0.01),
        time_step: T::literal(1e-3),
        learning: 100,
    }
}

fn laws_of_all<T: Real>() {
    let noise = ForceNoise::isotropic(T::literal(0.01)).unwrap();
    let drops = DropDetector::new(noise).unwrap();
    let ratio = LikelihoodRatioDetector::<T, 16>::new(noise, 1.0, 1000.0).unwrap();
    let learnt = AdaptiveDropDetector::new(noise, 1.0, 1000.0).unwrap();
    let gate = NormalForceGate::from_noise(&noise);
    let threshold =
        RatioThreshold::new(gate, T::literal(0.6)).unwrap().with_warning_share(T::literal(0.8)).unwrap();
    let quick = T::literal(1e-4);
    for trial in [trial(), SlipTrial { time_step: quick, ..trial() }] {
        detector_laws(|| drops, &trial);
        detector_laws(|| StickSlipDetector::new(drops), &trial);
        detector_laws(|| ratio, &trial);
        detector_laws(|| threshold, &trial);
    }
    detector_laws(|| learnt, &SlipTrial { learning: 2000, ..trial() });
    // One that is chosen at run time.
    detector_laws(|| Box::new(drops) as Box<dyn SlipDetector<T>>, &trial());
}

#[test]
fn laws_hold() {
    laws_of_all::<f64>();
    laws_of_all::<f32>();
}

#[test]
fn no_detector_is_left_out() {
    let tried = [
        "AdaptiveDropDetector",
        "DropDetector",
        "LikelihoodRatioDetector",
        "RatioThreshold",
        "StickSlipDetector",
    ];
    assert_eq!(implementers("SlipDetector"), tried);
}

/// The types of the crate's source that implement a trait, in order; references and boxes stand for what is in them.
pub(crate) fn implementers(name: &str) -> Vec<String> {
    fn walk(folder: &Path, wanted: &str, found: &mut Vec<String>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, wanted, found);
                continue;
            }
            let text = fs::read_to_string(path).unwrap();
            for line in text.lines().filter(|line| line.trim_start().starts_with("impl<T: Real")) {
                if let Some((_, rest)) = line.split_once(wanted) {
                    found.push(rest.split(['<', ' ']).next().unwrap().to_owned());
                }
            }
        }
    }
    let mut found = Vec::new();
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    walk(&source, &format!(" {name}<T> for "), &mut found);
    found.retain(|name| !name.starts_with('&') && name != "Box");
    found.sort();
    found
}
