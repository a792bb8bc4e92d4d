//! Stick-slip of known periods: saw teeth without noise, so that each drop is seen at the same phase.

use fingertip_friction::{DropDetector, ForceNoise, SlipDetector, SlipVerdict, StickSlip, StickSlipDetector};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;

fn new() -> StickSlipDetector<f64> {
    let noise = ForceNoise::isotropic(0.02).unwrap();
    StickSlipDetector::new(DropDetector::new(noise).unwrap())
}

/// Teeth of so many samples of a millisecond up, and down at the first of the next; how many drops were seen.
fn teeth(detector: &mut StickSlipDetector<f64>, lengths: &[u32]) -> u32 {
    let mut drops = 0;
    for &length in lengths {
        for index in 0..length {
            let load = 1.0 + 0.5 * f64::from(index) / f64::from(length);
            let force = ContactForce::new(4.0, Vector3::new(load, 0.0, 0.0), 0.0);
            drops += u32::from(detector.update(&force, 1e-3) == SlipVerdict::Slipping);
        }
    }
    drops
}

/// At the drop that ends the given periods.
fn after(lengths: &[u32]) -> Option<StickSlip<f64>> {
    let mut detector = new();
    // The first drop has no period before it.
    assert_eq!(teeth(&mut detector, &[40]), 0);
    let drops = teeth(&mut detector, lengths) + last(&mut detector);
    assert_eq!(drops, lengths.len() as u32 + 1);
    detector.motion()
}

fn last(detector: &mut StickSlipDetector<f64>) -> u32 {
    teeth(detector, &[1])
}

#[test]
fn period_and_spread_are_those_of_the_last_three() {
    let motion = after(&[80, 80, 80]).unwrap();
    assert!((motion.period - 0.08).abs() < 1e-12 && motion.spread < 1e-12, "{motion:?}");
    // Two periods are too few.
    assert_eq!(after(&[80, 80]), None);
    // The order does not matter: (90 − 80)/85.
    for lengths in [[80, 85, 90], [90, 85, 80], [85, 90, 80], [85, 80, 90], [80, 90, 85]] {
        let motion = after(&lengths).unwrap();
        assert!((motion.period - 0.085).abs() < 1e-12, "{lengths:?} {motion:?}");
        assert!((motion.spread - 10.0 / 85.0).abs() < 1e-10, "{lengths:?} {motion:?}");
    }
    // A spread of 19/99 is even, one of 20/99 is not.
    assert!(after(&[90, 99, 109]).is_some_and(|motion| motion.spread < 0.2));
    assert_eq!(after(&[90, 98, 110]), None);
    // What lies further back is forgotten.
    let motion = after(&[40, 200, 80, 80, 80]).unwrap();
    assert!((motion.period - 0.08).abs() < 1e-12 && motion.spread < 1e-12, "{motion:?}");
    assert_eq!(after(&[80, 80, 80, 40]), None);
}

fn hold(detector: &mut StickSlipDetector<f64>, step: f64) -> SlipVerdict {
    detector.update(&ContactForce::new(4.0, Vector3::new(1.0, 0.0, 0.0), 0.0), step)
}

/// A detector at the end of three periods of 80 ms.
fn moving() -> StickSlipDetector<f64> {
    let mut detector = new();
    teeth(&mut detector, &[40, 80, 80, 80, 1]);
    assert!(detector.motion().is_some());
    detector
}

#[test]
fn the_motion_ends_after_one_and_a_half_periods() {
    let mut detector = moving();
    for index in 1..=125 {
        hold(&mut detector, 1e-3);
        // Time that is none does not count.
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            hold(&mut detector, bad);
        }
        // Rounding decides at 120.
        assert!(index == 120 || detector.motion().is_some() == (index < 120), "{index}");
    }
}

#[test]
fn an_open_contact_ends_it_and_a_faulty_sample_does_not() {
    let mut detector = moving();
    let faulty = ContactForce::new(f64::NAN, Vector3::zeros(), 0.0);
    assert_eq!(detector.update(&faulty, 1e-3), SlipVerdict::NotPressing);
    assert_eq!(hold(&mut detector, f64::NAN), SlipVerdict::NotPressing);
    assert_eq!(detector.update_open(f64::NAN), SlipVerdict::NotPressing);
    assert!(detector.motion().is_some());
    let (mut open, mut unpressed, mut reset) = (detector, detector, detector);
    assert_eq!(open.update_open(1e-3), SlipVerdict::NotPressing);
    let none = ContactForce::new(0.1, Vector3::zeros(), 0.0);
    assert_eq!(unpressed.update(&none, 1e-3), SlipVerdict::NotPressing);
    reset.reset();
    for mut detector in [open, unpressed, reset] {
        assert_eq!(detector.motion(), None);
        // Three periods have to be seen again; the first is that since the contact closed.
        let drops = teeth(&mut detector, &[40, 80, 80, 1]);
        assert_eq!((drops, detector.motion()), (3, None));
        teeth(&mut detector, &[79, 1]);
        assert!(detector.motion().is_some_and(|motion| (motion.period - 0.08).abs() < 1e-12));
    }
}
