//! Scenes as Rust and as JSON.

use crate::common::{Folder, scene};

#[test]
fn a_scene_is_exported_as_rust_and_json() {
    let folder = Folder::new();
    let path = scene("rubber_tip.toml");
    let said =
        folder.succeed(&["export", &path, "--rust", "tip.rs", "--scalar", "f32", "--json", "tip.json"]);
    assert!(said.contains("tip.rs, tip.json"), "{said}");
    let rust = folder.read("tip.rs");
    for part in ["pub type Tip = Fingertip<", "pub fn tip()", "pub fn grip()", "f32::INFINITY", "\"skin\""] {
        assert!(rust.contains(part), "{part}: {rust}");
    }
    let json = folder.read("tip.json");
    assert!(json.contains("\"slip_boost\": 1.25") && json.contains("[1500000.0, \"inf\"]"), "{json}");
}

#[test]
fn the_calibration_of_the_sensor_comes_along() {
    let folder = Folder::new();
    folder.succeed(&["demo", "--out", "demo.html", "--calibration", "cal.toml"]);
    folder.succeed(&["export", "sim", "--rust", "tip.rs", "--calibration", "cal.toml"]);
    let rust = folder.read("tip.rs");
    assert!(
        rust.contains("wrench::GaussianElimination<f64>") && rust.contains("pub mod calibration {"),
        "{rust}"
    );
}

#[test]
fn an_export_that_cannot_be_leaves_no_file() {
    let folder = Folder::new();
    let plane = std::fs::read_to_string(scene("plane.toml")).unwrap();
    folder.write("tip.toml", &plane);
    folder.fail(2, &["export", "tip.toml"]);
    folder.fail(2, &["export", "tip.toml", "--json", "tip.json", "--scalar", "f32"]);
    let error = folder.fail(1, &["export", "tip.toml", "--json", "tip.toml"]);
    assert!(error.contains("would be overwritten"), "{error}");
    folder.write("far.toml", &plane.replace("0.0, 0.0, 0.005", "0.0, 0.0, 1e100"));
    let error =
        folder.fail(1, &["export", "far.toml", "--rust", "tip.rs", "--json", "tip.json", "--scalar", "f32"]);
    assert!(error.contains("far.toml"), "{error}");
    assert!(!folder.path("tip.rs").exists() && !folder.path("tip.json").exists());
}

/// What `.ci/firmware-c` does not: a library that cannot be is refused before anything is compiled.
#[test]
fn a_library_for_c_that_cannot_be_is_refused() {
    let folder = Folder::new();
    let ball = scene("paper_sphere.toml");
    folder.fail(2, &["export", &ball, "--c"]);
    folder.fail(2, &["export", &ball, "--c", "-o", "out", "--json", "ball.json"]);
    folder.fail(2, &["export", &ball, "--rust", "ball.rs", "--target", "thumbv7em-none-eabihf"]);
    let refused = |arguments: &[&str], says: &str| {
        let error = folder.fail(1, &[&["export", "--c", "-o", "out"], arguments].concat());
        assert!(error.contains(says), "{error}");
    };
    refused(&[&scene("tracked_ball.toml")], "the section [tracking], of which a touch for C tells nothing");
    refused(&[&ball, "--name", "Tip"], "\"Tip\" is no name for C");
    refused(&[&ball, "--target", "nonsense-none-elf"], "no compiler here has the target nonsense-none-elf");
    folder.write("garbled.cal", "nonsense");
    refused(&[&ball, "--calibration", "garbled.cal"], "garbled.cal");
    assert!(!folder.path("out/libtip.a").exists() && !folder.path("out/tip.h").exists());
}
