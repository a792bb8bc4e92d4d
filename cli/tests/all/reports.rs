//! Summaries and reports of recordings, as somebody has looked at them, and their numbers read back.

use nalgebra::Vector3;

use crate::common::{Contacts, Folder, assert_accepted};

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

/// The drawings and words of a page, without its style, a tag a line.
fn without_style(page: &str) -> String {
    let (head, rest) = page.split_once("<style>").unwrap();
    let (_, body) = rest.split_once("</style>").unwrap();
    let version = env!("CARGO_PKG_VERSION");
    format!("{head}{body}").replace("><", ">\n<").replace(version, "VERSION")
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
    assert_accepted(&format!("{name}_report.html"), &without_style(&report));
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

/// The force curves of a report are the columns of `contacts.csv`: read by the ticks of the axes, point for point.
fn read_back(report: &str, contacts: &Contacts) {
    let figure = report.split("<figure>").find(|figure| figure.contains("Force on the fingertip")).unwrap();
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
    let line = |marks: Vec<(f64, f64)>, at: f64| {
        let ((p, v), (q, w)) = (marks[0], marks[marks.len() - 1]);
        v + (at - p) * (w - v) / (q - p)
    };
    let times = contacts.numbers("t_s");
    for (class, column) in [("a", "fx_N"), ("b", "fy_N"), ("c", "fz_N")] {
        let path =
            figure.split(&format!("class=\"curve {class}\" d=\"")).nth(1).unwrap().split('"').next().unwrap();
        let drawn: Vec<(f64, f64)> = path
            .split(['M', 'L'])
            .skip(1)
            .map(|point| {
                let (x, y) = point.trim_end_matches("h0").split_once(' ').unwrap();
                // Labels stand 3.5 below their line.
                let (x, y) = (x.parse().unwrap(), y.parse::<f64>().unwrap() + 3.5);
                (line(ticks("middle", "x"), x), line(ticks("end", "y"), y))
            })
            .collect();
        let values = contacts.numbers(column);
        let finite: Vec<(f64, f64)> =
            times.iter().copied().zip(values).filter(|(_, value)| value.is_finite()).collect();
        assert_eq!(drawn.len(), finite.len(), "{column}");
        for ((time, value), (found_time, found)) in finite.iter().zip(&drawn) {
            // A tenth of a unit is a two-thousandth of an axis of 1.5 s, and of one of some 50 N.
            assert!((found_time - time).abs() < 2e-3 && (found - value).abs() < 0.05, "{column} at {time} s");
        }
    }
}
