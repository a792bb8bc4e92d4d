//! Rolling, sliding, sticking, and the curvature of what rolls.

use fingertip_contact::{ContactModel, PointContact};
use fingertip_contact::{
    Continuity, FingerVelocity, MotionJudge, NoCurvature, RollingCurvature, Sighting, Tracked, Tracker,
    WrenchSpread,
};
use fingertip_surfaces::Sphere;
use fingertip_wrench::Wrench;
use nalgebra::{Matrix2, Rotation3, Vector2, Vector3};
use proptest::prelude::*;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

const FINGER: f64 = 0.013;
const OBJECT: f64 = 0.020;

/// Two spheres in motion: the contact is where the line of their centres says, and moves as the kinematics say. The object
/// rests, and the finger turns about some point.
#[test]
fn two_spheres_move_as_the_kinematics_say() {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut vector = || -> Vector3<f64> { Vector3::from_fn(|_, _| StandardNormal.sample(&mut random)) };
    for _ in 0..200 {
        // In the sensor's frame at the start: the finger's centre is the origin, the object's beyond the contact.
        let normal = vector().normalize();
        let centre = normal * (FINGER + OBJECT);
        let angular = vector();
        // The centres keep their distance.
        let linear = vector() * 0.01;
        let linear = linear - normal * linear.dot(&normal);
        let finger = FingerVelocity { linear, angular };
        // Where the contact is on the finger a moment later: the object's centre as the finger sees it.
        let seen = |time: f64| {
            let turn = Rotation3::from_scaled_axis(angular * time);
            turn.inverse() * (centre - linear * time)
        };
        let moment = 1e-6;
        let moved = (seen(moment).normalize() - seen(-moment).normalize()) * (FINGER / (2.0 * moment));
        let (e1, e2) = fingertip_wrench::tangents(&normal);
        let point = normal * FINGER;
        let sliding = finger.sliding(&point, &normal);
        // (K_f + K_o) ċ = n × ω − K_o v_s.
        let left = moved * (1.0 / FINGER + 1.0 / OBJECT);
        let right = normal.cross(&angular) - sliding / OBJECT;
        assert!((left - right).norm() < 1e-6 * (1.0 + left.norm()), "{left} {right}");
        // Without sliding.
        let rolls = FingerVelocity { linear: linear - sliding, angular };
        assert!(rolls.sliding(&point, &normal).norm() < 1e-15);
        let [of_finger, of_object] = [FINGER, OBJECT].map(|radius| Matrix2::identity() / radius);
        let over = rolls.rolling(&normal, &[e1, e2], &of_finger, &of_object).unwrap();
        assert!((over - normal.cross(&angular) / (1.0 / FINGER + 1.0 / OBJECT)).norm() < 1e-12);
    }
    // A hollow that is as curved as the finger, or more, touches not in a point.
    let still = FingerVelocity { linear: Vector3::zeros(), angular: Vector3::<f64>::y() };
    let round = Matrix2::identity() / FINGER;
    for hollow in [-round, -round * 2.0, Matrix2::repeat(f64::NAN)] {
        assert!(still.rolling(&Vector3::z(), &[Vector3::x(), Vector3::y()], &round, &hollow).is_none());
    }
}

fn tracked(velocity: Vector2<f64>, variance: f64) -> Tracked<f64> {
    Tracked {
        point: Vector3::new(0.0, 0.0, FINGER),
        normal: Vector3::z(),
        tangents: [Vector3::x(), Vector3::y()],
        velocity: Vector3::new(velocity.x, velocity.y, 0.0),
        position_covariance: Matrix2::identity() * 1e-8,
        velocity_covariance: Matrix2::identity() * variance,
        innovation: Vector2::zeros(),
        surprise: 0.0,
        continuity: Continuity::Followed,
    }
}

/// Of motions that are said to slide with a probability of 30 %, 30 % slide.
#[test]
fn probabilities_are_frequencies() {
    let mut random = Pcg64Mcg::seed_from_u64(2);
    let (speed, linear, of_track) = (0.01, 0.003, 0.004);
    let judge = MotionJudge::new(speed, linear, 0.0).unwrap();
    let mut bins = [[[0.0; 3]; 10]; 3];
    for k in 0..60_000 {
        let mut plane = |size: f64| -> Vector2<f64> {
            Vector2::from_fn(|_, _| StandardNormal.sample(&mut random)) * size
        };
        let kind = k % 3;
        let runs = kind == 1 || (kind == 2 && k % 2 == 0);
        let sliding = if kind == 2 { plane(speed) } else { Vector2::zeros() } + plane(linear);
        let over = if runs { plane(speed) } else { Vector2::zeros() } + plane(of_track);
        let finger = FingerVelocity { linear: sliding.push(0.0), angular: Vector3::zeros() };
        let found = judge.judge(&tracked(over, of_track * of_track), &finger).unwrap();
        let all = [found.sticking, found.rolling, found.sliding];
        assert!((all.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        for (what, said) in all.into_iter().enumerate() {
            let bin = &mut bins[what][((said * 10.0) as usize).min(9)];
            bin[0] += 1.0;
            bin[1] += said;
            bin[2] += f64::from(u8::from(kind == what));
        }
    }
    for bin in bins.iter().flatten().filter(|bin| bin[0] > 200.0) {
        let (said, was) = (bin[1] / bin[0], bin[2] / bin[0]);
        let deviation = (said * (1.0 - said) / bin[0]).sqrt();
        assert!((said - was).abs() < 4.5 * deviation + 1e-3, "{said} {was} of {}", bin[0]);
    }
}

/// Rolls by 30° in one direction and then across, a second each, pressed with 2 N.
fn roll(seed: u64, second: bool) -> RollingCurvature<f64> {
    let ball = Sphere::new(Vector3::zeros(), FINGER).unwrap();
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut tracker = Tracker::new(0.01, 0.1).unwrap();
    let mut learnt = RollingCurvature::new(FINGER).unwrap();
    let (mut normal, mut ahead) = (Vector3::z(), Vector3::x());
    let noise = WrenchSpread::Isotropic { force: 4e-6, torque: 9e-10 };
    let step = 1e-3;
    for k in 0..2000 {
        let across = normal.cross(&ahead);
        let turning = if k < 1000 || !second { ahead } else { across } * 30_f64.to_radians();
        // n × ω is what the contact's velocity follows.
        let angular = turning.cross(&normal);
        let over = turning / (1.0 / FINGER + 1.0 / OBJECT);
        let turn = Rotation3::from_scaled_axis(normal.cross(&over) * (step / FINGER));
        (normal, ahead) = (turn * normal, turn * ahead);
        let exact = Wrench::from_force_at(&(normal * FINGER), -normal * 2.0);
        let mut drawn = |size: f64| -> Vector3<f64> {
            Vector3::from_fn(|_, _| StandardNormal.sample(&mut random)) * size
        };
        let wrench = exact + Wrench::on_fingertip(drawn(2e-3), drawn(3e-5));
        let found = PointContact::new(0.1).unwrap().resolve(&wrench, &ball);
        let sighting = Sighting::of_point_contact(found.contact().unwrap(), &wrench, noise).unwrap();
        let tracked = tracker.follow(&ball, Some(&sighting), step).unwrap();
        let finger = FingerVelocity { linear: Vector3::zeros(), angular };
        if k > 0 && tracked.continuity != Continuity::New {
            learnt.roll(&tracked, &sighting, &finger, &(Matrix2::identity() / FINGER), step);
        }
    }
    learnt
}

/// Within 5 % after 30° in two directions, with errors as large as is said.
#[test]
fn rolling_tells_the_curvature() {
    let (mut errors, mut normalised, runs) = (Vec::new(), 0.0, 40);
    for seed in 0..runs {
        let found = roll(seed, true).find().unwrap();
        let k = found.curvature;
        let error = Vector3::new(k.m11 - 1.0 / OBJECT, k.m12, k.m22 - 1.0 / OBJECT);
        errors.push(error.amax() * OBJECT);
        normalised += error.dot(&(found.covariance.try_inverse().unwrap() * error)) / runs as f64;
        assert!(found.tangents[0].dot(&found.tangents[1]).abs() < 1e-12);
    }
    errors.sort_by(f64::total_cmp);
    println!(
        "worst entry of the curvature: median {:.4}, greatest {:.4}; {normalised}",
        errors[20], errors[39]
    );
    assert!(errors[39] < 0.05, "{errors:?}");
    // χ² of three degrees of freedom, 40 times.
    assert!((normalised - 3.0).abs() < 4.0 * (6.0 / 40.0_f64).sqrt(), "{normalised}");
}

#[test]
fn one_direction_does_not_tell_a_curvature() {
    assert_eq!(RollingCurvature::new(FINGER).unwrap().find(), Err(NoCurvature::OneDirection));
    // Noise of the samples turns the tangents a little, so that across is told badly, if at all.
    match roll(5, false).find() {
        Ok(found) => assert!(found.covariance.m33.sqrt() > 1.0 / OBJECT, "{found:?}"),
        Err(reason) => assert!(matches!(reason, NoCurvature::OneDirection | NoCurvature::NotRolling)),
    }
}

#[test]
fn settings_out_of_range_are_named() {
    let message = |speed: f64, linear: f64, angular: f64| {
        MotionJudge::new(speed, linear, angular).unwrap_err().to_string()
    };
    assert_eq!(
        message(0.0, 0.0, 0.0),
        "the speed of a judge of motion must be positive and of ordinary size"
    );
    assert!(message(f64::NAN, 0.0, 0.0).contains("speed"));
    assert!(message(1.0, -1.0, 0.0).contains("noise of the linear velocity"));
    assert!(message(1.0, 0.0, f64::INFINITY).contains("noise of the angular velocity"));
    assert!(
        RollingCurvature::new(0.0)
            .unwrap_err()
            .to_string()
            .contains("the radius of a curvature from rolling")
    );
}

proptest! {
    #[test]
    fn any_bits_of_motion(all in proptest::collection::vec(any::<[u32; 12]>(), 1..12)) {
        let judge = MotionJudge::new(0.01_f32, 1e-3, 1e-2).unwrap();
        let ball = Sphere::new(Vector3::zeros(), 0.013_f32).unwrap();
        let mut tracker = Tracker::new(0.01_f32, 0.1).unwrap();
        let mut learnt = RollingCurvature::new(0.013_f32).unwrap();
        for (k, bits) in all.into_iter().enumerate() {
            let [a, b, c, d, e, f, k11, k12, k22, time, size, _] = bits.map(f32::from_bits);
            let finger = FingerVelocity { linear: Vector3::new(a, b, c), angular: Vector3::new(d, e, f) };
            let normal = Vector3::new(k as f32 * 0.01, 0.1, 1.0).normalize();
            let (e1, e2) = fingertip_wrench::tangents(&normal);
            let covariance = Matrix2::identity() * if k % 2 == 0 { size } else { 1e-8 };
            let Some(sighting) = Sighting::new(normal * 0.013, normal, [e1, e2], covariance) else { continue };
            let Some(tracked) = tracker.follow(&ball, Some(&sighting), 1e-3) else { continue };
            if let Some(found) = judge.judge(&tracked, &finger) {
                let all = [found.sticking, found.rolling, found.sliding];
                prop_assert!(all.iter().all(|p| (0.0..=1.0).contains(p)), "{found:?}");
            }
            let curvature = Matrix2::new(k11, k12, k12, k22);
            learnt.roll(&tracked, &sighting, &finger, &curvature, time);
            if let Ok(found) = learnt.find() {
                prop_assert!(found.curvature.iter().chain(found.covariance.iter()).all(|x| x.is_finite()));
            }
        }
    }
}
