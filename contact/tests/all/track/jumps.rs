//! A jump is followed, and only a jump is taken for one.

use fingertip_contact::{Continuity, Tracker};
use fingertip_surfaces::Sphere;
use nalgebra::{Rotation3, Vector3};

use super::course::Course;

/// Jumps of at least eight deviations of a sample, at several forces: within three samples the track is new, and
/// where the contact is. The share that is, of so many jumps.
fn followed(jumps: u32, seed: u64) -> f64 {
    let ball = Sphere::new(Vector3::zeros(), 0.013).unwrap();
    let mut good = 0;
    for k in 0..jumps {
        let force = [0.2, 0.5, 1.0, 5.0][k as usize % 4];
        let mut course = Course::new(&ball, Vector3::z() * 1e-3, 0.01, 0.1, seed + u64::from(k));
        let mut tracker = Tracker::new(0.01, 0.1).unwrap();
        for _ in 0..100 {
            course.wait(1e-3);
            let sighting = course.sighting(force);
            tracker.follow(&ball, sighting.as_ref(), 1e-3);
        }
        // Of a sample: 40 µm·N, along each tangent.
        let deviation = 40e-6 / force;
        let angle = (8.0 + f64::from(k % 7) * 2.0) * deviation / 0.013;
        let across = Vector3::new(f64::from(k).cos(), f64::from(k).sin(), 0.0);
        course.jump(
            Rotation3::from_scaled_axis(across.cross(&course.normal).normalize() * angle) * course.point,
        );
        let mut new = false;
        for _ in 0..3 {
            course.wait(1e-3);
            let sighting = course.sighting(force);
            let tracked = tracker.follow(&ball, sighting.as_ref(), 1e-3).unwrap();
            new |= tracked.continuity == Continuity::New
                && (tracked.point - course.point).norm() < 5.0 * deviation;
        }
        good += u32::from(new);
    }
    f64::from(good) / f64::from(jumps)
}

#[test]
fn a_jump_is_followed_within_three_samples() {
    let share = followed(200, 7);
    assert!(share >= 0.99, "{share}");
}

#[test]
#[ignore = "ten thousand jumps take half a minute"]
fn a_jump_is_followed_within_three_samples_ten_thousand_times() {
    let share = followed(10_000, 1_000_000);
    println!("{share}");
    assert!(share >= 0.99, "{share}");
}

/// One sample elsewhere is waited out, and the track goes on as if it had not been.
#[test]
fn one_sample_gone_wrong_leaves_no_trace() {
    let ball = Sphere::new(Vector3::zeros(), 0.013).unwrap();
    let mut course = Course::new(&ball, Vector3::z() * 1e-3, 0.01, 0.1, 5);
    let mut tracker = Tracker::new(0.01, 0.1).unwrap();
    for sample in 0..100 {
        course.wait(1e-3);
        let mut sighting = course.sighting(1.0);
        if sample == 90 {
            let mut elsewhere = Course::new(&ball, Vector3::x() * 1e-3, 0.01, 0.1, 6);
            sighting = elsewhere.sighting(1.0);
        }
        let before = tracker;
        let tracked = tracker.follow(&ball, sighting.as_ref(), 1e-3).unwrap();
        let expected = match sample {
            0 => Continuity::New,
            90 => Continuity::Doubted,
            _ => Continuity::Followed,
        };
        assert_eq!(tracked.continuity, expected, "{sample}");
        if sample == 90 {
            // As if there had been no sample.
            let mut without = before;
            let bridged = without.follow(&ball, None, 1e-3).unwrap();
            assert_eq!((bridged.point, bridged.velocity), (tracked.point, tracked.velocity));
        }
    }
}

/// Without a contact the track is kept as long as it knows more than a sample, and not after a pause.
#[test]
fn gaps_are_bridged_as_long_as_that_helps() {
    let ball = Sphere::new(Vector3::zeros(), 0.013).unwrap();
    let mut course = Course::new(&ball, Vector3::z() * 1e-3, 0.01, 0.1, 5);
    let mut tracker = Tracker::new(0.01, 0.1).unwrap();
    let mut known = 0.0;
    for _ in 0..300 {
        course.wait(1e-3);
        let sighting = course.sighting(0.5).unwrap();
        known = sighting.covariance().trace();
        tracker.follow(&ball, Some(&sighting), 1e-3);
    }
    let mut bridged = 0;
    while let Some(tracked) = tracker.follow(&ball, None, 1e-3) {
        assert_eq!(tracked.continuity, Continuity::Bridged);
        assert!(tracked.position_covariance.trace() <= known);
        bridged += 1;
    }
    assert!((5..200).contains(&bridged), "{bridged}");
    let sighting = course.sighting(0.5);
    assert!(tracker.follow(&ball, sighting.as_ref(), 1e-3).unwrap().is_new());
    let sighting = course.sighting(0.5);
    assert!(!tracker.follow(&ball, sighting.as_ref(), 0.9).unwrap().is_new());
    let sighting = course.sighting(0.5);
    assert!(tracker.follow(&ball, sighting.as_ref(), 1.1).unwrap().is_new());
}

/// Two samples elsewhere make a jump only if no sample is between them: after one without contact the first is
/// forgotten, and the next is in doubt again.
#[test]
fn a_doubt_does_not_outlast_a_gap() {
    let ball = Sphere::new(Vector3::zeros(), 0.013).unwrap();
    let mut course = Course::new(&ball, Vector3::z() * 1e-3, 0.01, 0.1, 5);
    let mut tracker = Tracker::new(0.01, 0.1).unwrap();
    for _ in 0..100 {
        course.wait(1e-3);
        tracker.follow(&ball, course.sighting(1.0).as_ref(), 1e-3);
    }
    course.jump(Vector3::new(0.004, 0.0, 0.0126));
    let kinds = [true, false, true, true].map(|touches| {
        course.wait(1e-3);
        let sighting = course.sighting(1.0).filter(|_| touches);
        tracker.follow(&ball, sighting.as_ref(), 1e-3).unwrap().continuity
    });
    assert_eq!(kinds, [Continuity::Doubted, Continuity::Bridged, Continuity::Doubted, Continuity::New]);
}
