//! What hangs on the sensor: found from poses, taken off by `analyze` and `check`.

use nalgebra::{Rotation3, Vector3};

use crate::common::{Contacts, Folder};

const BIAS: [f64; 6] = [1.0, -2.0, 0.5, 0.01, 0.02, -0.03];

fn turn(i: usize) -> Rotation3<f64> {
    let i = i as f64;
    Rotation3::from_scaled_axis(Vector3::new((1.3 * i).sin(), (2.1 * i).cos(), (0.7 * i).sin()) * 2.0)
}

/// A row of quaternion and wrench: 0.3 kg at (2, 1, 30) mm, the bias, and a force at a point.
fn row(turn: &Rotation3<f64>, mount: &Rotation3<f64>, touch: Option<(Vector3<f64>, Vector3<f64>)>) -> String {
    let pull = mount * (turn.inverse() * Vector3::new(0.0, 0.0, -0.3 * 9.80665));
    let mut force = pull;
    let mut torque = Vector3::new(0.002, 0.001, 0.03).cross(&pull);
    if let Some((point, push)) = touch {
        force += push;
        torque += point.cross(&push);
    }
    let q = nalgebra::UnitQuaternion::from_rotation_matrix(turn);
    let wrench: Vec<String> =
        force.iter().chain(torque.iter()).zip(BIAS).map(|(x, bias)| (x + bias).to_string()).collect();
    format!("{},{},{},{},{}\n", q.i, q.j, q.k, q.w, wrench.join(","))
}

const HEADER: &str = "qx,qy,qz,qw,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n";
const SCENE: &str = "version = 1\n[input]\nconvention = \"on_fingertip\"\nsample_rate_Hz = 100.0\n\
                     [surface]\nshape = \"sphere\"\nradius_m = 0.01\n[contact]\nleast_force_N = 0.05\n";

pub(crate) fn poses(mount: &Rotation3<f64>) -> String {
    (0..10).fold(HEADER.to_owned(), |text, i| text + &row(&turn(i), mount, None))
}

#[test]
fn weight_is_found_and_taken_off() {
    let folder = Folder::new();
    let mount = Rotation3::identity();
    folder.write("poses.csv", &poses(&mount));
    folder.succeed(&["calibrate", "--gravity", "poses.csv", "-o", "tip.toml"]);
    // The hand turns; every third row touches the top of the sphere with 1 N.
    let mut text = HEADER.to_owned();
    for i in 0..30 {
        let touch = (Vector3::new(0.0, 0.0, 0.01), Vector3::new(0.1, 0.0, -1.0));
        text += &row(&turn(i), &mount, (i % 3 == 0).then_some(touch));
    }
    folder.write("hand.csv", &text);
    folder.write("scene.toml", SCENE);
    let analyze = ["analyze", "hand.csv", "--scene", "scene.toml", "--no-report", "--payload", "tip.toml"];
    folder.succeed(&analyze);
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    for (i, status) in contacts.words("status").iter().enumerate() {
        assert_eq!(*status, if i % 3 == 0 { "contact" } else { "below_threshold" }, "row {i}");
    }
    assert!((contacts.numbers("normal_N")[3] - 1.0).abs() < 1e-5);
    assert!((contacts.numbers("z_m")[3] - 0.01).abs() < 1e-6);
    // A scene that names it says the same.
    let by_option = folder.read("contacts.csv");
    folder.write("carrying.toml", &format!("{SCENE}[payload]\nfile = \"tip.toml\"\n"));
    folder.succeed(&["analyze", "hand.csv", "--scene", "carrying.toml", "--no-report"]);
    assert_eq!(folder.read("contacts.csv"), by_option);
    // With a tare at rest, in the orientation that the hand has then.
    let mut resting = HEADER.to_owned();
    // Not two rows are quite the same: that would be a sensor that hangs.
    let still = |i: usize| turn(4) * Rotation3::from_scaled_axis(Vector3::x() * 1e-6 * i as f64);
    (0..50).for_each(|i| resting += &row(&still(i), &mount, None));
    resting += text.strip_prefix(HEADER).unwrap();
    folder.write("hand.csv", &resting);
    folder.write("scene.toml", &SCENE.replace("[surface]", "rest_s = 0.495\n[surface]"));
    folder.succeed(&analyze);
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    let status = contacts.words("status");
    assert!(status[..50].iter().all(|word| *word == "rest"), "{status:?}");
    assert_eq!((status[50], status[51], status[53]), ("contact", "below_threshold", "contact"));
    // A recording without orientation cannot be rid of its weight.
    folder.write("bare.csv", &text.replace("qw", "w"));
    let error = folder.fail(1, &["analyze", "bare.csv", "--scene", "scene.toml", "--payload", "tip.toml"]);
    assert!(error.contains("bare.csv") && error.contains("qx, qy, qz, qw"), "{error}");
    folder.write("tip.toml", &folder.read("tip.toml").replacen("mass_kg = 0.", "mass_kg = 1.", 1));
    let error = folder.fail(1, &analyze);
    assert!(error.contains("tip.toml") && error.contains("checksum"), "{error}");
}

#[test]
fn mounting_and_sign_are_found() {
    let folder = Folder::new();
    let mount = Rotation3::from_scaled_axis(Vector3::new(0.0, 0.0, 0.5));
    folder.write("poses.csv", &poses(&mount));
    let said = folder.succeed(&["calibrate", "--gravity", "poses.csv", "--fit-mounting"]);
    assert!(said.contains("28.6") && said.contains("mass 0.30000 kg"), "{said}");
    assert!(folder.read("payload.toml").contains("sensor_from_flange = [\n    [0.877"));
    folder.write("reaction.csv", &poses(&mount));
    let error = folder.fail(1, &["calibrate", "--gravity", "poses.csv", "--fit-mounting", "--reaction"]);
    assert!(error.contains("reaction") && error.contains("poses.csv"), "{error}");
    folder.fail(2, &["calibrate", "--gravity", "poses.csv", "--html", "r.html"]);
}

/// Turns by 150° and their inverses are like each other, so that quaternions that are the wrong way round leave much, but
/// tell a weight.
#[test]
fn frames_that_fit_better_are_named() {
    let folder = Folder::new();
    let turns = || (0..12).map(|i| Rotation3::from_axis_angle(&turn(i).axis().unwrap(), 2.6));
    let right: Vec<String> = turns().map(|turn| row(&turn, &Rotation3::identity(), None)).collect();
    // The quaternion of the inverse.
    let wrong: Vec<String> = turns()
        .zip(&right)
        .map(|(turn, row)| {
            let q = nalgebra::UnitQuaternion::from_rotation_matrix(&turn.inverse());
            let wrench = row.splitn(5, ',').last().unwrap();
            format!("{},{},{},{},{wrench}", q.i, q.j, q.k, q.w)
        })
        .collect();
    let mend = "the frames seem to be readings in the axes of the sensor and quaternions from the base to the sensor: turn the \
                quaternions round (the signs of qx, qy, qz)";
    let said = |rows: &[String]| {
        folder.write("poses.csv", &format!("{HEADER}{}", rows.concat()));
        folder.succeed(&["calibrate", "--gravity", "poses.csv"])
    };
    let left = |said: &str| -> Vec<f64> {
        let line = said.lines().find(|line| line.starts_with("frames ")).unwrap_or_else(|| panic!("{said}"));
        line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
    };
    let (right, wrong) = (said(&right), said(&wrong));
    assert!(right.contains("Payload: GOOD") && !right.contains("the frames seem"), "{right}");
    assert!(wrong.contains("Payload: BAD") && wrong.contains(mend), "{wrong}");
    let (stated, otherwise) = (left(&right), left(&wrong));
    assert!(
        stated[0] < 1e-3 && stated[1] > 1.0 && otherwise[0] > 1.0 && otherwise[1] < 1e-3,
        "{right}{wrong}"
    );
}

/// Readings under known loads of a sensor that also carries the body of the poses, in changing orientations.
fn turned(loads: impl IntoIterator<Item = [f64; 6]>) -> String {
    let mut text =
        String::from("fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V,qx,qy,qz,qw\n");
    for (i, known) in loads.into_iter().enumerate() {
        let turn = turn(i);
        let pull = turn.inverse() * Vector3::new(0.0, 0.0, -0.3 * 9.80665);
        let torque = Vector3::new(0.002, 0.001, 0.03).cross(&pull);
        let carried = [pull.x, pull.y, pull.z, torque.x, torque.y, torque.z];
        let share = |j: usize| (known[j] + carried[j]) / if j < 3 { 10.0 } else { 0.1 };
        let volts: Vec<String> =
            (0..6).map(|j| (0.1 + 2.0 * share(j) + 0.2 * share((j + 1) % 6)).to_string()).collect();
        let q = nalgebra::UnitQuaternion::from_rotation_matrix(&turn);
        let known = known.map(|x| x.to_string()).join(",");
        text += &format!("{known},{},{},{},{},{}\n", volts.join(","), q.i, q.j, q.k, q.w);
    }
    text
}

/// Known loads on a sensor that also carries a body, in changing orientations.
#[test]
fn check_adds_the_weight_to_the_loads() {
    let folder = Folder::new();
    folder.write("poses.csv", &poses(&Rotation3::identity()));
    folder.succeed(&["calibrate", "--gravity", "poses.csv"]);
    folder.write("bare.csv", &super::loads(1.0));
    folder.succeed(&["calibrate", "bare.csv", "--full-scale", "10,10,10,0.1,0.1,0.1", "-o", "cal.toml"]);
    let loads = (0..12).map(|i| [0.0, 0.0, if i % 2 == 0 { 5.0 } else { 0.0 }, 0.0, 0.0, 0.0]);
    folder.write("turned.csv", &turned(loads));
    folder.fail(1, &["check", "cal.toml", "turned.csv"]);
    let said = folder.succeed(&["check", "cal.toml", "turned.csv", "--payload", "payload.toml"]);
    assert!(said.contains("GOOD") && said.contains("Contact points on a sphere of 10 mm"), "{said}");
    let error = folder.fail(1, &["check", "cal.toml", "bare.csv", "--payload", "payload.toml"]);
    assert!(error.contains("qx, qy, qz, qw"), "{error}");
}

/// Each component loaded both ways, the body on the sensor all the while.
#[test]
fn a_calibration_adds_the_weight_to_the_loads() {
    let folder = Folder::new();
    folder.write("poses.csv", &poses(&Rotation3::identity()));
    folder.succeed(&["calibrate", "--gravity", "poses.csv"]);
    let loads = (0..36).map(|i| {
        let mut known = [0.0; 6];
        known[i % 6] = [5.0, -5.0, 0.0][i / 6 % 3] * if i % 6 < 3 { 1.0 } else { 0.01 };
        known
    });
    folder.write("turned.csv", &turned(loads));
    folder.write("bare.csv", &super::loads(1.0));
    let calibrate = ["calibrate", "turned.csv", "--full-scale", "10,10,10,0.1,0.1,0.1", "-o", "cal.toml"];
    folder.succeed(&[&calibrate[..], &["--payload", "payload.toml"]].concat());
    let said = folder.succeed(&["check", "cal.toml", "bare.csv"]);
    assert!(said.contains("GOOD"), "{said}");
    // Without its weight they contradict each other.
    let error = folder.fail(1, &[&calibrate[..], &["--overwrite"]].concat());
    assert!(error.contains("the calibration cal.toml is bad"), "{error}");
}
