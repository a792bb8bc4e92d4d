//! The packages of the workspace and the sources in which faults are put.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::Deserialize;

use crate::Failure;
use crate::fault::Fault;

/// Where a sample's time or a sensor's bytes go through. What is off line has faults drawn by `--package`.
const HOT: &[&str] = &[
    "wrench/src/",
    "surfaces/src/shapes/",
    "surfaces/src/numeric/",
    "contact/src/",
    "friction/src/",
    "drivers/src/",
    "calibration/src/tare.rs",
    "src/",
];

/// Never: they are tests, or serve tests.
const NOT: &[&str] =
    &["/tests/", "/tests.rs", "/testing/", "/testing.rs", "_tests.rs", "/fuzz/", "/examples/", "/test_"];

/// Features that no package turns on in another when `cargo test` is called for all.
pub const OFF: &[&str] = &["foxglove", "libm", "ros2", "web"];

#[derive(Debug, Deserialize)]
pub struct Package {
    pub name: String,
    manifest_path: PathBuf,
    #[serde(default)]
    features: BTreeMap<String, Vec<String>>,
    /// `package.metadata` of the manifest; most packages have none.
    metadata: Option<Notes>,
}

/// What a manifest says to tools.
#[derive(Debug, Deserialize)]
struct Notes {
    mutants: Option<Mutants>,
}

#[derive(Debug, Deserialize)]
struct Mutants {
    /// Packages whose tests are this one's, too, since they can use what this one must not.
    #[serde(default)]
    judges: Vec<String>,
    #[serde(default)]
    left_out: Vec<LeftOut>,
}

/// A file in which no fault is drawn, since `cargo test` does not compile it, and something else tries it; or since its
/// faults may do harm.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct LeftOut {
    /// From the package's folder.
    path: PathBuf,
    /// Whether it is left out only of what root tries, to whom the system forbids nothing.
    #[serde(default)]
    as_root: bool,
    reason: String,
}

impl Package {
    pub fn folder(&self) -> &Path {
        self.manifest_path.parent().unwrap_or(Path::new("."))
    }

    /// The features that the package has when `cargo test` is called for all, each with the package's name before it: some tests
    /// are only there with them.
    pub fn features(&self) -> impl Iterator<Item = String> {
        let on = self.features.keys().filter(|feature| !OFF.contains(&feature.as_str()));
        on.map(|feature| format!("{}/{feature}", self.name))
    }

    /// The other packages whose tests judge this one: `[package.metadata.mutants] judges`.
    pub fn judges(&self) -> &[String] {
        let mutants = self.metadata.as_ref().and_then(|notes| notes.mutants.as_ref());
        mutants.map_or(&[], |mutants| &mutants.judges)
    }
}

/// How many faults manifests leave out.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct LeftOutCounts {
    /// In files that tests do not compile.
    pub not_compiled: usize,
    /// In files whose faults root must not try.
    pub as_root: usize,
}

/// Takes out the faults of files that manifests leave out; a file without a reason or without a fault is an error.
pub fn leave_out(
    faults: &mut Vec<Fault>,
    root: &Path,
    packages: &[Package],
    is_root: bool,
) -> Result<LeftOutCounts, Failure> {
    let mut counts = LeftOutCounts::default();
    for package in packages {
        let mutants = package.metadata.as_ref().and_then(|notes| notes.mutants.as_ref());
        for LeftOut { path, as_root, reason } in mutants.map_or(&[][..], |mutants| &mutants.left_out) {
            let file = package.folder().join(path);
            let there = faults.iter().filter(|fault| root.join(&fault.file) == file).count();
            if there == 0 || reason.trim().is_empty() {
                return Err(
                    format!("left out without a reason or without a fault: {}", file.display()).into()
                );
            }
            if *as_root && !is_root {
                continue;
            }
            faults.retain(|fault| root.join(&fault.file) != file);
            *if *as_root { &mut counts.as_root } else { &mut counts.not_compiled } += there;
        }
    }
    Ok(counts)
}

/// Whether root runs this. Who it is that runs it is asked of the system; if that does not say, it may be root.
pub fn is_root() -> bool {
    Command::new("id").arg("-u").output().map_or(true, |output| output.stdout.trim_ascii() == b"0")
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

/// The packages of the workspace in `root`.
pub fn packages(root: &Path) -> Result<Vec<Package>, Failure> {
    let output = Command::new("cargo")
        .args(["metadata", "--format-version=1", "--no-deps"])
        .current_dir(root)
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    Ok(serde_json::from_slice::<Metadata>(&output.stdout)?.packages)
}

/// All files that git knows or would take, from the root.
pub fn files(root: &Path) -> Result<Vec<String>, Failure> {
    let output = Command::new("git")
        .args(["ls-files", "--cached", "--others", "--exclude-standard", "-z"])
        .current_dir(root)
        .output()?;
    let names = String::from_utf8(output.stdout)?;
    let mut names: Vec<String> =
        names.split('\0').filter(|name| root.join(name).is_file()).map(str::to_owned).collect();
    names.sort();
    names.dedup();
    Ok(names)
}

/// The package that holds a file: the one of the nearest manifest above it. `None` in what the workspace leaves out.
pub fn package_of<'a>(root: &Path, packages: &'a [Package], file: &str) -> Option<&'a Package> {
    let file = root.join(file);
    let folder = file.ancestors().skip(1).find(|folder| folder.join("Cargo.toml").is_file())?;
    packages.iter().find(|package| package.folder() == folder)
}

/// Whether faults may be put into a file at all.
pub fn is_source(file: &str) -> bool {
    let in_sources = file.starts_with("src/") || file.contains("/src/");
    file.ends_with(".rs")
        && in_sources
        && !["tests/", "examples/", "benches/", "."].iter().any(|start| file.starts_with(start))
        && !NOT.iter().any(|part| file.contains(part))
}

/// Whether a file is drawn from when no package is asked for.
pub fn is_hot(file: &str) -> bool {
    HOT.iter().any(|start| file.starts_with(start))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_may_do_harm_is_left_out_of_what_root_tries() {
        let root = std::fs::canonicalize(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).expect("a folder");
        let packages = packages(&root).expect("a workspace");
        let harmful = "calibration/src/file/whole.rs";
        let faults = || {
            let mut faults = Vec::new();
            for file in files(&root).expect("files").iter().filter(|file| is_source(file)) {
                let text = std::fs::read_to_string(root.join(file)).expect("a source");
                faults.extend(crate::find::faults(file, &text).expect("Rust"));
            }
            faults
        };
        for is_root in [false, true] {
            let mut faults = faults();
            let counts = leave_out(&mut faults, &root, &packages, is_root).expect("true manifests");
            assert_eq!(counts.as_root > 0, is_root);
            assert!(counts.not_compiled > 0);
            assert_eq!(faults.iter().any(|fault| fault.file == harmful), !is_root);
        }
    }

    #[test]
    fn a_crate_that_the_workspace_leaves_out_belongs_to_none_of_its_packages() {
        let root = std::fs::canonicalize(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).expect("a folder");
        let packages = packages(&root).expect("a workspace");
        let name = |file| package_of(&root, &packages, file).map(|package| package.name.as_str());
        assert_eq!(name("src/lib.rs"), Some("fingertip"));
        assert_eq!(name("book/tool/src/main.rs"), Some("fingertip-book"));
        assert_eq!(name("book/playground/src/play.rs"), None);
    }
}
