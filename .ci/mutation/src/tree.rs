//! A copy of the workspace, with the switches of the faults in it.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::Failure;
use crate::fault::Fault;
use crate::splice::splice;

const RUNTIME: &str = include_str!("runtime.rs.txt");

/// Where faults stand in the files of the copy.
pub type Places = BTreeMap<PathBuf, Vec<(u32, Range<usize>)>>;

/// Copies `files` of `root` to `copy`, with the numbered faults. Files that would stay as they are are not
/// written, so that cargo compiles only what changed.
pub fn write(
    root: &Path,
    copy: &Path,
    files: &[String],
    faults: &BTreeMap<u32, Fault>,
) -> Result<Places, Failure> {
    let mut places = Places::new();
    remove_others(copy, copy, &files.iter().map(PathBuf::from).collect())?;
    for file in files {
        let to = copy.join(file);
        let bytes = std::fs::read(root.join(file))?;
        let here: Vec<(u32, &Fault)> =
            faults.iter().filter(|(_, fault)| fault.file == *file).map(|(n, fault)| (*n, fault)).collect();
        let content = if is_root(file) {
            let spliced = splice(&String::from_utf8(bytes)?, &here);
            places.insert(to.clone(), spliced.places);
            let path = "#[path = \"__mutation.rs\"]";
            format!("{}\n{path}\n#[allow(warnings, clippy::all)]\nmod __mutation;\n", spliced.text)
                .into_bytes()
        } else if !here.is_empty() {
            let spliced = splice(&String::from_utf8(bytes)?, &here);
            places.insert(to.clone(), spliced.places);
            spliced.text.into_bytes()
        } else if file.ends_with("Cargo.toml") {
            // Brackets that are not needed and the like are not what is judged here.
            String::from_utf8(bytes)?.replace("= \"deny\"", "= \"allow\"").into_bytes()
        } else {
            bytes
        };
        put(&to, &content)?;
        if is_root(file) {
            put(&to.with_file_name("__mutation.rs"), RUNTIME.as_bytes())?;
        }
    }
    Ok(places)
}

/// Removes what an earlier state of the workspace has left in the copy: cargo would find tests there.
fn remove_others(copy: &Path, folder: &Path, files: &BTreeSet<PathBuf>) -> Result<(), Failure> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(()) };
    for entry in entries {
        let path = entry?.path();
        if path.is_dir() {
            remove_others(copy, &path, files)?;
        } else if !path.ends_with("__mutation.rs") && !files.contains(path.strip_prefix(copy)?) {
            std::fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// The first file of a crate in which faults may stand.
fn is_root(file: &str) -> bool {
    crate::workspace::is_source(file)
        && (file.ends_with("/src/lib.rs") || file.ends_with("/src/main.rs") || file == "src/lib.rs")
        && !file.contains("/bin/")
}

fn put(path: &Path, content: &[u8]) -> Result<(), Failure> {
    if std::fs::read(path).is_ok_and(|there| there == content) {
        return Ok(());
    }
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    std::fs::write(path, content)?;
    Ok(())
}
