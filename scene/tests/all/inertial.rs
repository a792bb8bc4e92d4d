//! `[inertial_unit]`: the load of a payload in motion, taken off by the readings of an accelerometer and a gyroscope.

use std::fs;

use fingertip::wrench::{InertialReading, Wrench};
use fingertip_calibration::file::{InertialUnitFile, PayloadFile};
use fingertip_scene::{NoWrench, Scene};
use fingertip_test_support::MovingBody;
use nalgebra::{Vector3, Vector6};

use crate::front::Folder;
use crate::{BALL, HEAD};

/// The section `[payload]` of the swung body.
fn payload(body: &MovingBody) -> String {
    let (mass, centre, inertia) = body.mass_properties();
    let rows: [[f64; 3]; 3] = core::array::from_fn(|i| core::array::from_fn(|j| inertia[(i, j)]));
    format!(
        "[payload]\nmass_kg = {mass:?}\ncentre_of_mass_m = {:?}\ninertia_kg_m2 = {rows:?}\n",
        <[f64; 3]>::from(centre)
    )
}

fn reading(body: &MovingBody, time: f64) -> InertialReading<f64> {
    let moved = body.at(time);
    InertialReading { acceleration: moved.acceleration, angular_velocity: moved.angular_velocity }
}

/// What is left of force \[N\] and torque \[N·m\], at most, of a push that stays, if the readings come so much later.
fn left(scene: &Scene, delay: f64) -> (f64, f64) {
    let body = MovingBody::swung();
    let push = Vector6::new(0.3, -0.2, -2.0, 0.0, 0.01, 0.0);
    let mut pipeline = scene.pipeline();
    let mut most = (0.0_f64, 0.0_f64);
    for k in 0..1200 {
        let time = 1e-3 * f64::from(k);
        let wrench = Wrench::from_components(&(body.at(time).wrench + push));
        let felt = pipeline.sense_inertial(wrench, &reading(&body, time - delay), 1e-3).unwrap();
        if time > 0.2 {
            let off = felt.touch.wrench.components() - push;
            most.0 = most.0.max(off.fixed_rows::<3>(0).norm());
            most.1 = most.1.max(off.fixed_rows::<3>(3).norm());
        }
    }
    most
}

#[test]
fn a_push_is_felt_through_a_motion() {
    let body = MovingBody::swung();
    let unit = |keys: &str| {
        let at = <[f64; 3]>::from(body.unit);
        let text = format!("{HEAD}{}[inertial_unit]\nposition_m = {at:?}\n{keys}{BALL}", payload(&body));
        Scene::from_text(&text).unwrap()
    };
    let (force, torque) = left(&unit("time_constant_s = 0.004\n"), 0.0);
    assert!(force < 1e-3 && torque < 1e-4, "{force} {torque}");
    for delay in [0.012, -0.0075] {
        let told = unit(&format!("time_constant_s = 0.004\ndelay_s = {delay}\n"));
        let (force, torque) = left(&told, delay);
        // Half a sample off, a straight line stands for the curve.
        assert!(force < 4e-3 && torque < 4e-4, "{delay}: {force} {torque}");
        let late = told.carried().unwrap().delay();
        assert!((late - (0.008 + delay.max(0.0))).abs() < 1e-12, "{late}");
        let (untold, _) = left(&unit("time_constant_s = 0.004\n"), delay);
        assert!(untold > 0.3, "{untold}");
    }
    let said = unit("").meaning().join("\n");
    assert!(said.contains("inertial_unit") && said.contains("20.0 ms late"), "{said}");
}

/// All that the payload's file has need not be said again, and what the scene says counts.
#[test]
fn the_payloads_file_knows_its_unit() {
    let folder = Folder::new("inertial");
    let body = MovingBody::swung();
    let (mass, centre, inertia) = body.mass_properties();
    let mut file = PayloadFile::new(mass, centre, Vector3::new(0.0, 0.0, -9.806_65)).unwrap();
    file.inertia = core::array::from_fn(|i| core::array::from_fn(|j| inertia[(i, j)]));
    file.inertial_unit = Some(InertialUnitFile {
        position: body.unit.into(),
        sensor_from_unit: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        resting_rate: [0.0; 3],
        time_constant: 0.004,
        delay: 0.01,
    });
    fs::write(folder.path().join("body.toml"), file.to_toml().unwrap()).unwrap();
    let scene = |keys: &str| {
        let text = format!("{HEAD}[payload]\nfile = \"body.toml\"\n[inertial_unit]\n{keys}{BALL}");
        Scene::parse(&text, "scene", folder.path()).unwrap()
    };
    let (force, torque) = left(&scene(""), 0.01);
    assert!(force < 4e-3 && torque < 4e-4, "{force} {torque}");
    let (force, torque) = left(&scene("delay_s = 0.0\n"), 0.0);
    assert!(force < 1e-3 && torque < 1e-4, "{force} {torque}");
    for wrong in [
        "position_m = [0.0, 0.0, 0.0]\n",
        "rotation_deg = [0.0, 0.0, 10.0]\n",
        "resting_rate_rad_per_s = [0.5, 0.0, 0.0]\n",
    ] {
        let (force, _) = left(&scene(&format!("delay_s = 0.0\n{wrong}")), 0.0);
        assert!(force > 0.1, "{wrong}: {force}");
    }
}

#[test]
fn what_an_inertial_unit_needs_is_said() {
    let with = |keys: &str| Scene::from_text(&format!("{HEAD}{keys}{BALL}"));
    let refused = |keys: &str, expected: &str| {
        let error = with(keys).unwrap_err().to_string();
        assert!(error.contains(expected), "{keys}: {error}");
    };
    refused("[inertial_unit]\n", "[payload]");
    let body = "[payload]\nmass_kg = 0.1\n[inertial_unit]\n";
    for (key, expected) in [
        ("time_constant_s = 0.0", "time_constant_s"),
        ("time_constant_s = nan", "time_constant_s"),
        ("delay_s = inf", "delay_s"),
        ("position_m = [0.0, nan, 0.0]", "position_m"),
        ("rotation_deg = [inf, 0.0, 0.0]", "rotation_deg"),
        ("resting_rate_rad_per_s = [nan, 0.0, 0.0]", "resting_rate_rad_per_s"),
    ] {
        refused(&format!("{body}{key}\n"), expected);
    }
    let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
    let resting =
        InertialReading { acceleration: Vector3::new(0.0, 0.0, 9.8), angular_velocity: Vector3::zeros() };
    // Without the section no reading of a unit is taken, and with it none that is no number.
    for none in ["", "[payload]\nmass_kg = 0.1\n"] {
        let mut pipeline = with(none).unwrap().pipeline();
        assert_eq!(pipeline.sense_inertial(push, &resting, 1e-3).err(), Some(NoWrench::NoMotion));
    }
    let mut pipeline = with(body).unwrap().pipeline();
    let bad = InertialReading { acceleration: Vector3::new(0.0, f64::NAN, 9.8), ..resting };
    assert_eq!(pipeline.sense_inertial(push, &bad, 1e-3).err(), Some(NoWrench::Incomplete));
    let felt = pipeline.sense_inertial(push, &resting, 1e-3).unwrap();
    assert!((felt.touch.wrench.force().z + 0.02).abs() < 1e-12, "{:?}", felt.touch.wrench);
    // A zero that was taken with the body on holds its weight.
    let carried = pipeline.carried_mut().unwrap();
    assert!(carried.rest_moving(&resting) && !carried.rest_moving(&bad));
    carried.end_rest();
    pipeline.start_anew();
    let felt = pipeline.sense_inertial(push, &resting, 1e-3).unwrap();
    assert!((felt.touch.wrench.force().z + 1.0).abs() < 1e-12, "{:?}", felt.touch.wrench);
    // In firmware it stands before the pipeline as a stage of its own.
    let error = with(body).unwrap().to_rust(fingertip_scene::Scalar::F32, None).unwrap_err().to_string();
    assert!(error.contains("the section [inertial_unit] has no type"), "{error}");
}

/// What the sensor read before anything was on it goes off, too, unless a zero was taken since.
#[test]
fn the_bias_of_the_payloads_file_goes_off_once() {
    let folder = Folder::new("inertial-bias");
    let mut file = PayloadFile::new(0.1, Vector3::zeros(), Vector3::new(0.0, 0.0, -9.8)).unwrap();
    file.force_bias = [0.5, 0.0, 0.0];
    fs::write(folder.path().join("body.toml"), file.to_toml().unwrap()).unwrap();
    let text = format!("{HEAD}[payload]\nfile = \"body.toml\"\n[inertial_unit]\n{BALL}");
    let mut pipeline = Scene::parse(&text, "scene", folder.path()).unwrap().pipeline();
    let resting =
        InertialReading { acceleration: Vector3::new(0.0, 0.0, 9.8), angular_velocity: Vector3::zeros() };
    let measured = Wrench::on_fingertip(Vector3::new(0.5, 0.0, -2.98), Vector3::zeros());
    let felt = pipeline.sense_inertial(measured, &resting, 1e-3).unwrap();
    assert!((felt.touch.wrench.force() - Vector3::new(0.0, 0.0, -2.0)).norm() < 1e-12, "{felt:?}");
    let carried = pipeline.carried_mut().unwrap();
    assert!(carried.rest_moving(&resting));
    carried.end_rest();
    pipeline.start_anew();
    // The zero holds bias and weight, and is off before.
    let measured = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
    let felt = pipeline.sense_inertial(measured, &resting, 1e-3).unwrap();
    assert!((felt.touch.wrench.force() - Vector3::new(0.0, 0.0, -2.0)).norm() < 1e-12, "{felt:?}");
}

/// Up to half a second lies between two samples of one motion; behind a longer pause the next is the first.
#[test]
fn a_pause_is_no_motion() {
    let body = "mass_kg = 0.1\ninertia_kg_m2 = [[1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0], [0.0, 0.0, 1e-3]]\n";
    let scene = Scene::from_text(&format!("{HEAD}[payload]\n{body}[inertial_unit]\n{BALL}")).unwrap();
    let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
    let turning = |rate: f64| InertialReading {
        acceleration: Vector3::new(0.0, 0.0, 9.8),
        angular_velocity: Vector3::z() * rate,
    };
    let first = scene.pipeline().sense_inertial(push, &turning(30.0), 0.0).unwrap().touch.wrench;
    for (pause, starts) in [(0.5, false), (0.51, true)] {
        let mut pipeline = scene.pipeline();
        for _ in 0..3 {
            pipeline.sense_inertial(push, &turning(0.0), 1e-3).unwrap();
        }
        let found = pipeline.sense_inertial(push, &turning(30.0), pause).unwrap().touch.wrench;
        assert_eq!(found == first, starts, "{found:?} after {pause} s, {first:?} at first");
    }
}
