use super::{PayloadError, PayloadFit, PayloadOptions, fit_payload};
use crate::file::Verdict;
use crate::fit::FitError;
use crate::fit::testing::gaussian;
use crate::gravity::{Pose, fit_orientation};
use crate::testing::Largest as _;
use nalgebra::{Rotation3, Vector3, Vector6};
use proptest::prelude::*;
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

fn rotation(random: &mut Pcg64Mcg) -> Rotation3<f64> {
    let q = nalgebra::Quaternion::new(gaussian(random), gaussian(random), gaussian(random), gaussian(random));
    nalgebra::UnitQuaternion::from_quaternion(q).to_rotation_matrix()
}

fn vector(random: &mut Pcg64Mcg) -> Vector3<f64> {
    Vector3::from_fn(|_, _| gaussian(random))
}

fn poses(
    random: &mut Pcg64Mcg,
    count: usize,
    g: Vector3<f64>,
    c: Vector3<f64>,
    b: Vector6<f64>,
) -> Vec<Pose> {
    (0..count)
        .map(|_| {
            let turn = rotation(random).into_inner();
            let f = turn.transpose() * g;
            let m = c.cross(&f);
            Pose { base_from_sensor: turn, wrench: Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z) + b }
        })
        .collect()
}

proptest! {
    #[test]
    fn exact_from_four_poses(seed in any::<u64>()) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let (g, c) = (Vector3::new(0.1, -0.2, -3.0), vector(random) * 0.05);
        let bias = Vector6::from_fn(|_, _| gaussian(random));
        let poses = poses(random, 4, g, c, bias);
        let options = PayloadOptions { down: None, ..PayloadOptions::default() };
        if let Ok(fit) = fit_payload(&poses, &options) && fit.condition_number < 20.0 {
            prop_assert!((fit.weight - g).largest() < 1e-12);
            prop_assert!((fit.centre_of_mass - c).largest() < 1e-12);
            prop_assert!((fit.force_bias - bias.fixed_rows::<3>(0)).largest() < 1e-12);
            prop_assert!((fit.torque_bias - bias.fixed_rows::<3>(3)).largest() < 1e-12);
        }
    }

    #[test]
    fn orientation_is_found(seed in any::<u64>()) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let mount = rotation(random).into_inner();
        let bias = vector(random);
        let poses: Vec<Pose> = (0..8)
            .map(|_| {
                let turn = rotation(random).into_inner();
                let f = mount * (turn.transpose() * Vector3::new(0.0, 0.0, -4.0)) + bias;
                Pose { base_from_sensor: turn, wrench: Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0) }
            })
            .collect();
        let fit = fit_orientation(&poses, &-Vector3::z()).unwrap();
        prop_assert!((fit.sensor_from_flange - mount).largest() < 1e-10);
        prop_assert!((fit.weight - 4.0).abs() < 1e-10 && (fit.force_bias - bias).largest() < 1e-10);
        prop_assert!(fit.distortion < 1e-10);
    }
}

#[test]
fn mass_is_weight_over_gravity() {
    let random = &mut Pcg64Mcg::seed_from_u64(21);
    let (g, c) = (Vector3::new(0.0, 3.0, -3.0), Vector3::new(0.01, -0.02, 0.03));
    let bias = Vector6::new(0.1, 0.2, 0.3, 0.01, 0.02, 0.03);
    let poses = poses(random, 10, g, c, bias);
    let options = PayloadOptions { down: None, gravity: 2.0, ..PayloadOptions::default() };
    let fit = fit_payload(&poses, &options).unwrap();
    let length = 18.0_f64.sqrt();
    assert!((fit.mass - length / 2.0).abs() < 1e-12);
    assert!((fit.tilt - core::f64::consts::FRAC_PI_4).abs() < 1e-12);
    assert!(fit.warnings.is_empty(), "{:?}", fit.warnings);
    let read = fit.reading(&poses[3].base_from_sensor);
    assert!((read - poses[3].wrench).largest() < 1e-12);
    let mut fit = fit;
    fit.weight_deviation = 0.3;
    fit.warnings = vec!["a".to_owned()];
    let file = fit.to_file(10).unwrap();
    assert_eq!((file.mass, file.quality.poses), (fit.mass, 10));
    assert!((Vector3::from(file.gravity) - g / fit.mass).largest() < 1e-12);
    assert!((file.quality.mass_deviation - fit.mass * 0.3 / length).abs() < 1e-12);
    assert!((Vector3::from(file.centre_of_mass) - c).largest() < 1e-12);
    assert!((Vector3::from(file.force_bias) - Vector3::new(0.1, 0.2, 0.3)).largest() < 1e-12);
    assert!((Vector3::from(file.torque_bias) - Vector3::new(0.01, 0.02, 0.03)).largest() < 1e-12);
    assert_eq!((file.quality.rms, file.quality.warnings), (fit.rms, fit.warnings.clone()));
}

/// Four readings, given in the base frame by mistake, may look like a weight. They fit exactly if they are
/// taken for what they are.
#[test]
fn mixed_frames_are_recognised() {
    let (g, c) = (Vector3::new(0.0, 0.0, -3.0), Vector3::new(0.01, -0.02, 0.03));
    let options = PayloadOptions { down: None, ..PayloadOptions::default() };
    let mut fitted = 0;
    for seed in 0..400 {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let bias = vector(random);
        let bias = Vector6::new(bias.x, bias.y, bias.z, 0.0, 0.0, 0.0);
        let mixed: Vec<Pose> = poses(random, 4, g, c, bias)
            .iter()
            .map(|pose| {
                let f = pose.base_from_sensor * pose.wrench.fixed_rows::<3>(0);
                Pose { wrench: Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0), ..*pose }
            })
            .collect();
        let Ok(fit) = fit_payload(&mixed, &options) else { continue };
        fitted += 1;
        assert!(fit.rms_if_in_base < 1e-12, "{}", fit.rms_if_in_base);
        assert!(fit.warnings.iter().any(|warning| warning.contains("frames seem to be mixed")), "{fit:?}");
    }
    assert!(fitted >= 5, "{fitted}");
}

#[test]
fn what_is_badly_known_is_warned_of() {
    let random = &mut Pcg64Mcg::seed_from_u64(22);
    let (g, c) = (Vector3::new(0.0, 0.0, -3.0), Vector3::new(0.01, -0.02, 0.03));
    let good = poses(random, 12, g, c, Vector6::zeros());
    let noisy = |random: &mut Pcg64Mcg, poses: &[Pose], noise: f64| -> Vec<Pose> {
        let error = |random: &mut Pcg64Mcg| {
            Vector6::from_fn(|i, _| if i < 3 { noise * gaussian(random) } else { 0.0 })
        };
        poses.iter().map(|pose| Pose { wrench: pose.wrench + error(random), ..*pose }).collect()
    };
    let options = PayloadOptions::default();
    for (noise, warned) in [(0.05, false), (1.0, true)] {
        let fit = fit_payload(&noisy(random, &good, noise), &options).unwrap();
        // The statement itself decides, and noise over √(poses) is about what it must be.
        assert_eq!(fit.weight_deviation > 0.02 * fit.weight.norm(), warned);
        assert_eq!(fit.warnings.iter().any(|warning| warning.contains("no better than 2 %")), warned);
        assert!((fit.weight_deviation / (noise / 12.0_f64.sqrt()) - 1.0).abs() < 0.6, "{fit:?}");
    }
    // Turned by a few degrees only, the weight is hardly told from the force without load.
    for (spread, warned) in [(0.5, false), (0.01, true)] {
        let alike: Vec<Pose> = (0..12)
            .map(|_| {
                let turn = Rotation3::from_scaled_axis(vector(random) * spread).into_inner();
                let f = turn.transpose() * g;
                let m = c.cross(&f);
                Pose { base_from_sensor: turn, wrench: Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z) }
            })
            .collect();
        let fit = fit_payload(&alike, &options).unwrap();
        assert_eq!(fit.condition_number > 30.0, warned, "{}", fit.condition_number);
        assert_eq!(fit.warnings.iter().any(|warning| warning.contains("too alike")), warned);
    }
}

#[test]
fn mistakes_are_named() {
    let random = &mut Pcg64Mcg::seed_from_u64(1);
    let (g, c) = (Vector3::new(0.0, 0.0, -3.0), Vector3::new(0.01, 0.02, 0.03));
    let good = poses(random, 10, g, c, Vector6::zeros());
    let reaction: Vec<Pose> = good.iter().map(|pose| Pose { wrench: -pose.wrench, ..*pose }).collect();
    let error = fit_payload(&reaction, &PayloadOptions::default()).unwrap_err();
    assert!(matches!(error, PayloadError::NegativeMass { .. }), "{error}");
    assert!(matches!(fit_orientation(&reaction, &-Vector3::z()), Err(PayloadError::NegativeMass { .. })));
    let mixed: Vec<Pose> = good
        .iter()
        .map(|pose| {
            let f = pose.base_from_sensor * pose.wrench.fixed_rows::<3>(0)
                + Vector3::new(0.0, 0.0, 1e-3 * gaussian(random));
            Pose { wrench: Vector6::new(f.x, f.y, f.z, 0.0, 0.0, 0.0), ..*pose }
        })
        .collect();
    match fit_payload(&mixed, &PayloadOptions::default()) {
        Ok(fit) => assert!(fit.warnings.iter().any(|warning| warning.contains("frames")), "{fit:?}"),
        Err(error) => assert!(matches!(error, PayloadError::NoWeight { .. }), "{error}"),
    }
    // All poses alike: the weight cannot be told from the bias.
    let same = vec![good[0]; 6];
    let error = fit_payload(&same, &PayloadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("weight"), "{error}");
    let options = PayloadOptions { down: Some(Vector3::zeros()), ..PayloadOptions::default() };
    assert_eq!(fit_payload(&good, &options).unwrap_err(), PayloadError::NoDirection("direction of gravity"));
}

#[test]
fn readings_of_nothing_at_all_are_no_weight() {
    let random = &mut Pcg64Mcg::seed_from_u64(29);
    let poses = poses(random, 8, Vector3::zeros(), Vector3::zeros(), Vector6::zeros());
    for down in [None, Some(-Vector3::z())] {
        let options = PayloadOptions { down, ..PayloadOptions::default() };
        let error = fit_payload(&poses, &options).unwrap_err();
        assert!(matches!(error, PayloadError::NoWeight { weight: 0.0, .. }), "{error}");
    }
}

#[test]
fn a_pose_needs_a_turn_and_numbers() {
    let pose = |xyzw, wrench| Pose::from_quaternion(xyzw, wrench);
    // Half a turn about x, of any length.
    let turned = pose([3.0, 0.0, 0.0, 0.0], Vector6::repeat(1.0)).unwrap();
    let expected = nalgebra::Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    assert!((turned.base_from_sensor - expected).largest() < 1e-15);
    assert_eq!(turned.wrench, Vector6::repeat(1.0));
    assert!(pose([0.0; 4], Vector6::zeros()).is_none());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for k in 0..6 {
            let mut wrench = Vector6::zeros();
            wrench[k] = bad;
            assert!(pose([0.0, 0.0, 0.0, 1.0], wrench).is_none(), "{k} {bad}");
            let mut quaternion = [0.0, 0.0, 0.0, 1.0];
            quaternion[k % 4] = bad;
            assert!(pose(quaternion, Vector6::zeros()).is_none(), "{k} {bad}");
        }
    }
}

/// Poses that are all alike tell each axis of the weight only together with that of the bias, and each is named.
#[test]
fn what_poses_leave_open_is_named_axis_by_axis() {
    let random = &mut Pcg64Mcg::seed_from_u64(31);
    let one = poses(random, 1, Vector3::new(0.0, 0.0, -3.0), Vector3::zeros(), Vector6::zeros())[0];
    let same = vec![Pose { base_from_sensor: nalgebra::Matrix3::identity(), ..one }; 6];
    let named = |error: PayloadError, stem: &str| {
        let PayloadError::Fit(FitError::Unobserved(unobserved)) = error else { panic!("{error}") };
        let names = [stem, "bias"].map(|stem| ["x", "y", "z"].map(|axis| format!("{stem} {axis}"))).concat();
        assert_eq!((unobserved.names, unobserved.regressors), (names, 6));
        // Each with its own.
        assert_eq!(unobserved.directions.ncols(), 3);
    };
    let free = PayloadOptions { down: None, ..PayloadOptions::default() };
    named(fit_payload(&same, &free).unwrap_err(), "weight");
    // Known to pull down, it is one unknown.
    let error = fit_payload(&same, &PayloadOptions::default()).unwrap_err();
    let PayloadError::Fit(FitError::Unobserved(unobserved)) = error else { panic!("{error}") };
    assert_eq!(unobserved.names, ["weight", "bias x", "bias y", "bias z"]);
}

/// Each of what makes a fit worthless does so alone, and says why; at its limit none does.
#[test]
fn a_bad_fit_is_bad_for_one_reason() {
    let random = &mut Pcg64Mcg::seed_from_u64(32);
    let (g, c) = (Vector3::new(0.0, 0.0, -3.0), Vector3::new(0.01, -0.02, 0.03));
    let good = fit_payload(&poses(random, 12, g, c, Vector6::zeros()), &PayloadOptions::default()).unwrap();
    assert_eq!((good.verdict(), good.warnings.len()), (Verdict::Good, 0));
    let with = |change: fn(&mut PayloadFit)| {
        let mut fit = good.clone();
        change(&mut fit);
        fit.verdict()
    };
    let mixed = |rms_if_in_base: f64| {
        let mut fit = PayloadFit { rms_if_in_base, ..good.clone() };
        fit.rms[..3].fill(0.03);
        fit.verdict()
    };
    for (bad, verdict) in [
        // A third of what is left of a component, and less.
        (mixed(0.0101), Verdict::Good),
        (mixed(0.0099), Verdict::Bad),
        (with(|fit| fit.condition_number = 30.0), Verdict::Good),
        (with(|fit| fit.condition_number = 30.1), Verdict::Bad),
        (with(|fit| fit.weight_deviation = 0.299), Verdict::Good),
        (with(|fit| fit.weight_deviation = 0.301), Verdict::Bad),
        // All that is left of a force, over its three components.
        (with(|fit| fit.rms[..3].fill(0.172)), Verdict::Good),
        (with(|fit| fit.rms[..3].fill(0.174)), Verdict::Bad),
        (with(|fit| fit.warnings.push("the weight".to_owned())), Verdict::Suspect),
    ] {
        assert_eq!(bad, verdict);
    }
}
