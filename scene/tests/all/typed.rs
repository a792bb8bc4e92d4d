//! The pipeline of a scene and the typed one, bit for bit.

use fingertip::contact::{PointContact, SoftFinger};
use fingertip::friction::{Coulomb, DropDetector, ForceNoise, SoftFingerLimit};
use fingertip::surfaces::{ActiveSurface, Capsule, DynSurface, Posed, Sphere};
use fingertip::wrench::{Line, RigidTransform, Wrench};
use fingertip::{Absent, Fingertip, Present, Step, TouchSensor};
use fingertip_scene::{Pipeline, Scene};
use nalgebra::Vector3;

use crate::{BALL, HEAD, pushes};

type TypedBall =
    Fingertip<Absent, Sphere<f64>, PointContact<f64>, Present<Coulomb<f64>>, Present<DropDetector<f64>>>;

/// A point contact on a sphere with friction and a slip detector, from a scene and typed.
fn ball() -> (Pipeline<f64>, TypedBall) {
    let text = format!(
        "{HEAD}{BALL}[contact]\nleast_force_N = 0.1\n[friction]\nstatic_coefficient = 0.5\n\
         [slip]\ndetector = \"drop\"\nnoise_N = 0.01\n"
    );
    let typed = Fingertip::builder()
        .contact(Sphere::centred(0.013).unwrap(), PointContact::new(0.1).unwrap())
        .friction(Coulomb::new(0.5).unwrap())
        .slip_detector(DropDetector::new(ForceNoise::isotropic(0.01).unwrap()).unwrap())
        .build();
    (Scene::from_text(&text).unwrap().pipeline(), typed)
}

#[test]
fn a_point_contact_on_a_sphere() {
    let (mut pipeline, mut typed) = ball();
    let mut last = None;
    for push in pushes(3, 2000) {
        let felt = pipeline.sense(push, 1e-3);
        let touch = typed.sense_wrench(push, Step::of(1e-3).with_last(last));
        last = touch.point();
        assert_eq!(felt.touch.resolution, touch.resolution);
        assert_eq!(
            (felt.touch.force, felt.margin(), felt.touch.slip),
            (touch.force, touch.grip, Some(touch.slip))
        );
    }
}

#[test]
fn a_soft_finger_on_a_capsule_that_is_turned() {
    let text = format!(
        "{HEAD}[surface]\nshape = \"capsule\"\nradius_m = 0.008\nhalf_length_m = 0.01\n\
         [pose]\ntranslation_m = [0.001, 0.0, 0.002]\nrotation_deg = [0.0, 90.0, 0.0]\n\
         [contact]\nmodel = \"soft_finger\"\n[friction]\nlimit = \"soft_finger\"\nstatic_coefficient = 0.5\n\
         torque_arm_m = 0.003\n"
    );
    let scene = Scene::from_text(&text).unwrap();
    let (mut double, mut single) = (scene.pipeline(), scene.pipeline_in::<f32>().unwrap());
    macro_rules! check {
        ($t:ty, $pipeline:ident) => {
            let number = |x: f64| x as $t;
            let turn = Vector3::new(0.0, 90.0_f64.to_radians(), 0.0).map(number);
            let at = Vector3::new(0.001, 0.0, 0.002).map(number);
            let pose: RigidTransform<$t> = RigidTransform::from_axis_angle(turn, at).unwrap();
            // About its own axis where the pose puts it, at no cost.
            let (centre, axis) = (pose.transform_point(&Vector3::zeros()), pose.rotate(&Vector3::z()));
            let capsule = Capsule::new(centre, axis, number(0.008), number(0.01)).unwrap();
            let mut typed = Fingertip::builder()
                .contact(capsule, SoftFinger::new(0.0).unwrap())
                .friction(SoftFingerLimit::new(number(0.5), number(0.003)).unwrap())
                .build();
            let mut last = None;
            for push in pushes(4, 2000) {
                let push = fingertip::wrench::Wrench::on_fingertip(
                    push.force().map(number),
                    push.torque().map(number),
                );
                let felt = $pipeline.sense(push, number(1e-3));
                let touch = typed.sense_wrench(push, Step::of(number(1e-3)).with_last(last));
                last = touch.point();
                assert_eq!(felt.touch.resolution, touch.resolution);
                assert_eq!((felt.touch.force, felt.margin()), (touch.force, touch.grip));
            }
        };
    }
    check!(f64, double);
    check!(f32, single);
}

/// A shape about an axis stands where its pose puts it, and is what [`Posed`] makes of it: a line meets both at the same
/// places, with the same normals.
#[test]
fn shapes_about_an_axis_stand_where_their_pose_puts_them() {
    let shapes = [
        "shape = \"plane\"\npoint_m = [0.001, 0.0, 0.002]\nnormal = [0.0, 0.6, 0.8]\n",
        "shape = \"disk\"\nradius_m = 0.01\nnormal = [0.0, 0.6, 0.8]\n",
        "shape = \"sphere\"\nradius_m = 0.013\npole = [0.0, 1.0, 0.0]\nactive_half_angle_deg = 70.0\n",
        "shape = \"cylinder\"\nradius_m = 0.007\nhalf_length_m = 0.01\naxis = [1.0, 0.0, 0.0]\n",
        "shape = \"capped_cylinder\"\nradius_m = 0.007\nhalf_length_m = 0.01\ncentre_m = [0.0, 0.001, 0.0]\n",
        "shape = \"capsule\"\nradius_m = 0.007\nhalf_length_m = 0.01\n",
        "shape = \"cone\"\nhalf_angle_deg = 31.0\ndepth_m = 0.02\napex_m = [0.0, 0.001, 0.0]\n",
        "shape = \"frustum\"\nheight_m = 0.01\nbase_radius_m = 0.008\ntop_radius_m = 0.005\n",
    ];
    let turn = Vector3::new(10.0, 70.0, -30.0).map(f64::to_radians);
    let pose = RigidTransform::from_axis_angle(turn, Vector3::new(0.001, -0.002, 0.003)).unwrap();
    for shape in shapes {
        let here = format!("{HEAD}[surface]\n{shape}");
        let there = format!(
            "{here}[pose]\ntranslation_m = [0.001, -0.002, 0.003]\nrotation_deg = [10.0, 70.0, -30.0]\n"
        );
        let [here, there] = [here, there].map(|text| Scene::from_text(&text).unwrap());
        assert!(!matches!(there.surface(), DynSurface::Posed(_)), "{shape}");
        let posed = Posed::new(here.surface().clone(), pose);
        let mut met = 0;
        for push in pushes(7, 500) {
            let line = Line { point: push.torque(), direction: push.force().normalize() };
            let crossings = |surface: &dyn Fn(&mut dyn FnMut(_))| {
                let mut found = Vec::new();
                surface(&mut |crossing| found.push(crossing));
                found
            };
            let ours = crossings(&|visit| there.surface().crossings(&line, visit));
            let theirs = crossings(&|visit| posed.crossings(&line, visit));
            assert_eq!(ours.len(), theirs.len(), "{shape} {line:?}");
            // Where the line meets it, and by more than rounding makes of a tangent.
            for (a, b) in ours.iter().zip(&theirs).filter(|(a, _)| a.along.abs() < 1.0) {
                let flat = a.normal.dot(&line.direction).powi(2);
                assert!((a.point - b.point).amax() * flat < 1e-15, "{shape} {a:?} {b:?}");
                assert!((a.normal - b.normal).amax() * flat < 1e-12, "{shape} {a:?} {b:?}");
                assert_eq!(a.active, b.active, "{shape} {a:?} {b:?}");
                met += 1;
            }
        }
        assert!(met > 100, "{shape}: {met}");
    }
}

/// Columns of wrenches give what one wrench after another gives, whatever the stages; where these are vectors, to
/// rounding.
#[test]
fn columns_are_one_sample_after_another() {
    use fingertip::Touches;
    use fingertip::friction::SlipVerdict;

    let point = "[contact]\nleast_force_N = 0.1\n[friction]\nstatic_coefficient = 0.5\n";
    let soft =
        "[contact]\nmodel = \"soft_finger\"\nleast_force_N = 0.1\n[friction]\nstatic_coefficient = 0.5\n";
    let elliptic = soft.replace(
        "static_coefficient = 0.5",
        "limit = \"soft_finger\"\nstatic_coefficient = 0.5\ntorque_arm_m = 0.002",
    );
    let threshold = "[slip]\ndetector = \"threshold\"\nnoise_N = 0.01\n";
    let of = |shape: &str| format!("[surface]\nshape = {shape}\n");
    for (text, exact) in [
        (format!("{HEAD}{BALL}{point}{threshold}"), false),
        (
            format!("{HEAD}{}{point}{threshold}", of("\"ellipsoid\"\nsemi_axes_m = [0.011, 0.012, 0.013]")),
            false,
        ),
        (
            format!(
                "{HEAD}{}{point}{threshold}",
                of("\"cylinder\"\nradius_m = 0.01\naxis = [1.0, 0.0, 0.0]")
            ),
            false,
        ),
        (
            format!("{HEAD}{}{point}{threshold}", of("\"capsule\"\nradius_m = 0.01\nhalf_length_m = 0.01")),
            false,
        ),
        (format!("{HEAD}{}{point}{threshold}", of("\"plane\"\npoint_m = [0.0, 0.0, 0.01]")), false),
        // Bounded surfaces, other models, limits and detectors, and a filter: one by one.
        (format!("{HEAD}{BALL}active_half_angle_deg = 20.0\n{point}{threshold}"), true),
        (
            format!(
                "{HEAD}{}{point}{threshold}",
                of("\"cylinder\"\nradius_m = 0.01\naxis = [1.0, 0.0, 0.0]\nhalf_length_m = 0.001")
            ),
            true,
        ),
        (format!("{HEAD}{BALL}{point}[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n"), true),
        (format!("{HEAD}{BALL}[contact]\nmodel = \"soft_finger\"\nleast_force_N = 0.1\n"), true),
        // Soft fingers, whose contacts are found in columns.
        (format!("{HEAD}{BALL}{soft}{threshold}"), true),
        (format!("{HEAD}{}{soft}{threshold}", of("\"ellipsoid\"\nsemi_axes_m = [0.012, 0.01, 0.015]")), true),
        (format!("{HEAD}{}{soft}", of("\"capsule\"\nradius_m = 0.01\nhalf_length_m = 0.01")), true),
        (format!("{HEAD}{}{soft}{threshold}", of("\"plane\"\npoint_m = [0.0, 0.0, 0.01]")), true),
        (
            format!(
                "{HEAD}{}{elliptic}",
                of("\"cylinder\"\nradius_m = 0.01\naxis = [1.0, 0.0, 0.0]\nhalf_length_m = 0.004")
            ),
            true,
        ),
        (
            format!(
                "{HEAD}{}{soft}{threshold}",
                of("\"elliptic_cylinder\"\nsemi_axes_m = [0.01, 0.008]\nends_m = { capped = 0.01 }")
            ),
            true,
        ),
        (
            format!(
                "{HEAD}{}{soft}[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n",
                of("\"capsule\"\nradius_m = 0.01\nhalf_length_m = 0.01")
            ),
            true,
        ),
        (format!("{HEAD}[filter]\nkind = \"low_pass\"\ncutoff_Hz = 80.0\n{BALL}{point}{threshold}"), true),
        (
            format!(
                "{HEAD}{BALL}{point}{threshold}[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 1e-4\n"
            ),
            false,
        ),
    ] {
        let scene = Scene::from_text(&text).unwrap();
        let samples: Vec<_> = pushes(8, 1500).collect();
        let columns: Vec<Vec<f64>> =
            (0..6).map(|axis| samples.iter().map(|push| push.components()[axis]).collect()).collect();
        let mut found = vec![vec![f64::NAN; 1600]; 9];
        let mut slip = vec![SlipVerdict::Slipping; 1600];
        let [x, y, z, normal, sx, sy, sz, margin, used] = &mut found[..] else { unreachable!() };
        let touches = Touches {
            point: [x, y, z],
            normal_force: normal,
            tangential_force: [sx, sy, sz],
            margin,
            utilisation: used,
            slip: &mut slip,
        };
        let (mut together, mut alone) = (scene.pipeline(), scene.pipeline());
        together.sense_all(core::array::from_fn(|axis| &columns[axis][..]), 1e-3, touches);
        let (mut pressed, mut same) = (0, true);
        for (k, push) in samples.iter().enumerate() {
            let felt = alone.sense(*push, 1e-3);
            let force = felt.force();
            let (at, normal) =
                (felt.touch.point().unwrap_or_default(), force.map_or(0.0, |force| force.normal));
            let tangential = force.map_or_else(Vector3::zeros, |force| force.tangential.vector());
            let margin = felt.margin();
            let expected = [
                at.x,
                at.y,
                at.z,
                normal,
                tangential.x,
                tangential.y,
                tangential.z,
                margin.map_or(0.0, |margin| margin.newtons),
                margin.map_or(0.0, |margin| margin.utilisation),
            ];
            for (column, expected) in found.iter().zip(expected) {
                let error = (column[k] - expected).abs();
                assert!(
                    error <= if exact { 0.0 } else { 1e-10 },
                    "sample {k}: {} for {expected}\n{text}",
                    column[k]
                );
                same &= error == 0.0;
            }
            assert_eq!(slip[k], felt.touch.slip.unwrap_or(SlipVerdict::NotPressing), "sample {k}\n{text}");
            pressed += usize::from(felt.contact().is_some());
        }
        assert!(pressed > 200, "{pressed}\n{text}");
        // Vectors round otherwise, but on a plane: where they are meant to be taken they were.
        assert!(exact || !same || text.contains("plane"), "{text}");
        // What comes next finds both as they are behind the last sample.
        assert_eq!(together, alone, "{text}");
        assert!(found.iter().all(|column| column[1500..].iter().all(|x| x.is_nan())));
        // What the last one says stays, and the next goes on from there.
        let next = samples[3];
        assert_eq!(together.sense(next, 1e-3), alone.sense(next, 1e-3), "{text}");
    }
}

/// A hand of a typed finger and one from a scene: each answers as it does alone, keeps its last contact or is told
/// it, and starts anew.
#[test]
fn fingers_of_both_kinds_in_one_hand() {
    let (mut from_scene, mut typed) = ball();
    let mut alone = typed;
    let mut hand: [&mut dyn TouchSensor<f64>; 2] = [&mut from_scene, &mut typed];
    let mut last = [None; 3];
    for push in pushes(6, 3000) {
        let once = alone.sense_wrench(push, Step::of(1e-3).with_last(last[2]));
        last[2] = once.point();
        for (finger, last) in hand.iter_mut().zip(&mut last) {
            let touch = finger.feel(push, Step::of(1e-3).with_last(*last));
            *last = touch.point();
            assert_eq!(
                (touch.wrench, touch.resolution, touch.force),
                (once.wrench, once.resolution, once.force)
            );
            assert_eq!((touch.grip.flatten(), touch.slip), (once.grip, Some(once.slip)));
        }
    }
    let fresh = Present(DropDetector::new(ForceNoise::isotropic(0.01).unwrap()).unwrap());
    let push = Wrench::on_fingertip(Vector3::new(-1.0, 0.0, 0.2), Vector3::zeros());
    alone.sense_wrench(push, 1e-3);
    assert_ne!(*alone.detector(), fresh);
    TouchSensor::<f64>::start_anew(&mut alone);
    assert_eq!(*alone.detector(), fresh);
    // What a step says of the last contact rules: on a ring it chooses the side.
    let ring = "[surface]\nshape = \"torus\"\nring_radius_m = 0.01\ntube_radius_m = 0.003\n";
    let mut ring = Scene::from_text(&format!("{HEAD}{ring}")).unwrap().pipeline();
    let push = Wrench::on_fingertip(Vector3::new(-1.0, 0.0, 0.0), Vector3::zeros());
    let mut at = |last: Option<f64>| {
        let last = last.map(|x| Vector3::new(x, 0.0, 0.0));
        ring.feel(push, Step::of(1e-3).with_last(last)).point().unwrap().x
    };
    assert!((at(None) - 0.013).abs() < 1e-12 && (at(Some(-0.007)) + 0.007).abs() < 1e-12);
    assert!((at(None) + 0.007).abs() < 1e-12, "its own last contact");
    TouchSensor::start_anew(&mut ring);
    assert!((ring.feel(push, Step::of(1e-3)).point().unwrap().x - 0.013).abs() < 1e-12);
}
