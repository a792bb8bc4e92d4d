//! What a run reads is never written over, by whatever name it goes, and whoever named it.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::Folder;

const SCENE: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\nsample_rate_Hz = 1000.0\n\
    [sensor]\ncalibration = \"six.toml\"\n[payload]\nfile = \"body.toml\"\n[surface]\n";
const ROBOT: &str = "<robot name='r'><link name='tip'><collision><geometry><mesh filename='tip.stl' scale='0.001 0.001 \
    0.001'/></geometry></collision></link></robot>";

/// A scene with each kind of file that scenes name, and what the commands read beside it.
fn folder() -> Folder {
    let folder = Folder::new();
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let copy = |from: &str, to: &str| fs::copy(workspace.join(from), folder.path(to)).unwrap();
    copy("surfaces/fuzz/seeds/mesh_stl/tetrahedron.stl", "tip.stl");
    copy("calibration/fuzz/seeds/poses/body.csv", "poses.csv");
    let diagonal = |size: f64| -> Vec<Vec<String>> {
        let cell = |row, column| if row == column { size.to_string() } else { "0.0".to_owned() };
        (0..6).map(|row| (0..6).map(|column| cell(row, column)).collect()).collect()
    };
    let rows: Vec<String> = diagonal(2.0).iter().map(|row| format!("[{}]", row.join(", "))).collect();
    let calibration = format!(
        "version = 1\naxes = [\"fx\", \"fy\", \"fz\", \"tx\", \"ty\", \"tz\"]\nsignal_unit = \"V\"\n\
         nominal = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]\nmatrix = [{}]\nzero = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]\n",
        rows.join(", ")
    );
    folder.write("six.toml", &calibration);
    folder.succeed(&["calibrate", "--gravity", "poses.csv", "-o", "body.toml"]);
    folder.write("robot.urdf", ROBOT);
    folder.write(
        "mesh.toml",
        &format!("{SCENE}shape = \"mesh\"\nfile = \"tip.stl\"\nmetres_per_unit = 0.001\n"),
    );
    folder.write("robot.toml", &format!("{SCENE}urdf = \"robot.urdf\"\nlink = \"tip\"\n"));
    folder.write(
        "hand.toml",
        "version = 1\n[[finger]]\nname = \"one\"\nscene = \"mesh.toml\"\nfriction = 0.5\n",
    );
    folder.write("a.csv", "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,0,0,-1,0,0,0\n0.001,0,0,-1,0,0,0\n");
    let loads: Vec<String> = [1.0, -1.0, 0.5]
        .iter()
        .flat_map(|size| {
            let signals = diagonal(2.0 * size);
            diagonal(*size).into_iter().zip(signals).map(|(load, signal)| [load, signal].concat().join(","))
        })
        .collect();
    let header = "fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V";
    folder.write("loads.csv", &format!("{header}\n{}\n", loads.join("\n")));
    folder
}

/// That a run, to which an output behind it is given that is another name of a file, leaves it as it is.
fn assert_spared(folder: &Folder, file: &str, arguments: &[&str]) {
    let before = fs::read(folder.path(file)).unwrap();
    let link = "link.csv";
    let _ = fs::remove_file(folder.path(link));
    fs::hard_link(folder.path(file), folder.path(link)).unwrap();
    let error = folder.fail(1, &[arguments, &[link, "--overwrite"]].concat());
    assert!(error.contains("link.csv is also an input of this run"), "{file}, {arguments:?}: {error}");
    assert!(fs::read(folder.path(file)).unwrap() == before, "{file}, {arguments:?}");
}

/// Whatever file a scene names is an input of every command that has a scene.
#[test]
fn files_that_a_scene_names_are_spared() {
    let folder = folder();
    for (scene, named) in [
        ("mesh.toml", &["six.toml", "body.toml", "tip.stl"][..]),
        ("robot.toml", &["six.toml", "body.toml", "robot.urdf", "tip.stl"]),
    ] {
        for file in named {
            for arguments in [
                &["analyze", "a.csv", "--scene", scene, "--no-report", "--output"][..],
                &["object", "a.csv", "--scene", scene, "-o"],
                &["record", "sim", "--samples", "1", "--scene", scene, "-o"],
                &["export", scene, "--rust"],
                &["export", scene, "--json"],
                &["scene", "show", scene, "-o"],
                &["geometry", "sphere", "a.csv", "--scene", scene, "-o"],
                &["calibrate", "loads.csv", "--scene", scene, "-o"],
                &["check", "six.toml", "loads.csv", "--scene", scene, "--html"],
            ] {
                assert_spared(&folder, file, arguments);
            }
        }
    }
    // A hand scene names scenes, which name them.
    for file in ["mesh.toml", "six.toml", "body.toml", "tip.stl"] {
        assert_spared(
            &folder,
            file,
            &["analyze", "a.csv", "--scene", "hand.toml", "--no-report", "--output"],
        );
    }
    // A scene's own file, too, and of a library for C all three files.
    assert_spared(&folder, "mesh.toml", &["scene", "show", "mesh.toml", "-o"]);
    fs::create_dir(folder.path("c")).unwrap();
    fs::hard_link(folder.path("tip.stl"), folder.path("c/tip.h")).unwrap();
    let surface = "shape = \"mesh\"\nfile = \"tip.stl\"\nmetres_per_unit = 0.001\n";
    folder.write(
        "bare.toml",
        &format!("version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\n{surface}"),
    );
    let error = folder.fail(1, &["export", "bare.toml", "--c", "-o", "c", "--overwrite"]);
    assert!(error.contains("c/tip.h is also an input of this run"), "{error}");
}

/// Files that options name.
#[test]
fn files_that_options_name_are_spared() {
    let folder = folder();
    let prior = ["calibrate", "loads.csv", "--method", "prior", "--prior", "six.toml", "-o"];
    for (file, arguments) in [
        ("six.toml", &prior[..]),
        ("body.toml", &["calibrate", "loads.csv", "--payload", "body.toml", "-o"]),
        ("mesh.toml", &["calibrate", "loads.csv", "--scene", "mesh.toml", "-o"]),
        ("body.toml", &["check", "six.toml", "loads.csv", "--payload", "body.toml", "--html"]),
        ("mesh.toml", &["check", "six.toml", "loads.csv", "--scene", "mesh.toml", "--json"]),
        ("six.toml", &["refine", "six.toml", "loads.csv", "-o"]),
        ("loads.csv", &["refine", "six.toml", "a.csv", "--loads", "loads.csv", "-o"]),
        ("six.toml", &["analyze", "a.csv", "--scene", "mesh.toml", "--calibration", "six.toml", "--output"]),
        ("body.toml", &["object", "a.csv", "--scene", "mesh.toml", "--payload", "body.toml", "-o"]),
        ("six.toml", &["export", "mesh.toml", "--calibration", "six.toml", "--rust"]),
        ("six.toml", &["health", "a.csv", "--calibration", "six.toml", "--html"]),
        ("loads.csv", &["motion", "a.csv", "--force", "1", "--align", "loads.csv", "-o"]),
        ("poses.csv", &["calibrate", "--gravity", "poses.csv", "-o"]),
        ("a.csv", &["calibrate", "--inertial", "a.csv", "-o"]),
        ("six.toml", &["import", "six.toml", "-o"]),
        ("a.csv", &["convert", "a.csv"]),
        ("a.csv", &["recover", "a.csv"]),
    ] {
        assert_spared(&folder, file, arguments);
    }
}

/// Of hundreds of recordings, more than a process may have files open, each is compared with every output.
#[cfg(unix)]
#[test]
fn many_recordings_are_spared_too() {
    let folder = folder();
    let names: Vec<String> = (0..200).map(|number| format!("r{number}.csv")).collect();
    for name in &names {
        folder.write(name, "t_s,fx_N\n");
    }
    // The report of the first recording is the last one.
    fs::hard_link(folder.path("r199.csv"), folder.path("r0.report.html")).unwrap();
    let run = format!(
        "ulimit -n 64; exec {} analyze {} --scene mesh.toml --overwrite",
        env!("CARGO_BIN_EXE_fingertip"),
        names.join(" ")
    );
    let output = Command::new("sh").args(["-c", &run]).current_dir(folder.path("")).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(error.contains("r0.report.html is also an input of this run"), "{error}");
    assert_eq!((output.status.code(), folder.read("r199.csv")), (Some(1), "t_s,fx_N\n".to_owned()));
}
