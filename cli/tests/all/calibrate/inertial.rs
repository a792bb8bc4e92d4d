//! A body that is swung about: found from a motion, taken off by `analyze`.

use fingertip_test_support::MovingBody;
use nalgebra::{Rotation3, Vector3, Vector6};

use crate::common::{Contacts, Folder};

const HEADER: &str =
    "t_ms,fx_N,fy_N,fz_N,tx_Nmm,ty_Nmm,tz_Nmm,ax_g,ay_g,az_g,wx_deg_per_s,wy_deg_per_s,wz_deg_per_s\n";
const BIAS: [f64; 6] = [1.0, -2.0, 0.5, 0.01, 0.02, -0.03];
const RATE: f64 = 500.0;

/// As the inertial unit sits on the sensor.
fn turned() -> Rotation3<f64> {
    Rotation3::from_scaled_axis(Vector3::new(0.0, 0.0, 90.0_f64.to_radians()))
}

/// A motion whose inertial readings come 8 ms late, with a touch on the top of the sphere from so many seconds on.
fn motion(begin: f64, seconds: f64, touch: Option<f64>) -> String {
    let body = MovingBody::swung();
    let mut text = HEADER.to_owned();
    for k in 0..(seconds * RATE) as usize {
        let time = begin + k as f64 / RATE;
        let (load, ride) = (body.at(time), body.at(time - 0.008));
        let mut wrench = load.wrench + Vector6::from(BIAS);
        if touch.is_some_and(|from| k as f64 / RATE >= from) {
            wrench += Vector6::new(0.1, 0.0, -1.0, 0.0, 0.001, 0.0);
        }
        let acceleration = turned().inverse() * ride.acceleration / 9.806_65;
        let turning = (turned().inverse() * ride.angular_velocity).map(f64::to_degrees);
        let scaled = wrench.iter().enumerate().map(|(i, x)| if i < 3 { *x } else { x * 1e3 });
        let cells: Vec<String> =
            scaled.chain(acceleration.iter().chain(turning.iter()).copied()).map(|x| x.to_string()).collect();
        text += &format!("{},{}\n", 1e3 * (time - begin), cells.join(","));
    }
    text
}

const SCENE: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\n\
                     radius_m = 0.01\n[contact]\nleast_force_N = 0.1\n[payload]\nfile = \"payload.toml\"\n\
                     [inertial_unit]\n";

#[test]
fn a_motion_tells_what_is_swung_and_a_touch_is_felt_through_it() {
    let folder = Folder::new();
    folder.write("motion.csv", &motion(0.0, 8.0, None));
    let at = "-0.01,0.02,-0.015";
    let calibrate =
        ["calibrate", "--inertial", "motion.csv", "--unit-position", at, "--unit-rotation", "0,0,90"];
    let said = folder.succeed(&calibrate);
    assert!(said.contains("Payload: GOOD") && said.contains("mass            0.67"), "{said}");
    assert!(said.contains("come +8.0") && said.contains("Written: payload.toml"), "{said}");
    let told = |name: &str| -> Vec<f64> {
        let told = said.lines().find_map(|line| line.strip_prefix(name)).unwrap_or_else(|| panic!("{said}"));
        told.split_whitespace().map_while(|word| word.parse().ok()).collect()
    };
    for (name, truth, allowed) in
        [("force at rest ", &BIAS[..3], 0.02), ("torque at rest ", &BIAS[3..], 0.002)]
    {
        let told = told(name);
        let is_near = |(told, truth): (&f64, &f64)| (told - truth).abs() < allowed;
        assert!(told.len() == 3 && told.iter().zip(truth).all(is_near), "{name}: {told:?}");
    }
    assert_eq!((told("centre of mass ").len(), told("inertia ").len()), (3, 6), "{said}");
    // What swings is nearly all of the load.
    let (load, left) = (told("RMS of the load "), told("RMS left "));
    assert!(load.len() == 6 && left.len() == 6, "{said}");
    assert!(load.iter().zip(&left).all(|(load, left)| *left < 0.2 * load), "{said}");
    assert!(said.contains("[inertial_unit] of a scene takes it off in motion"), "{said}");
    assert!(!said.contains("left out"), "{said}");
    // Two rows lack a number.
    let blank: String = motion(0.0, 8.0, None)
        .lines()
        .enumerate()
        .map(|(row, line)| match (row, line.rsplit_once(',')) {
            (100 | 200, Some((before, _))) => format!("{before},\n"),
            _ => format!("{line}\n"),
        })
        .collect();
    folder.write("blank.csv", &blank);
    let of_blank = folder.succeed(&[&["calibrate", "--inertial", "blank.csv"][..], &calibrate[3..]].concat());
    let left_out = "2 rows without a time, a wrench or a motion are left out";
    assert!(of_blank.contains("Payload: GOOD") && of_blank.contains(left_out), "{of_blank}");
    folder.succeed(&calibrate);
    folder.write("touch.csv", &motion(20.0, 3.0, Some(1.5)));
    folder.write("scene.toml", SCENE);
    let analyze = ["analyze", "touch.csv", "--scene", "scene.toml", "--no-report"];
    let said = folder.succeed(&analyze);
    assert!(said.contains("28.0 ms late"), "{said}");
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    let status = contacts.words("status");
    // Behind the settling of the filter, and not within its delay behind the touch.
    assert!(status[100..740].iter().all(|status| *status == "below_threshold"), "{:?}", &status[100..740]);
    assert!(status[820..].iter().all(|status| *status == "contact"));
    let (force, height) = (contacts.numbers("normal_N"), contacts.numbers("z_m"));
    assert!(force[820..].iter().all(|force| (force - 1.0).abs() < 0.03), "{:?}", &force[820..]);
    assert!(height[820..].iter().all(|z| *z > 0.0098), "{:?}", &height[820..]);
    // By orientation alone there is none to take it off by, and without the unit's columns neither.
    let lying = SCENE.replace("[inertial_unit]\n", "");
    folder.write("lying.toml", &lying);
    let failed = folder.fail(1, &["analyze", "touch.csv", "--scene", "lying.toml", "--no-report"]);
    assert!(failed.contains("qx, qy, qz, qw") && failed.contains("[inertial_unit]"), "{failed}");
    folder.write("blind.csv", &motion(20.0, 0.5, None).replacen("wz_deg_per_s", "other", 1));
    let failed = folder.fail(1, &["analyze", "blind.csv", "--scene", "scene.toml", "--no-report"]);
    assert!(failed.contains("lacks wz"), "{failed}");
    // Columns of other names.
    let named = "[input.columns]\ntime = \"when\"\nax = \"-first\"\n[input.units]\ntime = \"ms\"\nacceleration = \"g\"\n";
    folder.write("named.toml", &SCENE.replace("[surface]", &format!("{named}[surface]")));
    let renamed = motion(20.0, 3.0, Some(1.5)).replacen("t_ms", "when", 1).replacen("ax_g", "first", 1);
    let mirrored: String = renamed
        .lines()
        .enumerate()
        .map(|(row, line)| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            if row > 0 {
                cells[7] = (-cells[7].parse::<f64>().unwrap()).to_string();
            }
            cells.join(",") + "\n"
        })
        .collect();
    folder.write("named.csv", &mirrored);
    let before = folder.read("contacts.csv");
    folder.succeed(&["analyze", "named.csv", "--scene", "named.toml", "--no-report"]);
    assert_eq!(folder.read("contacts.csv"), before);
}

#[test]
fn mistakes_are_named() {
    let folder = Folder::new();
    folder.write("motion.csv", &motion(0.0, 2.0, None));
    let failed = folder.fail(1, &["calibrate", "--inertial", "motion.csv", "--unit-position", "1,2"]);
    assert!(failed.contains("three numbers"), "{failed}");
    let failed = folder.fail(1, &["calibrate", "--inertial", "motion.csv", "--reaction"]);
    assert!(failed.contains("reaction"), "{failed}");
    let failed = folder.fail(1, &["calibrate", "--inertial", "motion.csv", "--time-constant", "0"]);
    assert!(failed.contains("time constant"), "{failed}");
    folder.write("no.csv", "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,0,0,0,0,0,0\n");
    let failed = folder.fail(1, &["calibrate", "--inertial", "no.csv"]);
    assert!(failed.contains("lacks ax, ay, az, wx, wy, wz"), "{failed}");
}
