//! Wrench and tactile array together, from a scene.

use fingertip::contact::{ArrayContact, Fusion};
use fingertip::wrench::Wrench;
use fingertip_scene::{ArrayReading, FusedTouch, NoFusion, Scene};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::{BALL, HEAD, NOISE};

const FUSION: &str =
    "[fusion]\nposition_deviation_m = 0.0005\nnormal_deviation_N = 0.05\nrelative_deviation = 0.1\n";

fn scene(text: &str) -> Scene {
    Scene::from_text(&format!("{HEAD}{BALL}{text}")).unwrap()
}

fn outward(random: &mut Pcg64Mcg) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)).normalize()
}

/// Pushes at one to four places, each within a friction of 0.5, and what an array with errors reads of them.
fn pressed(random: &mut Pcg64Mcg, places: usize) -> (Vec<Vector3<f64>>, Wrench<f64>, Vec<ArrayReading<f64>>) {
    let (mut forces, mut sum, mut readings) = (Vec::new(), Vector6::zeros(), Vec::new());
    for _ in 0..places {
        let normal = outward(random);
        let aside = outward(random);
        let strength = random.random_range(0.5..3.0);
        let across = aside - normal * aside.dot(&normal);
        let force = (across * 0.4 - normal) * strength;
        let (at, off) = (normal * 0.013, outward(random) * 0.0003);
        let push: Wrench<f64> = Wrench::from_force_at(&at, force);
        sum += push.components();
        readings.push(ArrayReading {
            centroid: at + off,
            normal_force: strength * random.random_range(0.95..1.05),
        });
        forces.push(force);
    }
    (forces, Wrench::from_components(&sum), readings)
}

#[test]
fn a_scene_fuses_as_the_library_does_and_finds_the_forces() {
    let mut pipeline =
        scene(&format!("{NOISE}relative = 0.01\n{FUSION}static_coefficient = 0.5\nplaces = 4\n")).pipeline();
    assert_eq!(pipeline.array_places(), Some(4));
    let mut random = Pcg64Mcg::seed_from_u64(11);
    for round in 0..60_usize {
        let places = 1 + round % 4;
        let (forces, wrench, readings) = pressed(&mut random, places);
        pipeline.sense(wrench, 1e-3);
        let fused = pipeline.fuse(&readings).unwrap();
        let floor = Vector6::new(0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4);
        let load = wrench.components() * 0.01;
        let covariance = Matrix6::from_diagonal(&(floor.component_mul(&floor) + load.component_mul(&load)));
        let contact = |reading: &ArrayReading<f64>| ArrayContact {
            centroid: reading.centroid,
            centroid_covariance: Matrix3::identity() * 0.0005_f64.powi(2),
            normal_force: reading.normal_force,
            normal_deviation: (0.05_f64.powi(2) + (0.1 * reading.normal_force).powi(2)).sqrt(),
        };
        let fusion = Fusion::new(covariance, 0.5).unwrap();
        let same = |fused: &FusedTouch<f64>, points: Vec<(Vector3<f64>, Vector3<f64>)>, chi: f64| {
            for (contact, (point, force)) in fused.contacts.iter().flatten().zip(&points) {
                assert!((contact.point - point).norm() < 1e-9 && (contact.force - force).norm() < 1e-6);
            }
            assert_eq!(fused.contacts.iter().flatten().count(), points.len());
            assert!((fused.disagreement - chi).abs() <= 1e-6 * chi.abs().max(1.0));
        };
        macro_rules! by_hand {
            ($k:literal) => {{
                let array: [ArrayContact<f64>; $k] = core::array::from_fn(|i| contact(&readings[i]));
                let direct = fusion.estimate(pipeline.surface(), &wrench, &array).unwrap();
                let points = direct.contacts.iter().map(|c| (c.point, c.force)).collect();
                same(&fused, points, direct.disagreement);
            }};
        }
        match places {
            1 => by_hand!(1),
            2 => by_hand!(2),
            3 => by_hand!(3),
            _ => by_hand!(4),
        }
        // What was done: one contact is told to a percent or two, of several the sum is.
        let told: Vector3<f64> = fused.contacts.iter().flatten().map(|contact| contact.force).sum();
        assert!(
            (told - wrench.force()).norm() < 0.1 * (1.0 + wrench.force().norm()),
            "{told} for {}",
            wrench.force()
        );
        if places == 1 {
            assert!((fused.contacts[0].unwrap().force - forces[0]).norm() < 0.1, "{fused:?}");
        }
        let text = serde_json::to_string(&fused).unwrap();
        assert_eq!(serde_json::from_str::<FusedTouch<f64>>(&text).unwrap(), fused);
    }
}

/// The coefficient of `[friction]` serves where none is stated; a scene in single precision says the same.
#[test]
fn friction_and_precision_are_those_of_the_scene() {
    let own = scene(&format!("{NOISE}{FUSION}static_coefficient = 0.3\n"));
    let shared = scene(&format!("{NOISE}{FUSION}[friction]\nstatic_coefficient = 0.3\n"));
    let other = scene(&format!("{NOISE}{FUSION}[friction]\nstatic_coefficient = 0.9\n"));
    let (_, wrench, readings) = pressed(&mut Pcg64Mcg::seed_from_u64(3), 2);
    let fused = |scene: &Scene| {
        let mut pipeline = scene.pipeline();
        pipeline.sense(wrench, 1e-3);
        pipeline.fuse(&readings).unwrap()
    };
    assert_eq!(fused(&own), fused(&shared));
    assert_ne!(fused(&own), fused(&other));
    let mut single = own.pipeline_in::<f32>().unwrap();
    single.sense(
        Wrench::on_fingertip(wrench.force().map(|x| x as f32), wrench.torque().map(|x| x as f32)),
        1e-3,
    );
    let narrow = |reading: &ArrayReading<f64>| ArrayReading {
        centroid: reading.centroid.map(|x| x as f32),
        normal_force: reading.normal_force as f32,
    };
    let readings: Vec<ArrayReading<f32>> = readings.iter().map(narrow).collect();
    let narrow = single.fuse(&readings).unwrap();
    for (wide, narrow) in fused(&own).contacts.iter().flatten().zip(narrow.contacts.iter().flatten()) {
        assert!((wide.force - narrow.force.map(f64::from)).norm() < 1e-2, "{wide:?} {narrow:?}");
    }
    // As JSON it is the scene that it was.
    let json: toml::Value = serde_json::from_str(&own.to_json().unwrap()).unwrap();
    assert_eq!(fused(&Scene::from_text(&toml::to_string(&json).unwrap()).unwrap()), fused(&own));
}

#[test]
fn what_cannot_be_fused_is_said() {
    let mut pipeline = scene(&format!("{NOISE}{FUSION}static_coefficient = 0.5\n")).pipeline();
    let reading = ArrayReading { centroid: Vector3::new(0.0, 0.0, 0.013), normal_force: 1.0 };
    pipeline.sense(Wrench::from_force_at(&reading.centroid, Vector3::new(0.0, 0.0, -1.0)), 1e-3);
    assert_eq!(pipeline.fuse(&[]), Err(NoFusion::Readings(0)));
    assert_eq!(pipeline.fuse(&[reading; 5]), Err(NoFusion::Readings(5)));
    let none = ArrayReading { normal_force: f64::NAN, ..reading };
    assert!(matches!(pipeline.fuse(&[none]), Err(NoFusion::Reading(_))));
    assert_eq!(scene(NOISE).pipeline().fuse(&[reading]), Err(NoFusion::NoSection));
    let waits = Scene::from_text(&format!(
        "{HEAD}rest_s = 1.0\n{BALL}[uncertainty]\n{FUSION}static_coefficient = 0.5\n"
    ));
    assert_eq!(waits.unwrap().pipeline().fuse(&[reading]), Err(NoFusion::AwaitsNoise));
    for (text, words) in [
        (format!("{FUSION}static_coefficient = 0.5\n"), "the section [uncertainty]"),
        (format!("{NOISE}{FUSION}"), "`static_coefficient`, or the section [friction]"),
        (format!("{NOISE}{FUSION}places = 5\nstatic_coefficient = 0.5\n"), "`places` of [fusion] must be"),
        (format!("{NOISE}{FUSION}static_coefficient = 0.0\n"), "`static_coefficient` of [fusion] must be"),
        (
            format!("{NOISE}{FUSION}static_coefficient = 0.5\n").replace("= 0.05", "= 0.0"),
            "`normal_deviation_N` of [fusion] must be",
        ),
        (
            format!("{NOISE}{FUSION}static_coefficient = 0.5\n").replace("= 0.0005", "= -0.0005"),
            "`position_deviation_m` of [fusion] must be",
        ),
        (
            format!("{NOISE}{FUSION}static_coefficient = 0.5\n").replace("= 0.1", "= -0.1"),
            "`relative_deviation` of [fusion] must be",
        ),
        (
            format!("{NOISE}{FUSION}static_coefficient = 0.5\n").replace("= 0.1", "= nan"),
            "`relative_deviation` of [fusion] must be",
        ),
        (
            format!("{NOISE}{FUSION}static_coefficient = 0.5\n")
                .replace("force_noise_N = 0.01", "force_noise_N = 0.0"),
            "`force_noise_N` of [uncertainty] must be",
        ),
    ] {
        let error = Scene::from_text(&format!("{HEAD}{BALL}{text}")).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

/// An array that errs nowhere in place, and by the same at every force, is one as well.
#[test]
fn an_array_may_have_no_deviation_but_in_force() {
    let exact = FUSION.replace("= 0.0005", "= 0.0").replace("= 0.1", "= 0.0");
    let mut pipeline = scene(&format!("{NOISE}{exact}static_coefficient = 0.5\n")).pipeline();
    let reading = ArrayReading { centroid: Vector3::new(0.0, 0.0, 0.013), normal_force: 1.0 };
    pipeline.sense(Wrench::from_force_at(&reading.centroid, Vector3::new(0.0, 0.0, -1.0)), 1e-3);
    let fused = pipeline.fuse(&[reading]).unwrap();
    assert!((fused.contacts[0].unwrap().force - Vector3::new(0.0, 0.0, -1.0)).norm() < 1e-3, "{fused:?}");
}
