//! `-` is the standard input or output of every command that reads or writes files.

use std::fs::{self, File};
use std::path::Path;
use std::process::Output;

use crate::common::{Folder, scene};

/// Runs the command with a file as its standard input.
fn with_stdin(folder: &Folder, arguments: &[&str], file: &str) -> Output {
    let file = File::open(folder.path(file)).unwrap();
    folder.command(arguments).stdin(file).output().unwrap()
}

fn folder() -> Folder {
    let folder = Folder::new();
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let copy = |from: &str, to: &str| fs::copy(workspace.join(from), folder.path(to)).unwrap();
    copy("calibration/fuzz/seeds/layout_file/three_pairs.toml", "layout.toml");
    copy("calibration/fuzz/seeds/poses/body.csv", "poses.csv");
    fs::copy(scene("paper_sphere.toml"), folder.path("sphere.toml")).unwrap();
    // Three axes of three gauges, and touches of a ball of 10 mm about the origin.
    let mut loads = "fx_N,fy_N,fz_N,v1_V,v2_V,v3_V\n".to_owned();
    for [x, y, z] in
        [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 1, 0], [0, -2, 1], [2, 1, -1], [1, 1, 1], [0, 0, 0]]
    {
        loads.push_str(&format!("{x},{y},{z},{},{},{}\n", 2 * x, 3 * y, 4 * z));
    }
    folder.write("loads.csv", &loads);
    folder.write("done.csv", "fx_N,fy_N,fz_N\n1,0,0\n0,1,0\n");
    folder.succeed(&["calibrate", "loads.csv", "-o", "tip.toml"]);
    let mut touches = "fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,nx,ny,nz\n".to_owned();
    for (n, f) in [
        ([1.0, 0.0, 0.0], [-2.0, 0.1, 0.2]),
        ([0.0, 1.0, 0.0], [0.3, -2.0, 0.1]),
        ([0.0, 0.0, 1.0], [0.1, 0.2, -3.0]),
        ([-0.6, 0.8, 0.0], [1.2, -1.7, 0.2]),
        ([0.0, 0.6, 0.8], [0.1, -1.3, -1.5]),
        ([0.6, 0.0, -0.8], [-1.3, 0.1, 1.5]),
    ] {
        let [[x, y, z], [fx, fy, fz]] = [n, f];
        let torque =
            [y * fz - z * fy, z * fx - x * fz, x * fy - y * fx].map(|component: f64| 0.01 * component);
        let cells: Vec<String> = f.iter().chain(&torque).chain(&n).map(f64::to_string).collect();
        touches.push_str(&(cells.join(",") + "\n"));
    }
    folder.write("touches.csv", &touches);
    folder.write("a.csv", &rows(1500));
    // A weight of 2 N in twelve directions on three gauges.
    let mut turns = "v1_V,v2_V,v3_V\n".to_owned();
    for number in 0..12 {
        let (angle, up) = (f64::from(number) * 2.4, f64::from(number) / 6.0 - 0.9);
        let along = (1.0 - up * up).sqrt();
        turns.push_str(&format!(
            "{},{},{}\n",
            4.0 * along * angle.cos(),
            6.0 * along * angle.sin(),
            8.0 * up
        ));
    }
    folder.write("turns.csv", &turns);
    // Six components, each of which a gauge reads by itself, and points of a ball pushed in its own and other directions.
    let row = |row| {
        format!(
            "[{}]",
            (0..6).map(|column| if row == column { "2.0" } else { "0.0" }).collect::<Vec<_>>().join(", ")
        )
    };
    folder.write("six.toml", &format!(
        "version = 1\naxes = [\"fx\", \"fy\", \"fz\", \"tx\", \"ty\", \"tz\"]\nsignal_unit = \"V\"\nnominal = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]\n\
         matrix = [{}]\nzero = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]\n",
        (0..6).map(row).collect::<Vec<_>>().join(", ")
    ));
    let mut pushes = "v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n".to_owned();
    for number in 0..80 {
        let along = |share: f64| [(share * 7.1).sin(), (share * 5.3).cos(), (share * 3.7 + 1.0).sin()];
        let ([x, y, z], [fx, fy, fz]) = (along(f64::from(number)), along(1.7 * f64::from(number) + 0.4));
        let wrench = [fx, fy, fz, y * fz - z * fy, z * fx - x * fz, x * fy - y * fx];
        pushes.push_str(&(wrench.map(|component: f64| (2.0 * component).to_string()).join(",") + "\n"));
    }
    folder.write("pushes.csv", &pushes);
    folder
}

/// A second at rest, then touches, with a noise of its own on every axis, at places one after another.
fn rows(count: usize) -> String {
    let rows = (0..count).map(|row| {
        let (mut noise, pressed) = (row as u64, if row < 1000 { 0.0 } else { 1.0 });
        let wrench = [0.0, 0.2, -1.0, 1e-3, 0.0, 2e-3].map(|mean: f64| {
            noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let share = (noise >> 40) as f64 / (1_u64 << 24) as f64 - 0.5;
            (mean * pressed + (0.1 * mean.abs()).max(1e-3) * share).to_string()
        });
        let time = row as f64 * 1e-3;
        format!("{time},{},{},0,0,1,0,0,0\n", wrench.join(","), row / 100)
    });
    let pose = "pose_x_m,pose_y_m,pose_z_m,pose_qw,pose_qx,pose_qy,pose_qz";
    format!("t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,{pose}\n{}", rows.collect::<String>())
}

/// What comes by the standard input is taken as the file would be: the same is said, and the same is written to the standard
/// output.
#[test]
fn every_command_reads_the_standard_input() {
    let folder = folder();
    for (file, arguments) in [
        ("a.csv", &["analyze", "@", "--scene", "sphere.toml", "--no-report", "--output", "-"][..]),
        ("sphere.toml", &["analyze", "a.csv", "--scene", "@", "--no-report", "--output", "-"]),
        ("layout.toml", &["bench", "@", "--template", "-", "--pages", "bench.pdf"]),
        ("loads.csv", &["calibrate", "@", "-o", "-"]),
        ("tip.toml", &["calibrate", "loads.csv", "--method", "prior", "--prior", "@", "-o", "-"]),
        ("poses.csv", &["calibrate", "--gravity", "@", "-o", "-"]),
        ("tip.toml", &["check", "@", "loads.csv"]),
        ("loads.csv", &["check", "tip.toml", "@", "--json", "-"]),
        ("sphere.toml", &["export", "@", "--rust", "-"]),
        ("touches.csv", &["geometry", "sphere", "@", "-o", "-"]),
        ("sphere.toml", &["geometry", "sphere", "touches.csv", "--scene", "@", "-o", "-"]),
        ("a.csv", &["health", "@", "--json", "-"]),
        ("tip.toml", &["import", "@", "-o", "-"]),
        ("a.csv", &["info", "@", "--json"]),
        ("turns.csv", &["motion", "@", "--force", "2"]),
        ("loads.csv", &["motion", "turns.csv", "--force", "2", "--align", "@", "-o", "-"]),
        ("a.csv", &["object", "@", "--scene", "sphere.toml"]),
        ("sphere.toml", &["object", "a.csv", "--scene", "@"]),
        ("loads.csv", &["plan", "@"]),
        ("done.csv", &["plan", "loads.csv", "--done", "@"]),
        ("sphere.toml", &["record", "sim", "--samples", "20", "--scene", "@", "-o", "-"]),
        ("a.csv", &["recover", "@", "-"]),
        ("six.toml", &["refine", "@", "pushes.csv"]),
        ("pushes.csv", &["refine", "six.toml", "@"]),
        ("sphere.toml", &["scene", "show", "@", "-o", "-"]),
        ("turns.csv", &["tare", "tip.toml", "@", "--accept-motion", "-o", "-"]),
        ("tip.toml", &["tare", "@", "turns.csv", "--accept-motion", "-o", "-"]),
    ] {
        let named = |name: &str| arguments.iter().map(|word| word.replace('@', name)).collect::<Vec<_>>();
        let run = |words: &[String], stdin: Option<&str>| {
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            match stdin {
                Some(file) => with_stdin(&folder, &words, file),
                None => folder.run(&words),
            }
        };
        let (of_file, of_input) = (run(&named(file), None), run(&named("-"), Some(file)));
        let text = |bytes: &[u8]| {
            let text = String::from_utf8_lossy(bytes).replace("standard input", "FILE").replace(file, "FILE");
            // A checksum is of the name of its source, too.
            let is_same = |line: &&str| !line.starts_with("checksum = ");
            text.lines().filter(is_same).map(|line| line.to_owned() + "\n").collect::<String>()
        };
        assert_eq!(
            of_input.status.code(),
            of_file.status.code(),
            "{arguments:?}: {}",
            text(&of_input.stderr)
        );
        let stem = file.split('.').next().unwrap();
        // A scene is named by its file.
        let said = |output: &Output| text(&output.stdout).replace(&format!("\"{stem}\""), "\"scene\"");
        assert_eq!(said(&of_input), said(&of_file), "{arguments:?}");
        assert!(!text(&of_input.stderr).contains("panicked") && !of_input.stdout.is_empty(), "{arguments:?}");
    }
}

/// Every command writes its outputs to the standard output, alone: what it says goes to the standard error.
#[test]
fn every_command_writes_to_the_standard_output() {
    let folder = folder();
    folder.succeed(&["convert", "a.csv", "a.mcap"]);
    for (arguments, start) in [
        (&["bench", "layout.toml", "--template", "t.svg", "--pages", "-"][..], "%PDF-"),
        (&["calibrate", "loads.csv", "-o", "tip2.toml", "--html", "-"], "<!doctype html>"),
        (&["check", "tip.toml", "loads.csv", "--html", "-"], "<!doctype html>"),
        (&["convert", "a.mcap", "-"], "t_s,fx_N"),
        (&["demo", "--out", "-"], "<!doctype html>"),
        (&["demo", "--hand", "--out", "-"], "<!doctype html>"),
        (&["demo", "--out", "demo.html", "--recording", "-"], "t_s,v1_V"),
        (&["design", "--force", "20", "--out", "-", "--report", "r.html"], "version = 1"),
        (&["export", "sphere.toml", "--json", "-"], "{"),
        (&["health", "a.csv", "--html", "-"], "<!doctype html>"),
        (&["scene", "init", "-"], "#"),
        (&["record", "sim", "--samples", "3", "-o", "-"], "t_s,"),
        (&["recover", "a.mcap", "-"], "\u{fffd}MCAP0"),
    ] {
        let output = folder.run(arguments);
        let (said, told) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(output.status.success(), "{arguments:?}: {told}");
        assert!(said.starts_with(start), "{arguments:?}: {}", said.chars().take(200).collect::<String>());
    }
}

#[test]
fn the_standard_input_is_read_once() {
    let folder = folder();
    for arguments in [
        &["plan", "-", "--done", "-"][..],
        &["info", "-", "-"],
        &["convert", "-", "-", "."],
        &["check", "-", "-"],
        &["calibrate", "-", "--prior", "-", "--method", "prior", "-o", "x"],
        &["refine", "-", "-"],
        &["geometry", "sphere", "-", "--scene", "-"],
        &["health", "-", "--calibration", "-"],
        &["object", "-", "--scene", "-"],
        &["motion", "-", "--force", "1", "--align", "-"],
    ] {
        let error = folder.fail(1, arguments);
        assert!(error.contains("the standard input can be read once"), "{arguments:?}: {error}");
    }
}

#[test]
fn a_simulation_reads_its_script_from_the_standard_input() {
    let folder = Folder::new();
    folder.write("script.toml", "[[segments]]\ndo = \"rest\"\nduration = 0.25\n");
    folder.write("bad.toml", "segments = []\n");
    let arguments = ["simulate", "--duration", "0.1", "--serve", "bota", "--over", "tcp", "--script", "-"];
    let error = String::from_utf8(with_stdin(&folder, &arguments, "bad.toml").stderr).unwrap();
    assert!(error.contains("the script has no segments"), "{error}");
    let output = with_stdin(&folder, &arguments, "script.toml");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && said.contains("0.25 s"), "{said}");
}
