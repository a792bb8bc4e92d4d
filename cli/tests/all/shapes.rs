//! Scenes of every shape, and calibrations of more than six gauges.

use fingertip_calibration::file::{CalibrationFile, SignalUnit};
use nalgebra::{DMatrix, Vector3, Vector6};

use crate::common::{Contacts, Folder, scene};

const HEADER: &str = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n";

/// The row of a force that acts at a point.
fn row(time: f64, point: [f64; 3], force: [f64; 3]) -> String {
    let torque = Vector3::from(point).cross(&Vector3::from(force));
    let [fx, fy, fz] = force;
    format!("{time},{fx},{fy},{fz},{},{},{}\n", torque.x, torque.y, torque.z)
}

fn assert_point(contacts: &Contacts, row: usize, expected: [f64; 3]) {
    for (name, expected) in ["x_m", "y_m", "z_m"].iter().zip(expected) {
        let found = contacts.numbers(name)[row];
        assert!((found - expected).abs() < 1e-8, "row {row}, {name}: {found} for {expected}");
    }
}

#[test]
fn the_ellipsoid_and_the_capsule_are_met_where_they_are_pushed() {
    let folder = Folder::new();
    // On the ellipsoid x²/a² + y²/b² + z²/c² = 1, its centre 20 mm up.
    let (theta, phi) = (0.6_f64, 1.1_f64);
    let slanted =
        [0.008 * theta.sin() * phi.cos(), 0.010 * theta.sin() * phi.sin(), 0.020 + 0.015 * theta.cos()];
    let top = [0.0, 0.0, 0.035];
    let rows = [row(0.0, top, [0.0, 0.0, -2.0]), row(0.001, slanted, [0.0, 0.0, -2.0])];
    folder.write("touch.csv", &format!("{HEADER}{}", rows.concat()));
    folder.succeed(&["analyze", "touch.csv", "--scene", &scene("ellipsoid.toml")]);
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    assert_eq!(contacts.words("status"), ["contact", "contact"]);
    assert_point(&contacts, 0, top);
    assert_point(&contacts, 1, slanted);
    assert!(folder.read("report.html").contains("Equal-area projection"));

    // The tip, the side, and a grazing force on the side, of ratio 5.
    let (tip, side) = ([0.047, 0.0, 0.0], [0.033, 0.0, 0.007]);
    let rows = [
        row(0.0, tip, [-2.0, 0.0, 0.0]),
        row(0.001, side, [0.0, 0.0, -2.0]),
        row(0.002, side, [0.0, 5.0, -1.0]),
    ];
    folder.write("touch.csv", &format!("{HEADER}{}", rows.concat()));
    let summary = folder.succeed(&["analyze", "touch.csv", "--scene", &scene("capsule.toml")]);
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    assert_eq!(contacts.words("status"), ["contact", "contact", "beyond_friction"]);
    assert_point(&contacts, 0, tip);
    assert_point(&contacts, 1, side);
    assert!(summary.contains("more tangential than friction allows"), "{summary}");
}

const CUBE_FACES: [[usize; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

#[test]
fn a_mesh_beside_the_scene_is_read_in_its_unit() {
    let folder = Folder::new();
    // A cube of 20 mm in millimetres.
    let mut obj = String::new();
    for corner in 0..8 {
        let side = |bit: i32| if corner & bit > 0 { 10 } else { -10 };
        obj.push_str(&format!("v {} {} {}\n", side(1), side(2), side(4)));
    }
    for [a, b, c, d] in CUBE_FACES.map(|face| face.map(|corner| corner + 1)) {
        obj.push_str(&format!("f {a} {b} {c}\nf {a} {c} {d}\n"));
    }
    std::fs::create_dir(folder.path("scenes")).unwrap();
    folder.write("scenes/tip.obj", &obj);
    let scene = "version = 1\n[input]\nconvention = \"on_fingertip\"\n[pose]\ntranslation_m = [0.0, 0.0, 0.03]\n\
                 [surface]\nshape = \"mesh\"\nfile = \"tip.obj\"\nmetres_per_unit = 0.001\n";
    folder.write("scenes/mesh.toml", scene);
    let point = [0.004, 0.003, 0.04];
    folder.write("touch.csv", &format!("{HEADER}{}", row(0.0, point, [0.5, 0.0, -2.0])));
    let analyze = ["analyze", "touch.csv", "--scene", "scenes/mesh.toml", "--no-report"];
    folder.succeed(&analyze);
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    assert_eq!(contacts.words("status"), ["contact"]);
    assert_point(&contacts, 0, point);
    assert!((contacts.numbers("ratio")[0] - 0.25).abs() < 1e-6);

    for (from, to, expected) in [
        ("tip.obj", "none.obj", "none.obj"),
        ("= 0.001", "= -0.001", "must be a positive, finite number of metres"),
        ("= 0.001", "= 0.0", "must be a positive, finite number of metres"),
        ("= 0.001", "= nan", "must be a positive, finite number of metres"),
        ("= 0.001", "= inf", "must be a positive, finite number of metres"),
        ("metres_per_unit = 0.001\n", "", "missing field `metres_per_unit`"),
        ("metres_per_unit", "units", "unknown field `units`"),
        ("mesh\"\nfile = \"tip.obj\"\nmetres_per_unit = 0.001", "torus\"\nring = 1", "ring"),
    ] {
        folder.write("scenes/mesh.toml", &scene.replace(from, to));
        let error = folder.fail(1, &analyze);
        assert!(error.contains(expected) && error.contains("mesh.toml"), "{expected:?} is not in {error}");
        assert_eq!(error.trim_end().lines().count(), 1, "{error}");
    }
    // In metres it would be of 20 m.
    folder.write("scenes/mesh.toml", &scene.replace("= 0.001", "= 1.0"));
    let said = folder.succeed(&["scene", "check", "scenes/mesh.toml"]);
    assert!(said.contains("by which the mesh reaches 17.3"), "{said}");
}

#[test]
fn eight_gauges_are_solved_by_least_squares() {
    let folder = Folder::new();
    // Any well-conditioned matrix, with a zero of its own.
    let normalised = DMatrix::from_fn(8, 6, |gauge, axis| {
        let (gauge, axis) =
            (f64::from(u32::try_from(gauge).unwrap()), f64::from(u32::try_from(axis).unwrap()));
        (0.3 + 0.9 * gauge + 1.7 * axis + 0.31 * gauge * axis).sin()
    });
    let nominal = vec![10.0, 10.0, 10.0, 0.1, 0.1, 0.1];
    let zero: Vec<f64> = (0..8).map(|gauge| 0.1 * f64::from(gauge)).collect();
    let file = CalibrationFile::new(normalised, nominal, zero.clone(), SignalUnit::Volt).unwrap();
    file.write(folder.path("calibration.toml")).unwrap();

    let point = Vector3::new(0.0, 0.006, 0.008);
    let force = Vector3::new(0.3, -1.2, -1.6);
    let torque = point.cross(&force);
    let load = Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z);
    let matrix = file.sensor_matrix::<8>().unwrap();
    let signals = matrix.signals(&fingertip::wrench::Wrench::from_components(&load));
    let cells: Vec<String> =
        signals.iter().zip(&zero).map(|(signal, zero)| (signal + zero).to_string()).collect();
    let header: Vec<String> = (1..=8).map(|gauge| format!("v{gauge}_V")).collect();
    folder.write("volts.csv", &format!("t_s,{}\n0,{}\n", header.join(","), cells.join(",")));
    let scene = "version = 1\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.01\n";
    folder.write("scene.toml", scene);
    folder.succeed(&["analyze", "volts.csv", "--scene", "scene.toml", "--calibration", "calibration.toml"]);
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    assert_eq!(contacts.words("status"), ["contact"]);
    assert_point(&contacts, 0, [0.0, 0.006, 0.008]);
    for (name, expected) in ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"].iter().zip(load.iter()) {
        assert!((contacts.numbers(name)[0] - expected).abs() < 1e-6, "{name}");
    }
}
