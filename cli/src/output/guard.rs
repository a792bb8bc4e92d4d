//! Which files are the same, by whatever names.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use same_file::Handle;

use super::standard::is_standard;
use super::whole::already_there;
use crate::error::CliError;

/// What a name leads to.
#[derive(PartialEq, Eq)]
enum Place {
    /// A file that is there, by device and number: links to it are the same.
    There(Handle),
    /// A file that is not there, by its folder and name.
    New(Handle, PathBuf),
}

impl Place {
    /// `None` for what may well be read and written, and twice: a device, a pipe; and where nobody may look.
    fn of(path: &Path) -> Option<Self> {
        if is_standard(path) {
            return None;
        }
        match fs::metadata(path) {
            Ok(meta) if !meta.is_file() => None,
            Ok(_) => Handle::from_path(path).ok().map(Self::There),
            Err(_) => {
                let folder = path.parent().filter(|folder| *folder != Path::new(""));
                let folder = Handle::from_path(folder.unwrap_or(Path::new("."))).ok()?;
                Some(Self::New(folder, path.file_name().map(OsStr::to_owned)?.into()))
            }
        }
    }
}

/// Refuses outputs that are inputs, that are one file, or that are there already and are not to be written over.
pub(super) fn check(
    overwrite: bool,
    what: &'static str,
    inputs: &[&Path],
    outputs: &[&Path],
) -> Result<(), CliError> {
    if inputs.iter().filter(|input| is_standard(input)).count() > 1 {
        return Err(CliError::StdinTwice);
    }
    let inputs: Vec<Place> = inputs.iter().filter_map(|input| Place::of(input)).collect();
    let mut taken: Vec<(Place, &Path)> = Vec::new();
    let mut standard = false;
    for output in outputs {
        if is_standard(output) {
            if standard {
                return Err(CliError::StdoutTwice);
            }
            standard = true;
        }
        let Some(place) = Place::of(output) else { continue };
        if inputs.contains(&place) {
            return Err(CliError::WouldOverwrite { what, path: output.into() });
        }
        if let Some((_, first)) = taken.iter().find(|(known, _)| *known == place) {
            return Err(CliError::OneFile { first: first.into(), second: output.into() });
        }
        if !overwrite && matches!(place, Place::There(_)) {
            return Err(CliError::write(what, output, already_there()));
        }
        taken.push((place, output));
    }
    Ok(())
}
