//! What the compiler says where a type does not fit: every public trait that users implement has words for it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests, which may fail so")]

extern crate alloc;

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The libraries in Rust, by the folders of their source.
const SOURCES: [&str; 9] = [
    "calibration/src",
    "contact/src",
    "drivers/src",
    "friction/src",
    "hand/src",
    "simulation/src",
    "src",
    "surfaces/src",
    "wrench/src",
];

/// Traits that no user sees: they are in modules that are hidden or private.
const HIDDEN: [&str; 2] = ["Kernel", "Wide"];

fn walk(folder: &Path, see: &mut dyn FnMut(&Path, &str)) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            walk(&path, see);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            see(&path, &fs::read_to_string(&path).unwrap());
        }
    }
}

#[test]
fn every_public_trait_says_what_does_not_fit() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut seen, mut without) = (0, Vec::new());
    for source in SOURCES {
        walk(&root.join(source), &mut |path, text| {
            let lines: Vec<_> = text.lines().collect();
            for (index, line) in lines.iter().enumerate() {
                let Some(rest) = line.strip_prefix("pub trait ") else { continue };
                let name = rest.split(|c: char| !c.is_alphanumeric()).next().unwrap();
                if HIDDEN.contains(&name) {
                    continue;
                }
                seen += 1;
                let above = lines[..index].iter().rev().take_while(|line| !line.starts_with("///"));
                if !above.into_iter().any(|line| line.starts_with("#[diagnostic::on_unimplemented(")) {
                    without.push(format!("{}: {name}", path.strip_prefix(root).unwrap().display()));
                }
            }
        });
    }
    assert!(seen > 25 && without.is_empty(), "{seen} traits, without words: {without:#?}");
}

/// The library as `test` was linked with it: of those built with several sets of features the last before it.
fn library(folder: &Path, name: &str, test: &Path) -> PathBuf {
    let begin = format!("lib{name}-");
    let made = |path: &Path| fs::metadata(path).unwrap().modified().unwrap();
    let linked = made(test);
    let mut found: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            let file = path.file_name().unwrap().to_string_lossy();
            file.starts_with(&begin) && file.ends_with(".rlib") && made(path) <= linked
        })
        .collect();
    found.sort_by_key(|path| made(path));
    found.pop().unwrap_or_else(|| panic!("no {name} in {}", folder.display()))
}

/// What the compiler says of a program that uses `fingertip`.
fn said_of(name: &str, program: &str) -> String {
    let test = env::current_exe().unwrap();
    let dependencies = test.parent().unwrap();
    let scratch = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let file = scratch.join(format!("unfit_{name}.rs"));
    fs::write(&file, program).unwrap();
    // The compiler that stands beside cargo, which built the library.
    let cargo = PathBuf::from(env!("CARGO"));
    let beside = cargo.with_file_name("rustc");
    let compiler = if beside.exists() { beside } else { "rustc".into() };
    let output = Command::new(compiler)
        .args(["--edition", "2024", "--crate-type", "lib", "--emit", "metadata", "--color", "never"])
        .arg("--extern")
        .arg(format!("fingertip={}", library(dependencies, "fingertip", &test).display()))
        .arg("-L")
        .arg(format!("dependency={}", dependencies.display()))
        .arg("--out-dir")
        .arg(scratch)
        .arg(&file)
        .output()
        .unwrap();
    assert!(!output.status.success(), "{name} compiles");
    String::from_utf8(output.stderr).unwrap()
}

const BEGIN: &str =
    "#![allow(unused)]\nuse fingertip::prelude::*;\nuse fingertip::{contact, friction};\nstruct Own;\n";

#[test]
fn the_compiler_says_what_does_not_fit() {
    let build = |stage: &str| {
        format!(
            "fn f(ball: Sphere<f64>, point: PointContact<f64>) {{ \
             let mut tip = Fingertip::builder().contact(ball, point){stage}.build(); \
             tip.sense_wrench(Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros()), 1e-3); }}"
        )
    };
    let mut others = Vec::new();
    for (name, program, message, note) in [
        (
            "friction",
            build(".friction(Own)"),
            "`Own` is no friction model of `f64`",
            "implement `FrictionModel`",
        ),
        (
            "scalar",
            build(".friction(Coulomb::new(0.5_f32).unwrap())"),
            "Coulomb<f32>` is no friction model of `f64`",
            "its scalar must be that of the contact force",
        ),
        (
            "detector",
            build(".slip_detector(Own)"),
            "`Own` detects no slip in contact forces of `f64`",
            "`DropDetector`",
        ),
        (
            "grip_stage",
            build(".friction_stage(Own)"),
            "`Own` cannot judge a contact force of `f64`",
            "a `GripStage` to `.friction_stage",
        ),
        (
            "slip_stage",
            build(".slip_stage(Own)"),
            "`Own` cannot follow contact forces of `f64`",
            "a `SlipStage` to `.slip_stage",
        ),
        (
            "skin",
            "fn f<L: contact::SkinLaw<f64, Sphere<f64>>>() {} fn g() { f::<Own>() }".to_owned(),
            "gives way to a force of `f64`",
            "`SkinLaw::indentation_at`",
        ),
        (
            "soft_finger",
            "fn f<S: contact::SoftFingerSurface<f64>>() {} fn g() { f::<Own>() }".to_owned(),
            "`Own` does not know the soft contacts of a wrench of `f64`",
            "`newton_soft_contacts`",
        ),
        (
            "limit",
            "fn f<S: friction::FrictionLimit<f64>>() {} fn g() { f::<Own>() }".to_owned(),
            "`Own` does not know the shape of its friction limit in `f64`",
            "`normal_force_keeping`, `project` and `slip_direction`",
        ),
        (
            "real",
            "fn f(ball: Sphere<i32>) {}".to_owned(),
            "`i32` is no scalar of fingertip",
            "take `f32` or `f64`",
        ),
        (
            "frame",
            "fn f(wrench: Wrench<f64, Own>) {}".to_owned(),
            "`Own` is no coordinate frame",
            "impl Frame for Palm",
        ),
    ] {
        let program = format!("{BEGIN}{program}\n");
        let said = said_of(name, &program);
        if !(said.contains(message) && said.contains(note)) {
            others.push(format!("{name}: {said}"));
        }
    }
    assert!(others.is_empty(), "{}", others.join("\n"));
}
