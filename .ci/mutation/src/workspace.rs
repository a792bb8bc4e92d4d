//! The packages of the workspace and the sources in which faults are put.

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

#[derive(Debug, Deserialize)]
pub struct Package {
    pub name: String,
    manifest_path: PathBuf,
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

/// A file in which no fault is drawn, since `cargo test` does not compile it: something else tries it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct LeftOut {
    /// From the package's folder.
    path: PathBuf,
    reason: String,
}

impl Package {
    pub fn folder(&self) -> &Path {
        self.manifest_path.parent().unwrap_or(Path::new("."))
    }

    /// The other packages whose tests judge this one: `[package.metadata.mutants] judges`.
    pub fn judges(&self) -> &[String] {
        let mutants = self.metadata.as_ref().and_then(|notes| notes.mutants.as_ref());
        mutants.map_or(&[], |mutants| &mutants.judges)
    }
}

/// Takes out the faults of files that manifests leave out, and says how many; a file without a reason or without a
/// fault is an error.
pub fn leave_out(faults: &mut Vec<Fault>, root: &Path, packages: &[Package]) -> Result<usize, Failure> {
    let before = faults.len();
    for package in packages {
        let mutants = package.metadata.as_ref().and_then(|notes| notes.mutants.as_ref());
        for LeftOut { path, reason } in mutants.map_or(&[][..], |mutants| &mutants.left_out) {
            let file = package.folder().join(path);
            let all = faults.len();
            faults.retain(|fault| root.join(&fault.file) != file);
            if faults.len() == all || reason.trim().is_empty() {
                return Err(
                    format!("left out without a reason or without a fault: {}", file.display()).into()
                );
            }
        }
    }
    Ok(before - faults.len())
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
    fn a_crate_that_the_workspace_leaves_out_belongs_to_none_of_its_packages() {
        let root = std::fs::canonicalize(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).expect("a folder");
        let packages = packages(&root).expect("a workspace");
        let name = |file| package_of(&root, &packages, file).map(|package| package.name.as_str());
        assert_eq!(name("src/lib.rs"), Some("fingertip"));
        assert_eq!(name("book/tool/src/main.rs"), Some("fingertip-book"));
        assert_eq!(name("book/playground/src/play.rs"), None);
    }
}
