//! How the detectors follow the friction ratio: by least squares at first, then with gains that go with
//! the time step, whatever the steps are.

use fingertip_friction::{DropDetector, ForceNoise, SlipDetector, SlipVerdict};
use fingertip_test_support::Worst;
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const PERIOD: f64 = 1e-3;
const ALPHA: f64 = 0.15;

/// Noise so great that nothing of what follows is evidence.
fn unmoved() -> DropDetector<f64> {
    DropDetector::new(ForceNoise { normal: 0.01, tangential: 1e3 }).unwrap()
}

fn feed(detector: &mut DropDetector<f64>, normal: f64, ratio: f64, step: f64) -> f64 {
    let force = ContactForce::new(normal, Vector3::new(0.0, normal * ratio, 0.0), 0.0);
    assert_eq!(detector.update(&force, step), SlipVerdict::Holding);
    detector.ratio().unwrap()
}

/// A tracker that has followed a line of 0.5 with a slope per second for a while.
fn settled(slope: f64) -> DropDetector<f64> {
    let mut detector = unmoved();
    for index in 0..200 {
        feed(&mut detector, 4.0, 0.5 + slope * PERIOD * f64::from(index - 199), PERIOD);
    }
    detector
}

/// The value at the last of evenly spaced points of the line of least squares through them.
fn end_of_fit(points: &[f64]) -> f64 {
    let count = points.len() as f64;
    let mean_x = 0.5 * (count - 1.0);
    let mean = points.iter().sum::<f64>() / count;
    let (mut product, mut square) = (0.0, 0.0);
    for (index, y) in points.iter().enumerate() {
        let x = index as f64 - mean_x;
        product += x * (y - mean);
        square += x * x;
    }
    mean + if square > 0.0 { product / square * mean_x } else { 0.0 }
}

#[test]
fn start_up_is_the_line_of_least_squares() {
    let mut rng = Pcg64Mcg::seed_from_u64(61);
    for _ in 0..20 {
        let mut detector = unmoved();
        let mut points = Vec::new();
        for _ in 0..25 {
            points.push(rng.random_range(0.2..0.8));
            let ratio = feed(&mut detector, rng.random_range(2.0..6.0), *points.last().unwrap(), PERIOD);
            let exact = end_of_fit(&points);
            assert!((ratio - exact).abs() < 1e-12, "{} points: {ratio} {exact}", points.len());
        }
    }
}

#[test]
fn samples_faster_than_two_kilohertz_are_averaged() {
    let mut rng = Pcg64Mcg::seed_from_u64(62);
    // So many samples reach 0.45 ms.
    for (step, count) in [(1e-4, 5), (0.2e-3, 3), (0.3e-3, 2), (0.46e-3, 1)] {
        let mut detector = unmoved();
        let first = feed(&mut detector, 4.0, 0.5, step);
        // The first sample counts only where it is a point like those that follow.
        let mut points = if count == 1 { vec![first] } else { Vec::new() };
        for _ in 0..24 {
            let (mut normal, mut tangential) = (0.0, 0.0);
            for index in 0..count {
                let (force, share): (f64, f64) = (rng.random_range(2.0..6.0), rng.random_range(0.2..0.8));
                normal += force;
                tangential += force * share;
                let before = detector.ratio().unwrap();
                let after = feed(&mut detector, force, share, step);
                assert!(index + 1 == count || after == before, "taken before its time");
            }
            points.push(tangential / normal);
            let (ratio, exact) = (detector.ratio().unwrap(), end_of_fit(&points));
            assert!((ratio - exact).abs() < 1e-12, "step {step}, {} means: {ratio} {exact}", points.len());
        }
    }
}

/// What a slow sensor sends twice counts once in a mean.
#[test]
fn repeated_samples_count_once_in_a_mean() {
    let mut detector = unmoved();
    feed(&mut detector, 4.0, 0.5, 1e-4);
    let mut ratio = 0.0;
    for share in [0.3, 0.3, 0.3, 0.3, 0.6] {
        ratio = feed(&mut detector, 4.0, share, 1e-4);
    }
    // The line starts from the first mean.
    assert!((ratio - 0.45).abs() < 1e-12, "{ratio}");
}

/// The documented gain for a step of `s` nominal times.
fn gain(s: f64) -> f64 {
    ALPHA * s / (1.0 - ALPHA + ALPHA * s)
}

/// One sample of another ratio after a step of `s` nominal times moves the ratio by the gain, and the slope
/// by `g²/(2−g)` over the step; the nominal time moves by a sixteenth of the difference.
#[test]
fn gains_go_with_the_time_step() {
    for s in [0.5, 0.8, 1.0, 1.1, 1.5, 2.0, 3.7, 8.0, 15.9] {
        let mut detector = settled(0.0);
        let moved = feed(&mut detector, 4.0, 0.6, s * PERIOD);
        let g = gain(s);
        assert!((moved - (0.5 + 0.1 * g)).abs() < 1e-12, "step {s}: {moved}");
        // The next sample tells the slope, and by its own gain the nominal time.
        let period = 1.0 + (s - 1.0) / 16.0;
        let slope = 0.1 * g * g / (2.0 - g) / s;
        for u in [1.0, 2.5, 5.0] {
            let mut next = detector;
            let length = u / period;
            let (length, g) =
                if (length - 1.0).abs() <= 1.0 / 64.0 { (1.0, ALPHA) } else { (length, gain(length)) };
            let found = feed(&mut next, 4.0, 0.6, u * PERIOD);
            let foretold = moved + slope * length;
            let wanted = foretold + g * (0.6 - foretold);
            assert!((found - wanted).abs() < 1e-12, "steps {s} and {u}: {found} {wanted}");
        }
    }
}

/// During start-up a long step weighs no less than it would later.
#[test]
fn long_steps_weigh_in_the_start_up_too() {
    for (count, s) in [(10_u32, 8.0), (20, 8.0), (20, 1.5), (3, 0.5)] {
        let mut detector = unmoved();
        for _ in 0..count {
            feed(&mut detector, 4.0, 0.5, PERIOD);
        }
        let n = f64::from(count);
        let fit = 2.0 * (2.0 * n + 1.0) / ((n + 1.0) * (n + 2.0));
        let wanted = 0.5 + 0.1 * gain(s).max(fit);
        let found = feed(&mut detector, 4.0, 0.6, s * PERIOD);
        assert!((found - wanted).abs() < 1e-12, "{count} samples, step {s}: {found} {wanted}");
        // Its slope is that of the fit, over the length of the step.
        let slope = 0.1 * 6.0 / ((n + 1.0) * (n + 2.0)) / s;
        let period = 1.0 + (s - 1.0) / 16.0;
        let foretold = found + slope;
        let m = n + 1.0;
        let fit = (2.0 * (2.0 * m + 1.0) / ((m + 1.0) * (m + 2.0))).max(ALPHA);
        let wanted = foretold + fit * (0.6 - foretold);
        let found = feed(&mut detector, 4.0, 0.6, period * PERIOD);
        assert!((found - wanted).abs() < 1e-12, "{count} samples, step {s}: {found} {wanted}");
    }
}

#[test]
fn a_line_is_followed_without_lag_over_long_steps() {
    for s in [0.6, 1.0, 3.0, 12.0] {
        let mut detector = settled(2.0);
        assert!((detector.ratio().unwrap() - 0.5).abs() < 1e-12);
        let found = feed(&mut detector, 4.0, 0.5 + 2.0 * s * PERIOD, s * PERIOD);
        assert!((found - (0.5 + 2.0 * s * PERIOD)).abs() < 1e-12, "step {s}: {found}");
    }
}

/// Jitter of some per cent changes the gains by no more than that.
#[test]
fn jitter_is_borne() {
    let mut rng = Pcg64Mcg::seed_from_u64(63);
    let (mut even, mut uneven) = (settled(0.0), settled(0.0));
    let mut worst = Worst::new();
    for _ in 0..2000 {
        let ratio = rng.random_range(0.4..0.6);
        let jitter = PERIOD * rng.random_range(0.98..1.02);
        worst.see(feed(&mut even, 4.0, ratio, PERIOD) - feed(&mut uneven, 4.0, ratio, jitter));
    }
    // Two per cent of a fifth, and somewhat more since the slope remembers.
    assert!(worst.get() < 4e-3, "{}", worst.get());
}

/// A rate that is off by 1 % is taken for regular, and learnt.
#[test]
fn a_slightly_different_rate_is_learnt() {
    for share in [1.01, 0.99] {
        let mut detector = settled(0.0);
        for _ in 0..300 {
            feed(&mut detector, 4.0, 0.5, share * PERIOD);
            feed(&mut detector, 4.0, 0.5 + 1e-12, share * PERIOD);
        }
        let found = feed(&mut detector, 4.0, 0.6, 3.7 * PERIOD);
        assert!((found - (0.5 + 0.1 * gain(3.7 / share))).abs() < 1e-9, "{share}: {found}");
    }
}

#[test]
fn time_of_unusable_samples_counts() {
    let mut detector = settled(0.0);
    let bad = ContactForce::new(f64::NAN, Vector3::zeros(), 0.0);
    for _ in 0..3 {
        assert_eq!(detector.update(&bad, PERIOD), SlipVerdict::NotPressing);
    }
    // Not that of a clock that runs backwards.
    detector.update(&bad, -PERIOD);
    detector.update(&bad, f64::NAN);
    let found = feed(&mut detector, 4.0, 0.6, PERIOD);
    assert!((found - (0.5 + 0.1 * gain(4.0))).abs() < 1e-12, "{found}");
}

#[test]
fn a_gap_starts_anew() {
    let mut detector = settled(2.0);
    assert_eq!(feed(&mut detector, 4.0, 0.7, 16.1 * PERIOD), 0.7);
    // Without the slope of before: the next sample is met by the line through two points.
    assert!((feed(&mut detector, 4.0, 0.65, PERIOD) - 0.65).abs() < 1e-12);
    let third = feed(&mut detector, 4.0, 0.65, PERIOD);
    assert!((third - end_of_fit(&[0.7, 0.65, 0.65])).abs() < 2e-3, "{third}");
}

/// A sensor that has become twenty times slower is followed from the sixth sample on: each gap makes the
/// nominal time longer by a sixteenth, and 1.0625⁴·16 is above 20.
#[test]
fn a_slower_rate_is_learnt_slowly() {
    let mut detector = settled(0.0);
    let mut followed = None;
    for index in 0..20 {
        let ratio = if index % 2 == 0 { 0.6 } else { 0.4 };
        // The first sample after a gap, and the second, are met.
        if (feed(&mut detector, 4.0, ratio, 20.0 * PERIOD) - ratio).abs() > 1e-9 {
            followed = Some(index);
            break;
        }
    }
    assert_eq!(followed, Some(5));
}

#[test]
fn an_open_contact_forgets_and_a_faulty_sample_does_not() {
    let mut detector = settled(2.0);
    let press = |normal: f64| ContactForce::new(normal, Vector3::new(0.0, 1.0, 0.0), 0.0);
    assert_eq!(detector.update(&press(f64::NAN), PERIOD), SlipVerdict::NotPressing);
    assert!(detector.ratio().is_some());
    // The gate is at ten deviations.
    let mut just = detector;
    assert_eq!(just.update(&press(0.1 + 1e-9), PERIOD), SlipVerdict::Holding);
    assert_eq!(detector.update(&press(0.1), PERIOD), SlipVerdict::NotPressing);
    assert_eq!(detector.ratio(), None);
    assert_eq!(feed(&mut detector, 4.0, 0.3, PERIOD), 0.3);
    assert_eq!(feed(&mut detector, 4.0, 0.4, PERIOD), 0.4);
}

/// Forces that no ratio holds, and ratios from which no line comes back, are not followed.
#[test]
fn forces_out_of_range_are_not_followed() {
    let mut detector = settled(0.0);
    let far = ContactForce::new(0.2, Vector3::new(0.0, f64::MAX, 0.0), 0.0);
    assert_eq!(detector.update(&far, PERIOD), SlipVerdict::NotPressing);
    assert_eq!(feed(&mut detector, 4.0, 0.5, PERIOD), 0.5);
    let great = ContactForce::new(4.0, Vector3::new(0.0, f64::MAX / 2.0, 0.0), 0.0);
    assert_eq!(detector.update(&great, PERIOD), SlipVerdict::NotPressing);
    assert_eq!(detector.ratio(), None);
    // Small loads are followed like others.
    let mut detector = unmoved();
    for load in [0.0, 5e-324, 1e-200, 1e-160] {
        let force = ContactForce::new(4.0, Vector3::new(load, 0.0, 0.0), 0.0);
        assert_eq!(detector.update(&force, PERIOD), SlipVerdict::Holding);
    }
    assert!(detector.ratio().unwrap().abs() < 1e-100);
}

/// A burst of them at an even rate leaves nothing behind: what comes after is followed.
#[test]
fn a_burst_of_the_greatest_forces_leaves_nothing_behind() {
    let mut detector = settled(0.0);
    for index in 0..1000_u32 {
        let load = if index.is_multiple_of(7) { 1.0 } else { f64::MAX };
        detector.update(&ContactForce::new(4.0, Vector3::new(load, 0.0, 0.0), 0.0), PERIOD);
        assert!(detector.ratio().is_none_or(f64::is_finite), "{index}: {:?}", detector.ratio());
    }
    for _ in 0..100 {
        feed(&mut detector, 4.0, 0.5, PERIOD);
    }
    assert!((detector.ratio().unwrap() - 0.5).abs() < 1e-3);
}
