//! `fingertip geometry`: surfaces from touches.

use nalgebra::{Rotation3, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use crate::common::Folder;
use crate::said::noisy;

fn direction(random: &mut Pcg64Mcg) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)).normalize()
}

/// Load of a push with friction at a point, then the cells given.
fn row(random: &mut Pcg64Mcg, point: &Vector3<f64>, normal: &Vector3<f64>, cells: &str) -> String {
    let force = direction(random).cross(normal).normalize() * 0.5 - normal * 2.0;
    let torque = point.cross(&force);
    let (f, m) = (force, torque);
    format!("{},{},{},{},{},{}{cells}\n", f.x, f.y, f.z, m.x, m.y, m.z)
}

pub(crate) fn touches(shape: &str) -> String {
    let random = &mut Pcg64Mcg::seed_from_u64(5);
    let wrench = "fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm";
    let centre = Vector3::new(0.001, -0.002, 0.004);
    let turn = Rotation3::from_scaled_axis(Vector3::new(0.2, 0.5, -0.1));
    let mut text = match shape {
        "plane" => format!("{wrench},pivot\n"),
        "pivot" => format!("{wrench}\n"),
        "pose" => format!("{wrench},px_m,py_m,pz_m\n"),
        _ => format!("{wrench},nx,ny,nz\n"),
    };
    for i in 0..20 {
        let n = direction(random);
        let (point, normal, cells) = match shape {
            "sphere" => (centre + n * 0.0125, n, format!(",{},{},{}", n.x, n.y, n.z)),
            "ellipsoid" => {
                let squares = nalgebra::Matrix3::from_diagonal(&Vector3::new(4e-4, 2e-4, 1e-4));
                let shape = turn * squares * turn.inverse();
                let point = centre + shape * n / n.dot(&(shape * n)).sqrt();
                (point, n, format!(",{},{},{}", n.x, n.y, n.z))
            }
            "cylinder" => {
                let axis = turn * Vector3::z();
                let radial = (n - axis * n.dot(&axis)).normalize();
                let point = centre + radial * 0.008 + axis * (0.001 * f64::from(i));
                (point, radial, format!(",{},{},{}", radial.x, radial.y, radial.z))
            }
            "plane" => {
                let corner = f64::from(i % 4);
                let point = Vector3::new(0.004 * corner.cos(), 0.004 * corner.sin(), 0.011);
                (point, Vector3::z(), format!(",corner {}", i % 4))
            }
            "pivot" => (centre, n, String::new()),
            _ => {
                let y = direction(random) * 0.01;
                (turn * y + centre, n, format!(",{},{},{}", y.x, y.y, y.z))
            }
        };
        text += &row(random, &point, &normal, &cells);
    }
    text
}

#[test]
fn surfaces_are_found_and_their_scenes_can_be_used() {
    let folder = Folder::new();
    let sphere = "version = 1\n[input]\nconvention = \"on_fingertip\"\nsample_rate_Hz = 10.0\n\
                  [surface]\nshape = \"sphere\"\nradius_m = 0.01\n";
    folder.write("known.toml", sphere);
    for (shape, expected) in [
        ("sphere", "12.5000"),
        ("ellipsoid", "+20.0000 +14.1421 +10.0000"),
        ("cylinder", "8.0000"),
        ("plane", "11.0000"),
        ("pivot", "+1.0000 -2.0000 +4.0000"),
        ("pose", "+11.4592 +28.6479 -5.7296"),
    ] {
        folder.write("touches.csv", &touches(shape));
        let mut command = vec!["geometry", shape, "touches.csv"];
        match shape {
            "pivot" => {}
            "pose" => command.extend(["--scene", "known.toml", "-o", "scene.toml"]),
            _ => command.extend(["-o", "scene.toml"]),
        }
        let said = folder.succeed(&command);
        assert!(said.contains(expected) && said.contains("20 touches"), "{shape}: {said}");
        if shape == "cylinder" {
            assert!(said.contains("not observed: position along the axis"), "{said}");
        }
        // With errors of the forces, what is exact comes out the same.
        let noisy = folder.succeed(&[&command[..3], &["--noise", "0.01,1e-5"]].concat());
        assert!(noisy.contains(expected) && !noisy.contains("taken as exact"), "{shape}: {noisy}");
        assert!(!noisy.contains("what is left is"), "{shape}: {noisy}");
        assert!(said.contains("taken as exact") && said.contains("95 %"), "{shape}: {said}");
        if shape != "pivot" {
            let analyze = ["analyze", "touches.csv", "--scene", "scene.toml", "--no-report"];
            let said = folder.succeed(&analyze);
            assert!(said.contains("20 contacts"), "{shape}: {said}");
        }
    }
}

#[test]
fn mistakes_are_named() {
    let folder = Folder::new();
    folder.write("touches.csv", &touches("sphere"));
    let error = folder.fail(1, &["geometry", "plane", "touches.csv"]);
    assert!(error.contains("touches.csv") && error.contains("`pivot`"), "{error}");
    let error = folder.fail(1, &["geometry", "sphere", "touches.csv", "-o", "touches.csv"]);
    assert!(error.contains("overwritten"), "{error}");
    let error = folder.fail(1, &["geometry", "cylinder", "touches.csv", "--axis", "0,1"]);
    assert!(error.contains("three numbers"), "{error}");
    folder.write("broken.csv", &touches("sphere").replace("tz_Nm", "tz_parsec"));
    let error = folder.fail(1, &["geometry", "sphere", "broken.csv"]);
    assert!(error.contains("tz_parsec"), "{error}");
    folder.fail(2, &["geometry", "cube", "touches.csv"]);
    for (noise, expected) in [("0.1", "two numbers, not 1"), ("0.1,0", "--noise: the noise of the wrenches")]
    {
        let error = folder.fail(1, &["geometry", "sphere", "touches.csv", "--noise", noise]);
        assert!(error.contains(expected), "{error}");
    }
    folder.write("held.csv", &touches("pivot"));
    let error = folder.fail(1, &["geometry", "pivot", "held.csv", "-o", "scene.toml"]);
    assert!(error.contains("no surface"), "{error}");
    folder.write("posed.csv", &touches("pose"));
    let error = folder.fail(1, &["geometry", "pose", "posed.csv", "-o", "scene.toml"]);
    assert!(error.contains("--scene"), "{error}");
    folder.write("known.toml", "version = 1\n[pose]\n");
    let command = ["geometry", "pose", "posed.csv", "--scene", "known.toml", "-o", "scene.toml"];
    let error = folder.fail(1, &command);
    assert!(error.contains("known.toml") && error.contains("missing field `input`"), "{error}");
    folder.write("known.toml", KNOWN);
    let error = folder.fail(1, &[&command[..], &["--reaction"]].concat());
    assert!(error.contains("known.toml") && error.contains("against --reaction"), "{error}");
}

const KNOWN: &str = "# Our gripper.
version = 2
name = \"left finger\"

[input]
convention = \"on_fingertip\" # as the driver says

# What touches.
[surface]
shape = \"sphere\"
radius_m = 0.01 # from the drawing

[pose]
translation_m = [0.0, 0.0, 0.5]

[friction] # rubber
static_coefficient = 0.8
";

/// What is found goes where it belongs in a scene; the rest, comments too, stays.
#[test]
fn a_scene_takes_what_was_found_of_it() {
    let folder = Folder::new();
    folder.write("known.toml", KNOWN);
    let find = |shape: &str, of: &str, more: &[&str]| {
        folder.write("touches.csv", &touches(of));
        let command = ["geometry", shape, "touches.csv", "--scene", "known.toml", "-o", "scene.toml"];
        folder.succeed(&[&command[..], more].concat());
        folder.succeed(&["scene", "check", "scene.toml"]);
        folder.read("scene.toml")
    };
    let posed = find("pose", "pose", &[]);
    let (start, rest) = posed.split_once("[pose]\n").unwrap();
    assert_eq!(start, KNOWN.split_once("[pose]\n").unwrap().0);
    let (pose, friction) = rest.split_once("\n[friction]").unwrap();
    assert_eq!(friction, " # rubber\nstatic_coefficient = 0.8\n");
    assert!(pose.starts_with("translation_m = [") && pose.contains("rotation_deg = ["), "{pose}");
    assert!(!pose.contains("0.5]"), "{pose}");

    let round = find("sphere", "sphere", &[]);
    assert!(
        !round.contains("[pose]") && round.contains("# What touches.\n[surface]\nshape = \"sphere\"\n"),
        "{round}"
    );
    assert!(
        !round.contains("drawing") && round.contains("centre_m = [") && round.contains("# rubber"),
        "{round}"
    );
    // One that has the section in a line of its own, and says that it reports reactions.
    let reaction = KNOWN
        .replace("on_fingertip", "reaction")
        .replace("[surface]\nshape = \"sphere\"\nradius_m = 0.01 # from the drawing\n", "");
    folder.write(
        "known.toml",
        &reaction.replace("name =", "surface = { shape = \"sphere\", radius_m = 0.01 }\nname ="),
    );
    let opposite = find("sphere", "sphere", &[]);
    let radius = |text: &str| -> f64 {
        let (_, rest) = text.split_once("radius_m = ").unwrap();
        rest.split([' ', ',', '\n']).next().unwrap().parse().unwrap()
    };
    // A line of action is the same either way.
    assert_eq!(radius(&opposite), radius(&round));
    assert!(opposite.contains("convention = \"reaction\""), "{opposite}");
}

/// Torques that are wrong by 0.1 mN·m, whatever is said of them.
#[test]
fn noise_that_is_greater_than_stated_is_told() {
    let folder = Folder::new();
    folder.write("touches.csv", &noisy(&touches("sphere"), &["tx", "ty", "tz"], 1e-4));
    let said = |noise: &str| folder.succeed(&["geometry", "sphere", "touches.csv", "--noise", noise]);
    let stated = said("1e-3,7e-5");
    assert!(stated.contains("20 touches") && !stated.contains("what is left is"), "{stated}");
    let doubted = said("1e-4,7e-6");
    let (_, rest) = doubted.split_once("what is left is ").unwrap_or_else(|| panic!("{doubted}"));
    let (times, rest) = rest.split_once(" times what --noise says: ").unwrap();
    assert!((5.0..20.0).contains(&times.parse::<f64>().unwrap()), "{doubted}");
    assert!(rest.starts_with("the shape, the normals or the noise are not as stated"), "{doubted}");
}

/// Without friction the radius does not show, and the error says what to do.
#[test]
fn the_motion_that_is_missing_is_named() {
    let folder = Folder::new();
    let random = &mut Pcg64Mcg::seed_from_u64(6);
    let mut text = "fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,nx,ny,nz\n".to_owned();
    for _ in 0..20 {
        let n = direction(random);
        // Forces within half a degree of the normals, wrong by more than that.
        let (f, arm) = (direction(random).cross(&n) * 0.01 - n * 2.0, n * 0.0125);
        let (m, f) = (arm.cross(&f), f + direction(random) * 0.05);
        text += &format!("{},{},{},{},{},{},{},{},{}\n", f.x, f.y, f.z, m.x, m.y, m.z, n.x, n.y, n.z);
    }
    folder.write("touches.csv", &text);
    let error = folder.fail(1, &["geometry", "sphere", "touches.csv", "--noise", "0.03,1e-5"]);
    assert!(error.contains("do not determine radius") && error.contains("press with friction"), "{error}");
}
