//! What scenes mean and how they are drawn, as somebody has looked at it.

use fingertip_scene::registry::entries;
use nalgebra::Vector3;

use crate::common::{Contacts, Folder, assert_accepted, body};
use crate::scenes::ALL;

/// The points of a drawing in so few numbers that one that moves is seen: how many, where they are in the mean, and
/// sums in which each has a weight of its own.
fn digest(page: &str) -> String {
    let Some((_, net)) = page.split_once("data-net=\"") else { return "none".to_owned() };
    let (net, rest) = net.split_once('"').unwrap();
    let points: Vec<Option<Vec<f64>>> = net
        .split(';')
        .map(|point| point.split(',').map(|number| number.parse().ok()).collect::<Option<Vec<f64>>>())
        .collect();
    let mut sums = [[0.0; 2]; 3];
    for (i, point) in points.iter().enumerate().filter_map(|(i, point)| Some((i, point.as_ref()?))) {
        for (axis, number) in point.iter().enumerate() {
            sums[axis][0] += number;
            sums[axis][1] += number * (i % 17) as f64;
        }
    }
    let met = points.iter().flatten().count();
    let sums = sums.map(|[plain, weighted]| format!("{plain:.0} {weighted:.0}")).join(", ");
    let others: Vec<&str> = rest.split('>').next().unwrap().split(" data-").skip(1).collect();
    format!("{met} of {} points, {sums}; {}", points.len(), others.join(" "))
}

#[test]
fn of_every_shape() {
    let folder = Folder::new();
    let mut drawn = String::new();
    let mut meant = String::new();
    for entry in entries().filter(|entry| entry.section == "surface") {
        let scene = format!("{}.toml", entry.name);
        folder.succeed(&["scene", "init", &scene, "--shape", entry.name]);
        meant += &format!("{}\n", folder.succeed(&["scene", "check", &scene]));
        folder.succeed(&["scene", "show", &scene, "--output", "scene.html", "--overwrite"]);
        drawn += &format!("{}: {}\n", entry.name, digest(&folder.read("scene.html")));
    }
    assert_accepted("scene_meanings.txt", &meant);
    assert_accepted("scene_drawings.txt", &drawn);
}

/// Shapes that a pose, an active region or a hole leaves only in part.
#[test]
fn of_parts_of_shapes() {
    let folder = Folder::new();
    let mut drawn = String::new();
    for (name, surface) in [
        ("cap", "shape = \"sphere\"\nradius_m = 0.01\nactive_half_angle_deg = 60.0"),
        (
            "posed",
            "shape = \"capsule\"\nradius_m = 0.008\nhalf_length_m = 0.01\n[pose]\ntranslation_m = [0.01, 0.02, 0.03]\nrotation_deg = [20.0, 30.0, 40.0]",
        ),
        (
            "formula",
            "shape = \"formula\"\noutside = \"(x-d)^2/a^2 + y^2/b^2 + z^4/c^4 - 1\"\nparameters = { a = 0.01, b = 0.012, c = 0.015, d = 0.02 }\nreach_m = 0.04",
        ),
    ] {
        folder.write(
            "part.toml",
            &format!("version = 2\nname = \"{name}\"\n[input]\nconvention = \"on_fingertip\"\n[surface]\n{surface}\n"),
        );
        folder.succeed(&["scene", "show", "part.toml", "--output", "scene.html", "--overwrite"]);
        drawn += &format!("{name}: {}\n", digest(&folder.read("scene.html")));
    }
    assert_accepted("scene_parts.txt", &drawn);
}

/// Oblique pushes on a ball of 13 mm with a spin torque, from place to place; at the end nothing touches.
fn pushes() -> String {
    let mut text = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n".to_owned();
    for k in 0..240 {
        let turn = f64::from(k) * 0.01;
        let normal = Vector3::new(0.3 + 0.2 * turn, 0.4 - 0.1 * turn, 0.6).normalize();
        let aside = normal.cross(&Vector3::new(0.2, -0.5, 0.7)).normalize();
        let load = if k < 200 { 2.0 + 0.5 * turn } else { 0.01 };
        let ratio = 0.1 + 0.25 * f64::from(k % 60) / 60.0;
        let force = (aside * ratio - normal) * load;
        let torque = normal.cross(&force) * 0.013 - normal * (2e-4 * load);
        let cells = [force, torque].map(|vector| {
            let cells: [f64; 3] = vector.into();
            cells.map(|cell| format!("{cell:.6}")).join(",")
        });
        let cells = if k == 150 { "NaN,0,0,0,0,0".to_owned() } else { cells.join(",") };
        text += &format!("{:.3},{cells}\n", f64::from(k) * 1e-3);
    }
    text
}

#[test]
fn of_a_scene_that_asks_for_all() {
    let folder = Folder::new();
    folder.write("pushes.csv", &pushes());
    folder.write("all.toml", ALL);
    assert_accepted("scene_all.txt", &folder.succeed(&["scene", "check", "all.toml"]));
    assert_accepted(
        "scene_all_summary.txt",
        &folder.succeed(&["analyze", "pushes.csv", "--scene", "all.toml"]),
    );
    let contacts = folder.read("contacts.csv");
    let rows: String = contacts
        .lines()
        .enumerate()
        .filter(|(i, _)| i % 10 < 2)
        .map(|(_, line)| format!("{line}\n"))
        .collect();
    assert_accepted("scene_all_contacts.csv", &rows);
    assert_eq!(Contacts::parse(&contacts).len(), 240);
    assert!(
        contacts
            .lines()
            .all(|line| line.split(',').count() == contacts.lines().next().unwrap().split(',').count())
    );
    // Curves and maps are those of other reports; here it is what is written beside them.
    let is_drawn =
        |line: &&str| ["<path", "<circle", "<line", "<rect"].iter().any(|tag| line.starts_with(tag));
    let page: String = body(&folder.read("report.html"))
        .lines()
        .filter(|line| !is_drawn(line))
        .map(|line| format!("{line}\n"))
        .collect();
    assert_accepted("scene_all_report.html", &page);
}

/// Where nothing touches there is little to say.
#[test]
fn of_a_recording_without_contacts() {
    let folder = Folder::new();
    let quiet: String = pushes()
        .lines()
        .enumerate()
        .filter(|(i, _)| *i == 0 || *i > 201)
        .map(|(_, line)| format!("{line}\n"))
        .collect();
    folder.write("quiet.csv", &quiet);
    folder.write("all.toml", ALL);
    assert_accepted("scene_all_quiet.txt", &folder.succeed(&["analyze", "quiet.csv", "--scene", "all.toml"]));
    let report = folder.read("report.html");
    assert!(!report.contains("<p></p>") && !report.contains("<p class=\"lead\"></p>"), "{report}");
}
