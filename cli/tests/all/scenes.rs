//! Scenes: to begin with, said, chosen from, and what they tell of a recording.

use std::fs;
use std::path::Path;

use fingertip_scene::registry::entries;

use crate::calibrate::loads;
use crate::common::{Contacts, Folder, scene};

/// Pushes on the top of a ball of 13 mm, each a little more sideways, with a spin torque.
fn pushes() -> String {
    let mut text = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n".to_owned();
    for k in 0..200 {
        let (time, aside) = (f64::from(k) * 1e-3, f64::from(k) * 0.004);
        text.push_str(&format!("{time},{aside},0,-2,0,{},0.0005\n", 0.013 * aside));
    }
    text
}

/// A scene that asks for all that there is.
pub(crate) const ALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n\
    [contact]\nmodel = \"soft_finger\"\nleast_force_N = 0.1\n\
    [uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n\
    [tracking]\nspeed_m_per_s = 0.01\nturns_within_s = 0.1\nleast_touch_N = 0.1\n\
    [friction]\nlimit = \"uncertain\"\nstatic_coefficient = 0.5\ndeviation = 0.05\n\
    [slip]\ndetector = \"drop\"\nnoise_N = 0.01\n[estimate]\nnoise_N = 0.01\n\
    [grip]\nleast_N = 0.2\ngreatest_N = 20.0\nrise_N_per_s = 100.0\nfall_N_per_s = 2.0\n";

#[test]
fn every_choice_can_be_begun_with_and_means_something() {
    let folder = Folder::new();
    for entry in entries() {
        let option = match entry.section {
            "surface" => "--shape",
            "contact" => "--model",
            "contact.skin" => "--skin",
            "friction" => "--friction",
            "filter" => "--filter",
            _ => "--slip",
        };
        let name = format!("{}.toml", entry.name);
        let mut arguments = vec!["scene", "init", &name, option, entry.name];
        match (entry.section, entry.name) {
            ("friction", "anisotropic") => arguments.extend(["--shape", "plane"]),
            ("slip", _) => arguments.extend(["--friction", "coulomb"]),
            _ => {}
        }
        let path = folder.path(&name);
        let _ = fs::remove_file(&path);
        folder.succeed(&arguments);
        let said = folder.succeed(&["scene", "check", &name]);
        assert!(said.contains(&format!("{}, {}", entry.name, entry.says)), "{said}");
    }
    // What is there is not written over.
    let error = folder.fail(1, &["scene", "init", "sphere.toml"]);
    assert!(error.contains("sphere.toml"), "{error}");
    let error = folder.fail(1, &["scene", "init", "new.toml", "--shape", "cube"]);
    assert!(error.contains("--shape cube") && error.contains("scene choices"), "{error}");
    assert!(!folder.path("new.toml").exists());
}

#[test]
fn choices_are_listed_and_doubts_are_said() {
    let folder = Folder::new();
    let all = folder.succeed(&["scene", "choices"]);
    for entry in entries() {
        assert!(all.contains(&format!("\"{}\"", entry.name)) && all.contains(entry.says), "{}", entry.name);
    }
    // Under each key, once.
    let (mut keys, mut last) = (Vec::new(), "");
    for entry in entries().filter(|entry| core::mem::replace(&mut last, entry.section) != entry.section) {
        keys.push(format!("[{}] {} =", entry.section, entry.key));
    }
    assert!(
        keys.len() > 4 && all.lines().filter(|line| line.starts_with('[')).eq(&keys),
        "{keys:?} in {all}"
    );
    let limits = folder.succeed(&["scene", "choices", "friction"]);
    assert!(limits.contains("\"load_dependent\"") && !limits.contains("\"torus\""), "{limits}");
    assert!(folder.fail(1, &["scene", "choices", "nothing"]).contains("contact.skin"));
    let text = fs::read_to_string(scene("paper_sphere.toml")).unwrap();
    folder.write("far.toml", &text.replace("radius_m = 0.013", "radius_m = 13.0"));
    let said = folder.succeed(&["scene", "check", "far.toml"]);
    assert!(said.contains("warning: `radius_m` of [surface] is 13 m"), "{said}");
}

/// Every command that goes by a scene says what in it is hardly meant: once, and not to those who want to hear errors alone.
#[test]
fn doubts_of_a_scene_are_said_by_all_that_use_it() {
    const DOUBT: &str = "`radius_m` of [surface] is 13 m, longer than any fingertip";
    let folder = Folder::new();
    let far = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 13.0\n";
    folder.write("far.toml", far);
    folder.write("pushes.csv", &pushes());
    folder.write("loads.csv", &loads(1.0));
    let far = ["--scene", "far.toml", "--overwrite"];
    let [record, analyze, calibrate] = [
        &["record", "sim?rate_Hz=1000", "--samples", "20", "-o", "day.csv"][..],
        &["analyze", "pushes.csv", "--no-report"],
        &["calibrate", "loads.csv", "-o", "cal.toml", "--accept-bad"],
    ];
    for command in [record, calibrate] {
        let command = [command, &far].concat();
        let said = String::from_utf8(folder.run(&command).stderr).unwrap();
        assert_eq!(said.matches(&format!("warning: {DOUBT}")).count(), 1, "{command:?}: {said}");
        let quiet = folder.run(&[&command[..], &["--quiet"]].concat());
        assert_eq!(String::from_utf8(quiet.stderr).unwrap(), "", "{command:?}");
    }
    let said = folder.succeed(&[analyze, &far].concat());
    assert_eq!(said.matches(&format!("Note: {DOUBT}")).count(), 1, "{said}");
    let json = folder.succeed(&[analyze, &far, &["--json"]].concat());
    assert!(json.contains("`radius_m` of [surface] is 13 m"), "{json}");
    let export = folder.run(&["export", "far.toml", "--json", "far.json"]);
    assert!(String::from_utf8(export.stderr).unwrap().contains(&format!("warning: {DOUBT}")));
}

/// The page of a scene: what it is called and means, its surface, what is implausible; and it writes over nothing.
#[test]
fn a_scene_is_drawn_on_a_page() {
    let folder = Folder::new();
    let text = fs::read_to_string(scene("paper_sphere.toml")).unwrap();
    folder.write("far.toml", &text.replace("radius_m = 0.013", "radius_m = 13.0"));
    let said = folder.succeed(&["scene", "show", "far.toml"]);
    assert!(said.contains("scene.html"), "{said}");
    let page = folder.read("scene.html");
    assert!(page.contains("longer than any fingertip"), "{page}");
    assert!(page.contains(">surface</th>"), "{page}");
    let refused = folder.fail(1, &["scene", "show", "far.toml"]);
    assert!(refused.contains("scene.html") && refused.contains("--overwrite"), "{refused}");
    assert_eq!(folder.read("scene.html"), page);
    folder.succeed(&["scene", "show", "sim", "--output", "sim.html"]);
    let page = folder.read("sim.html");
    assert!(page.contains("<h1>simulated fingertip</h1>") && page.contains("data-net=\""), "{page}");
    folder.fail(1, &["scene", "show", "none.toml", "--output", "other.html"]);
    assert!(!folder.path("other.html").exists());
}

/// All scenes that there are to copy can be read, mean something, and are not doubted.
#[test]
fn the_scenes_to_copy_are_sound() {
    let folder = Folder::new();
    let one = scene("plane.toml");
    let mut seen = 0;
    for file in fs::read_dir(Path::new(&one).parent().unwrap()).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let path = path.to_str().unwrap();
            let said = folder.succeed(&["scene", "check", path]);
            assert!(said.contains("surface") && !said.contains("warning: "), "{said}");
            let page = format!("{seen}.html");
            folder.succeed(&["scene", "show", path, "--output", &page]);
            let page = folder.read(&page);
            assert!(
                page.contains("<h1>")
                    && page.contains("data-net=\"")
                    && page.contains("Scene and calibration")
            );
            assert!(!page.contains("To be minded"), "{path}");
            seen += 1;
        }
    }
    assert!(seen >= 9, "{seen}");
}

/// What a scene asks for beside the contact stands in columns of its own.
#[test]
fn a_scene_that_asks_for_more_is_told_more() {
    let folder = Folder::new();
    folder.write("pushes.csv", &pushes());
    folder.write("all.toml", ALL);
    folder.succeed(&["analyze", "pushes.csv", "--scene", "all.toml"]);
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    let last = |name: &str| *contacts.numbers(name).last().unwrap();
    // 0.8 N sideways and 2 N down on a ball: pressed where both point to.
    assert!((last("spin_Nm") - 0.0005).abs() < 1e-4, "{}", last("spin_Nm"));
    assert!(last("ellipse_a_m") >= last("ellipse_b_m") && last("ellipse_b_m") > 0.0);
    assert!((0.005..0.02).contains(&last("normal_deviation_N")), "{}", last("normal_deviation_N"));
    let apart = ["x_m", "y_m", "z_m"].map(|axis| last(axis) - last(&format!("track_{axis}")));
    assert!(apart.iter().all(|apart| apart.abs() < 1e-3), "{apart:?}");
    assert!(last("track_deviation_m") > 0.0 && last("track_surprise") >= 0.0);
    assert!(folder.read("contacts.csv").contains(",new,") && folder.read("contacts.csv").contains(",touch,"));
    assert!((0.0..=1.0).contains(&last("slip_probability")));
    assert!(last("grip_N") > 0.2);
    // A scene that asks for none has none of them.
    folder.succeed(&["analyze", "pushes.csv", "--scene", &scene("plane.toml"), "--output", "plain.csv"]);
    assert!(folder.read("plain.csv").starts_with("t_s,status,fx_N,"));
    assert!(!folder.read("plain.csv").contains("spin_Nm"));
}

/// A recording of a program that names its columns as it likes, in its own units and signs.
#[test]
fn columns_of_any_names_are_read() {
    let folder = Folder::new();
    folder.write("pushes.csv", &pushes());
    let scene = "version = 2\n[input]\nconvention = \"on_fingertip\"\nCOLUMNS[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
    folder.write("plain.toml", &scene.replace("COLUMNS", ""));
    folder.succeed(&[
        "analyze",
        "pushes.csv",
        "--scene",
        "plain.toml",
        "--no-report",
        "--output",
        "plain.csv",
    ]);
    // Milliseconds, newton millimetres, the wrench upside down, and a column that is none of it.
    let mut text =
        "__time,note,/ft/wrench/force/x,/ft/wrench/force/y,/ft/wrench/force/z,M1,M2,M3\n".to_owned();
    for row in pushes().lines().skip(1) {
        let n: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        text.push_str(&format!("{},x,{},{},{}", n[0] * 1e3, n[1], n[2], -n[3]));
        text.push_str(&format!(",{},{},{}\n", n[4] * 1e3, n[5] * 1e3, n[6] * 1e3));
    }
    folder.write("other.csv", &text);
    let columns = "[input.columns]\ntime = \"__time\"\nfx = \"/ft/wrench/force/x\"\nfy = \"/ft/wrench/force/y\"\n\
                   fz = \"-/ft/wrench/force/z\"\ntx = \"M1\"\nty = \"M2\"\ntz = \"M3\"\n\
                   [input.units]\ntime = \"ms\"\ntorque = \"N*mm\"\n";
    folder.write("other.toml", &scene.replace("COLUMNS", columns));
    folder.succeed(&[
        "analyze",
        "other.csv",
        "--scene",
        "other.toml",
        "--no-report",
        "--output",
        "other_out.csv",
    ]);
    let (plain, other) =
        (Contacts::parse(&folder.read("plain.csv")), Contacts::parse(&folder.read("other_out.csv")));
    for name in ["t_s", "fz_N", "ty_Nm", "x_m", "z_m", "normal_N"] {
        for (a, b) in plain.numbers(name).iter().zip(other.numbers(name)) {
            assert!((a - b).abs() < 1e-6, "{name}: {a} {b}");
        }
    }
    folder.write("wrong.toml", &scene.replace("COLUMNS", &columns.replace("M3", "M4")));
    let error = folder.fail(1, &["analyze", "other.csv", "--scene", "wrong.toml", "--no-report"]);
    assert!(error.contains("\"M4\"") && error.contains("M3"), "{error}");
}
