//! Files that are made: written, or compared with those that are there.

use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// A file by its path in the book's sources.
pub(crate) struct Made {
    pub(crate) path: &'static str,
    pub(crate) text: String,
}

/// The folder of the book's sources.
pub(crate) fn sources() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../src")
}

/// Writes the files, or with `check` fails if one is another than it would be; `by` is the command that writes
/// them.
pub(crate) fn settle(made: &[Made], by: &'static str, check: bool) -> Result<(), Failure> {
    let mut stale = 0;
    for Made { path, text } in made {
        let place = sources().join(path);
        if check {
            let there = std::fs::read_to_string(&place).unwrap_or_default();
            if there != *text {
                let line = there.lines().zip(text.lines()).position(|(old, new)| old != new);
                let line = line.unwrap_or_else(|| there.lines().count().min(text.lines().count()));
                eprintln!("stale: book/src/{path}, from line {}", line + 1);
                stale += 1;
            }
            continue;
        }
        if let Some(folder) = place.parent() {
            std::fs::create_dir_all(folder).map_err(Failure::file(folder))?;
        }
        std::fs::write(&place, text).map_err(Failure::file(&place))?;
    }
    if stale > 0 { Err(Failure::Stale(stale, by)) } else { Ok(()) }
}
