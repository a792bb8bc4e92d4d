//! Whatever comes: no NaN goes out, and the next good samples are followed.

use fingertip_contact::{ContactModel, PointContact, Sighting, Tracked, Tracker, WrenchSpread};
use fingertip_surfaces::{Capsule, Plane, Sphere};
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix2, Matrix6, Vector3, Vector6};
use proptest::prelude::*;

fn is_sound<T: Real>(tracked: &Tracked<T>) -> bool {
    let vectors = [tracked.point, tracked.normal, tracked.velocity, tracked.tangents[0], tracked.tangents[1]];
    let matrices = [tracked.position_covariance, tracked.velocity_covariance];
    vectors.iter().all(|v| v.iter().all(|x| x.is_number()))
        && matrices
            .iter()
            .all(|m| m.iter().all(|x| x.is_number()) && m.m11 >= T::zero() && m.m22 >= T::zero())
        && tracked.innovation.iter().all(|x| x.is_number())
        && tracked.surprise.is_number()
        && tracked.deviation().is_number()
}

fn on_ball<T: Real>(x: f64, y: f64, covariance: Matrix2<T>) -> Option<Sighting<T>> {
    let normal = Vector3::new(x, y, 1.0).normalize().map(T::literal);
    let (e1, e2) = fingertip_wrench::tangents(&normal);
    Sighting::new(normal * T::literal(0.013), normal, [e1, e2], covariance)
}

fn good<T: Real>() -> Sighting<T> {
    on_ball(0.1, 0.1, Matrix2::identity() * T::literal(1e-8)).unwrap()
}

fn any_of<T: Real>(
    bits: impl Fn(u64) -> T,
    noise: [u64; 3],
    times: [u64; 6],
    x: f64,
    y: f64,
) -> Result<(), TestCaseError> {
    let ball = Sphere::new(Vector3::zeros(), T::literal(0.013)).unwrap();
    let mut tracker = Tracker::new(T::literal(0.01), T::literal(0.1)).unwrap();
    tracker.follow(&ball, Some(&good()), T::literal(1e-3));
    let [a, b, c] = noise.map(&bits);
    for (k, time) in times.into_iter().enumerate() {
        let sighting = on_ball(x + k as f64 * 1e-3, y, Matrix2::new(a, b, b, c));
        if let Some(tracked) = tracker.follow(&ball, sighting.as_ref(), bits(time)) {
            prop_assert!(is_sound(&tracked), "{tracked:?}");
        }
    }
    // Two good samples are enough to be followed again.
    for _ in 0..3 {
        tracker.follow(&ball, Some(&good()), T::literal(1e-3));
    }
    let last = tracker.follow(&ball, Some(&good()), T::literal(1e-3)).unwrap();
    let off = (last.point - good::<T>().point()).norm();
    prop_assert!(is_sound(&last));
    prop_assert!(off <= T::literal(1e-3), "{off} {last:?}");
    Ok(())
}

proptest! {
    #[test]
    fn any_bits_of_noise_and_time(noise in any::<[u64; 3]>(), times in any::<[u64; 6]>(), x in -2.0..2.0, y in -2.0..2.0) {
        any_of(f64::from_bits, noise, times, x, y)?;
        #[allow(clippy::cast_possible_truncation)]
        any_of(|bits| f32::from_bits(bits as u32), noise, times, x, y)?;
    }

    /// Noise of any size in each direction, over the whole range of the type, and steps of any length.
    #[test]
    fn any_size_of_noise_and_time(
        powers in proptest::collection::vec((-40.0..40.0, -40.0..40.0, -0.999..0.999, -12.0..12.0), 30),
    ) {
        let ball = Sphere::new(Vector3::zeros(), 0.013_f32).unwrap();
        let mut tracker = Tracker::new(0.01_f32, 0.1).unwrap();
        for (k, (one, other, both, time)) in powers.into_iter().enumerate() {
            let power = |p: f64| 10.0_f64.powf(p) as f32;
            let (a, c) = (power(one), power(other));
            let b = (10.0_f64.powf((one + other) * 0.5) * both) as f32;
            let sighting = on_ball(k as f64 * 1e-3, 0.1, Matrix2::new(a, b, b, c));
            if let Some(tracked) = tracker.follow(&ball, sighting.as_ref(), power(time)) {
                prop_assert!(is_sound(&tracked), "{tracked:?}");
            }
        }
    }
}

#[test]
fn odd_times_count_as_none_or_as_a_pause() {
    let ball = Sphere::new(Vector3::zeros(), 0.013).unwrap();
    let started = || {
        let mut tracker = Tracker::new(0.01, 0.1).unwrap();
        for _ in 0..50 {
            tracker.follow(&ball, Some(&good()), 1e-3);
        }
        tracker
    };
    let next = |time: f64| started().follow(&ball, Some(&good()), time).unwrap();
    let at_once = next(0.0);
    assert!(!at_once.is_new());
    for time in [-0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
        assert_eq!(next(time), at_once, "{time}");
    }
    for time in [f64::INFINITY, 1e300, 1.01] {
        assert!(next(time).is_new(), "{time}");
    }
}

/// Certain samples, of no noise at all, are followed; two at the same time that contradict each other are two contacts.
#[test]
fn samples_that_are_certain_are_followed() {
    let ball = Sphere::new(Vector3::zeros(), 0.013).unwrap();
    let certain = |x| on_ball(x, 0.0, Matrix2::zeros()).unwrap();
    let mut tracker = Tracker::new(0.01, 0.1).unwrap();
    for k in 0..100 {
        let sighting = certain(f64::from(k) * 5e-4);
        let tracked = tracker.follow(&ball, Some(&sighting), 1e-3).unwrap();
        assert!(is_sound(&tracked));
        assert_eq!(tracked.is_new(), k == 0);
        assert!((tracked.point - sighting.point()).norm() < 1e-8);
    }
    for x in [0.3, 0.3, 0.3] {
        assert!(is_sound(&tracker.follow(&ball, Some(&certain(x)), 0.0).unwrap()));
    }
    let there = tracker.follow(&ball, Some(&certain(0.3)), 1e-3).unwrap();
    assert!((there.point - certain(0.3).point()).norm() < 1e-8);
}

/// As the force vanishes a sample says nothing, and the track stays.
#[test]
fn without_force_a_sample_says_nothing() {
    let ball = Sphere::new(Vector3::zeros(), 0.013).unwrap();
    let mut tracker = Tracker::new(0.01, 0.1).unwrap();
    for _ in 0..100 {
        tracker.follow(&ball, Some(&good()), 1e-3);
    }
    let before = tracker.follow(&ball, Some(&good()), 1e-3).unwrap();
    for k in 0..10 {
        let far = on_ball(1.0, -1.0, Matrix2::identity() * 10.0_f64.powi(30 * k)).unwrap();
        let tracked = tracker.follow(&ball, Some(&far), 1e-3).unwrap();
        assert!((tracked.point - before.point).norm() < 1e-4, "{k}");
    }
}

#[test]
fn sightings_that_cannot_be_are_none() {
    let unit = Matrix2::<f64>::identity();
    let frame = [Vector3::x(), Vector3::y()];
    let of = |point, normal, covariance| Sighting::new(point, normal, frame, covariance);
    let (o, z) = (Vector3::zeros(), Vector3::z());
    assert!(of(o, z, unit).is_some());
    // A normal that is not quite a unit vector is made one.
    assert!((of(o, z * 1.005, unit).unwrap().normal() - z).amax() < 1e-15);
    assert!(of(Vector3::repeat(f64::NAN), z, unit).is_none());
    assert!(of(o, z * 1.1, unit).is_none());
    assert!(of(o, o, unit).is_none());
    assert!(of(o, z, -unit).is_none());
    assert!(of(o, z, Matrix2::new(1.0, 2.0, 2.0, 1.0)).is_none());
    assert!(of(o, z, unit * f64::INFINITY).is_none());
    assert!(of(o, z, unit * f64::NAN).is_none());
    let odd = [Vector3::repeat(f64::INFINITY), Vector3::y()];
    assert!(Sighting::new(o, z, odd, unit).is_none());
}

#[test]
fn settings_out_of_range_are_named() {
    let message = |speed: f64, within: f64| Tracker::new(speed, within).unwrap_err().to_string();
    for speed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(message(speed, 0.1), "the speed of a tracker must be positive and finite");
    }
    for within in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(message(0.01, within), "the time to turn of a tracker must be positive and finite");
    }
    let odd = "the speed times its time to turn of a tracker must be a length of ordinary size";
    assert_eq!(message(1e-300, 0.1), odd);
    assert_eq!(message(1e300, 0.1), odd);
    let tracker = Tracker::new(0.01, 0.1).unwrap();
    assert_eq!((tracker.speed(), tracker.within()), (0.01, 0.1));
    for share in [0.0, 1.0, -1.0, f64::NAN] {
        let error = tracker.with_gate(share).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the share of samples beyond the gate of a tracker must be between 0 and 1"
        );
    }
    // The quantile of χ² with two degrees of freedom.
    assert!((tracker.gate() - 13.815_510_557_964_274).abs() < 1e-12);
    assert!((tracker.with_gate(0.05).unwrap().gate() - 5.991_464_547_107_98).abs() < 1e-12);
}

/// The other side of the body is another contact, however the planes lie.
#[test]
fn the_other_side_is_another_contact() {
    let bar = Capsule::new(Vector3::zeros(), Vector3::x(), 0.5e-3, 0.01).unwrap();
    let frame = [Vector3::x(), Vector3::y()];
    let covariance = Matrix2::identity() * 1e-6;
    let above = Sighting::new(Vector3::z() * 0.5e-3, Vector3::z(), frame, covariance).unwrap();
    let below =
        Sighting::new(Vector3::z() * -0.5e-3, -Vector3::z(), [frame[1], frame[0]], covariance).unwrap();
    let mut tracker = Tracker::new(0.01, 0.1).unwrap();
    tracker.follow(&bar, Some(&above), 1e-3);
    let doubted = tracker.follow(&bar, Some(&below), 1e-3).unwrap();
    assert_eq!((doubted.surprise, doubted.point.z), (f64::MAX, 0.5e-3));
    let new = tracker.follow(&bar, Some(&below), 1e-3).unwrap();
    assert!(new.is_new() && new.point.z < 0.0);
}

/// In single precision it follows as in double precision.
#[test]
fn both_precisions_agree() {
    let plane = Plane::new(Vector3::zeros(), Vector3::z()).unwrap();
    let narrow = Plane::new(Vector3::zeros(), Vector3::<f32>::z()).unwrap();
    let (mut wide_tracker, mut narrow_tracker) =
        (Tracker::new(0.01, 0.1).unwrap(), Tracker::new(0.01_f32, 0.1).unwrap());
    for k in 0..2000 {
        let t = f64::from(k) * 1e-3;
        let point = Vector3::new(3e-3 * t.sin(), 2e-3 * (2.0 * t).cos(), 0.0);
        let covariance = Matrix2::new(4e-6, 1e-6, 1e-6, 2e-6);
        let frame = [Vector3::x(), Vector3::y()];
        let wide = Sighting::new(point, Vector3::z(), frame, covariance).unwrap();
        let single = Sighting::new(
            point.map(|x| x as f32),
            Vector3::z(),
            [Vector3::x(), Vector3::y()],
            covariance.map(|x| x as f32),
        )
        .unwrap();
        let wide = wide_tracker.follow(&plane, Some(&wide), 1e-3).unwrap();
        let single = narrow_tracker.follow(&narrow, Some(&single), 1e-3).unwrap();
        let deviation = wide.deviation();
        assert!((wide.point - single.point.map(f64::from)).norm() < 1e-3 * deviation, "{k}");
        assert!((f64::from(single.deviation()) / deviation - 1.0).abs() < 1e-3, "{k}");
        assert_eq!(wide.continuity, single.continuity);
    }
}

proptest! {
    /// Noise of a wrench in which one component is beyond compare with another.
    #[test]
    fn any_size_of_noise_of_a_wrench(
        powers in proptest::array::uniform6(-12.0..12.0_f64), force in -12.0..12.0_f64, lean in -3.0..3.0_f64,
        pitch in -1e-3..1e-3_f64,
    ) {
        fn survives<T: Real>(powers: [f64; 6], force: f64, lean: f64, pitch: f64) -> Result<(), TestCaseError> {
            let ball = Sphere::new(Vector3::zeros(), T::literal(0.013)).unwrap();
            let variances = Vector6::from(powers.map(|power| T::literal(10_f64.powf(power))));
            let full = Matrix6::from_diagonal(&variances);
            for spread in [WrenchSpread::Independent(variances), WrenchSpread::Full(&full)] {
                let mut tracker = Tracker::new(T::literal(0.01), T::literal(0.1)).unwrap();
                for k in 0..10 {
                    let normal = Vector3::new(0.02 * f64::from(k), 0.1, 1.0).normalize();
                    let push = Vector3::new(lean, 0.0, -1.0) * 10_f64.powf(force);
                    let push = Wrench::from_components(&{
                        let torque = (normal * 0.013).cross(&push) + push * pitch;
                        Vector6::new(push.x, push.y, push.z, torque.x, torque.y, torque.z).map(T::literal)
                    });
                    let Some(found) = PointContact::new(T::zero()).unwrap().resolve(&push, &ball).contact().copied()
                    else { continue };
                    let sighting = Sighting::of_point_contact(&found, &push, spread);
                    if let Some(sighting) = &sighting {
                        let covariance = sighting.covariance();
                        prop_assert!(covariance.iter().all(|x| x.is_number()));
                        prop_assert!(covariance.m11 >= T::zero() && covariance.m22 >= T::zero());
                    }
                    if let Some(tracked) = tracker.follow(&ball, sighting.as_ref(), T::literal(1e-3)) {
                        prop_assert!(is_sound(&tracked), "{tracked:?}");
                    }
                }
            }
            Ok(())
        }
        survives::<f64>(powers, force, lean, pitch)?;
        survives::<f32>(powers, force, lean, pitch)?;
    }
}
