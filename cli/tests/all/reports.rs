//! Summaries and reports of recordings, as somebody has looked at them, and their numbers read back.

use nalgebra::Vector3;

use crate::common::{Contacts, Folder, assert_accepted, body};

const HEADER: &str = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n";
const REST: usize = 30;

/// A row of a force at a point.
fn row(time: f64, point: &Vector3<f64>, force: &Vector3<f64>) -> String {
    let torque = point.cross(force);
    let cells = [force.x, force.y, force.z, torque.x, torque.y, torque.z].map(|cell| format!("{cell:.9}"));
    format!("{time:.3},{}\n", cells.join(","))
}

/// A session at 100 samples a second: a rest; presses with 1 to 21 N at points that `place` gives for two numbers
/// from −1 to 1, with a friction ratio that grows and falls; and at the end what is no contact or no row.
fn session(place: impl Fn(f64, f64) -> (Vector3<f64>, Vector3<f64>), bias: &Vector3<f64>) -> String {
    let mut text = HEADER.to_owned();
    let noise = |i: usize| {
        Vector3::new((7.0 * i as f64).sin(), (11.0 * i as f64).sin(), (13.0 * i as f64).sin()) * 0.004
    };
    for i in 0..150 {
        let time = 0.01 * i as f64;
        if i < REST {
            text += &row(time, &Vector3::zeros(), &(bias + noise(i)));
            continue;
        }
        let (point, normal) = place((0.11 * i as f64).sin(), (0.07 * i as f64).cos());
        let load = 11.0 - 10.0 * (0.05 * i as f64).cos();
        let ratio = 0.02 * (i % 36) as f64;
        let along = normal.cross(&Vector3::new(0.3, 0.5, 0.8)).normalize();
        let force = (along * ratio - normal) * load;
        let torque = point.cross(&force);
        let cells = [force.x, force.y, force.z, torque.x, torque.y, torque.z];
        let bias = [bias.x, bias.y, bias.z, 0.0, 0.0, 0.0];
        let cells: Vec<String> =
            cells.iter().zip(bias).map(|(cell, bias)| format!("{:.9}", cell + bias)).collect();
        text += &format!("{time:.3},{}\n", cells.join(","));
    }
    let (point, normal) = place(0.0, 0.0);
    // Past the surface, too weak, from within, without a number, and a time that goes back.
    text += &row(1.5, &(point + Vector3::new(0.03, 0.03, 0.03)), &(normal.cross(&Vector3::y()) * 3.0 + bias));
    text += &row(1.51, &point, &(normal * -0.05 + bias));
    text += &row(1.52, &point, &(normal * 2.0 + bias));
    text += "1.53,1,2,,4,5,6\n1.2,0,0,-1,0,0,0\n";
    text
}

/// Analyses a session with a scene, and compares all that comes out with what was accepted.
fn check(name: &str, scene: &str, recording: &str) -> (String, Contacts) {
    let folder = Folder::new();
    folder.write(
        "scene.toml",
        &format!("version = 1\nname = \"{name}\"\n[input]\nconvention = \"on_fingertip\"\n{scene}"),
    );
    folder.write("session.csv", recording);
    let said = folder.succeed(&["analyze", "session.csv", "--scene", "scene.toml"]);
    let (report, contacts) = (folder.read("report.html"), folder.read("contacts.csv"));
    assert_accepted(&format!("{name}_summary.txt"), &said);
    assert_accepted(&format!("{name}_report.html"), &body(&report));
    assert_accepted(&format!("{name}_contacts.csv"), &contacts);
    (report, Contacts::parse(&contacts))
}

#[test]
fn of_a_sphere_with_a_rim_and_a_rest() {
    let place = |a: f64, b: f64| {
        let (polar, azimuth) = (1.2 * a.abs(), 3.0 * b);
        let normal = Vector3::new(polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin(), polar.cos());
        (normal * 0.012, normal)
    };
    let scene = "rest_s = 0.3\n[surface]\nshape = \"sphere\"\nradius_m = 0.012\nactive_half_angle_deg = 60.0\n\
        [contact]\nleast_force_N = 0.1\n[friction]\nstatic_coefficient = 0.6\n\
        [slip]\ndetector = \"threshold\"\nnoise_N = 0.01\n";
    let (report, contacts) = check("sphere", scene, &session(place, &Vector3::new(0.2, -0.1, 0.3)));
    read_back(&report, &contacts);
    let status = contacts.words("status");
    for (i, word) in status.iter().enumerate().take(150) {
        let expected = match (i < REST, 1.2 * (0.11 * i as f64).sin().abs() <= 60_f64.to_radians()) {
            (true, _) => "rest",
            (false, true) => "contact",
            (false, false) => "outside_active_region",
        };
        // A steep force beyond the rim may leave on the far side, pulling.
        assert!(
            *word == expected || expected.starts_with("outside") && *word == "only_pulling",
            "{i}: {word}"
        );
        if *word == "contact" {
            let ratio = 0.02 * (i % 36) as f64;
            assert!((contacts.numbers("ratio")[i] - ratio).abs() < 0.02, "{i}");
        }
    }
}

#[test]
fn of_a_cylinder_without_a_rest() {
    let place = |a: f64, b: f64| {
        let normal = Vector3::new(a.sin(), 0.0, a.cos());
        (normal * 0.02 + Vector3::y() * (0.009 * b), normal)
    };
    let scene = "[surface]\nshape = \"cylinder\"\nradius_m = 0.02\naxis = [0.0, 1.0, 0.0]\nhalf_length_m = 0.008\n\
        [contact]\nleast_force_N = 0.1\n[slip]\ndetector = \"drop\"\nnoise_N = 0.01\n";
    let (report, contacts) = check("cylinder", scene, &session(place, &Vector3::zeros()));
    read_back(&report, &contacts);
}

#[test]
fn of_a_plane_in_a_pose() {
    let place = |a: f64, b: f64| (Vector3::new(0.01 * a + 0.002, 0.006 * b, 0.005), Vector3::z());
    let scene = "[surface]\nshape = \"plane\"\n[pose]\ntranslation_m = [0.002, 0.0, 0.005]\n\
        [friction]\nstatic_coefficient = 0.5\n";
    let (report, contacts) = check("plane", scene, &session(place, &Vector3::zeros()));
    read_back(&report, &contacts);
}

#[test]
fn a_soft_finger_has_its_spin_torque_among_the_torques() {
    let folder = Folder::new();
    let scene = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"plane\"\n\
        [contact]\nmodel = \"soft_finger\"\nleast_force_N = 0.1\n";
    folder.write("scene.toml", scene);
    // 3 N at (4, −2, 0) mm, with a spin torque that comes and goes; between the halves nothing touches.
    let spin = |i: usize| 2e-3 * (0.1 * i as f64).sin();
    let mut text = HEADER.to_owned();
    for i in 0..100 {
        let force = if i == 50 { 0.01 } else { 3.0 };
        let cells =
            [0.0, 0.0, -force, 0.002 * force, 0.004 * force, spin(i)].map(|cell| format!("{cell:.9}"));
        text += &format!("{:.3},{}\n", 0.01 * i as f64, cells.join(","));
    }
    folder.write("session.csv", &text);
    folder.succeed(&["analyze", "session.csv", "--scene", "scene.toml"]);
    let (report, contacts) = (folder.read("report.html"), Contacts::parse(&folder.read("contacts.csv")));
    read_back(&report, &contacts);
    let spins = contacts.numbers("spin_Nm");
    check_curve(figure(&report, "Torque on the fingertip"), "d", &contacts.numbers("t_s"), &spins, 1e3);
    for (i, found) in spins.iter().enumerate().filter(|(i, _)| *i != 50) {
        assert!((found - spin(i)).abs() < 1e-8, "{found} at {i}");
    }
    assert!(spins[50].is_nan() && report.contains("spin torque of the contact"));
}

/// The curves of a report are the columns of `contacts.csv`.
fn read_back(report: &str, contacts: &Contacts) {
    let times = contacts.numbers("t_s");
    for (title, columns, unit) in [
        ("Force on the fingertip", ["fx_N", "fy_N", "fz_N"], 1.0),
        ("Torque on the fingertip", ["tx_Nm", "ty_Nm", "tz_Nm"], 1e3),
        ("Contact position", ["x_m", "y_m", "z_m"], 1e3),
    ] {
        for (class, column) in ["a", "b", "c"].into_iter().zip(columns) {
            check_curve(figure(report, title), class, &times, &contacts.numbers(column), unit);
        }
    }
}

fn figure<'a>(report: &'a str, title: &str) -> &'a str {
    let title = format!("<h2>{title}</h2>");
    report.split("<figure>").find(|figure| figure.starts_with(&title)).unwrap()
}

/// That a curve, read by the ticks of the axes, is a column point for point; `unit` of the column in that of the axis.
fn check_curve(figure: &str, class: &str, times: &[f64], values: &[f64], unit: f64) {
    let attribute = |tag: &str, name: &str| -> f64 {
        let start = tag.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
        tag[start..].split('"').next().unwrap().parse().unwrap()
    };
    let ticks = |anchor: &str, place: &str| -> Vec<(f64, f64)> {
        let tags =
            figure.split("<text ").skip(1).filter(|tag| tag.contains(&format!("text-anchor=\"{anchor}\">")));
        let tags = tags.filter(|tag| tag.starts_with("class=\"tick\""));
        tags.map(|tag| {
            let label = tag.split('>').nth(1).unwrap().split('<').next().unwrap().replace('−', "-");
            (attribute(&format!(" {tag}"), place), label.parse().unwrap())
        })
        .collect()
    };
    let slope = |marks: &[(f64, f64)]| {
        let ((p, v), (q, w)) = (marks[0], marks[marks.len() - 1]);
        (w - v) / (q - p)
    };
    let (across, up) = (ticks("middle", "x"), ticks("end", "y"));
    let line = |marks: &[(f64, f64)], at: f64| marks[0].1 + (at - marks[0].0) * slope(marks);
    let path =
        figure.split(&format!("class=\"curve {class}\" d=\"")).nth(1).unwrap().split('"').next().unwrap();
    let drawn: Vec<(f64, f64)> = path
        .split(['M', 'L'])
        .skip(1)
        .map(|point| {
            let (x, y) = point.trim_end_matches("h0").split_once(' ').unwrap();
            // Labels stand 3.5 below their line.
            let (x, y) = (x.parse().unwrap(), y.parse::<f64>().unwrap() + 3.5);
            (line(&across, x), line(&up, y))
        })
        .collect();
    let finite: Vec<(f64, f64)> = times
        .iter()
        .zip(values)
        .map(|(time, value)| (*time, unit * value))
        .filter(|(_, v)| v.is_finite())
        .collect();
    assert_eq!(drawn.len(), finite.len(), "curve {class}");
    // Places are rounded to a tenth.
    let (time_error, error) = (0.25 * slope(&across).abs(), 0.25 * slope(&up).abs());
    for ((time, value), (found_time, found)) in finite.iter().zip(&drawn) {
        let near = (found_time - time).abs() < time_error && (found - value).abs() < error;
        assert!(near, "curve {class}: {found} at {found_time} s for {value} at {time} s");
    }
}
