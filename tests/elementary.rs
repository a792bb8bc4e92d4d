//! No feature changes a result: where there may be no standard library, elementary functions are those of `Real`.
//!
//! nalgebra's are the C library's with the feature `std` and `libm`'s without, and differ in last digits.
#![allow(clippy::unwrap_used, reason = "helpers of tests, which may fail so")]

use std::fs;
use std::path::{Path, PathBuf};

/// The crates that need no standard library.
const CRATES: [&str; 6] = ["wrench", "surfaces", "contact", "friction", "hand", "."];
/// What nalgebra and the standard library call the functions of which last digits differ.
const FUNCTIONS: [&str; 28] = [
    "exp",
    "exp2",
    "exp_m1",
    "ln",
    "ln_1p",
    "log",
    "log2",
    "log10",
    "sin",
    "cos",
    "tan",
    "sin_cos",
    "sinh",
    "cosh",
    "tanh",
    "asinh",
    "acosh",
    "atanh",
    "atan",
    "atan2",
    "asin",
    "acos",
    "cbrt",
    "hypot",
    "powf",
    "powi",
    "powc",
    "from_axis_angle",
];
/// Lines that call what is named alike: the methods of a formula's `Term`, which are made of those of `Real`; our
/// `hypot` of roots; and our rotations.
const OURS: [(&str, &str); 8] = [
    ("surfaces/src/shapes/term.rs", "self * other.powi(-1)"),
    ("surfaces/src/shapes/formula.rs", "FormulaStep::Power(exponent) => a.powi(*exponent),"),
    ("surfaces/src/shapes/formula.rs", "FormulaStep::Exp => a.exp(),"),
    ("surfaces/src/shapes/formula.rs", "FormulaStep::Sin => a.sin(),"),
    ("surfaces/src/shapes/formula.rs", "FormulaStep::Cos => a.cos(),"),
    ("friction/src/estimate/kinetic_friction.rs", "crate::limits::cone::hypot("),
    ("surfaces/src/combinators/posed.rs", "RigidTransform::from_axis_angle("),
    ("surfaces/src/testing/random.rs", "Rotation3::from_axis_angle("),
];
/// Where `Real` has them from.
const HOME: &str = "wrench/src/scalar/real.rs";

/// Whether a line calls one of the functions, other than of `libm`.
fn calls(line: &str) -> bool {
    if line.trim_start().starts_with("//") {
        return false;
    }
    let word = |c: char| c.is_alphanumeric() || c == '_';
    FUNCTIONS.iter().any(|function| {
        line.match_indices(function).any(|(at, _)| {
            let (before, after) = (&line[..at], &line[at + function.len()..]);
            let called = before.ends_with('.') || before.ends_with("::") && !before.ends_with("libm::");
            called && !after.starts_with(word)
        })
    })
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
}

/// The lines of the crates that call them, tests and what is ours left out.
fn offenders() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut files, mut used, mut found) = (Vec::new(), [false; OURS.len()], Vec::new());
    for name in CRATES {
        sources(&root.join(name).join("src"), &mut files);
    }
    assert!(files.len() > 200, "{}", files.len());
    for path in files {
        let name = path.strip_prefix(root).unwrap().to_str().unwrap().trim_start_matches("./").to_owned();
        if name.ends_with("tests.rs") || name == HOME {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let shipped = text.split("\nmod tests {").next().unwrap();
        for (number, line) in shipped.lines().enumerate().filter(|(_, line)| calls(line)) {
            match OURS.iter().position(|(file, part)| *file == name && line.contains(part)) {
                Some(known) => used[known] = true,
                None => found.push(format!("{name}:{}: {}", number + 1, line.trim())),
            }
        }
    }
    for (at, known) in OURS.iter().enumerate() {
        assert!(used[at], "no line is as {known:?} any more");
    }
    found
}

#[test]
fn elementary_functions_are_those_of_real() {
    let found = offenders();
    assert!(found.is_empty(), "take those of `Real`:\n{}", found.join("\n"));
}

#[test]
fn the_search_finds_what_it_is_to_find() {
    for line in
        ["let a = x.powf(p);", "RealField::atan2(a, b)", "xs.map(f64::exp)", "a.sin_cos().0", "x.sin() + y"]
    {
        assert!(calls(line), "{line}");
    }
    for line in [
        "// x.powf(p)",
        "libm::exp(x)",
        "x.power(p)",
        "export(x)",
        "a.exponential()",
        "x.cosine()",
        "self.tangential()",
    ] {
        assert!(!calls(line), "{line}");
    }
}
