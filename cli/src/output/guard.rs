//! Which files are the same, by whatever names.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use super::whole::already_there;
use crate::error::CliError;
use crate::standard::is_standard;

/// A file or a folder, by device and number: links to it are the same.
#[cfg(unix)]
type Identity = (u64, u64);
/// A file or a folder, by its name without links.
#[cfg(not(unix))]
type Identity = PathBuf;

/// What a name leads to.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Place {
    /// A file that is there.
    There(Identity),
    /// A file that is not there, by its folder and name.
    New(Identity, PathBuf),
}

/// Nothing is kept open: of hundreds of recordings each has outputs of its own.
#[cfg(unix)]
fn identity(path: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt as _;
    fs::metadata(path).ok().map(|meta| (meta.dev(), meta.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<Identity> {
    fs::canonicalize(path).ok()
}

impl Place {
    /// `None` for what may well be read and written, and twice: a device, a pipe; and where nobody may look.
    fn of(path: &Path) -> Option<Self> {
        if is_standard(path) {
            return None;
        }
        match fs::metadata(path) {
            Ok(meta) if !meta.is_file() => None,
            Ok(_) => identity(path).map(Self::There),
            Err(_) => {
                let folder = path.parent().filter(|folder| *folder != Path::new(""));
                let folder = identity(folder.unwrap_or(Path::new(".")))?;
                Some(Self::New(folder, path.file_name().map(OsStr::to_owned)?.into()))
            }
        }
    }
}

/// The outputs of a run, to be compared with its inputs.
#[derive(Clone, Debug, Default)]
pub(super) struct Taken {
    what: &'static str,
    places: Vec<(Place, PathBuf)>,
}

impl Taken {
    /// Refuses an input that is an output.
    pub(super) fn spare(&self, input: &Path) -> Result<(), CliError> {
        let Some(place) = Place::of(input) else { return Ok(()) };
        match self.places.iter().find(|(taken, _)| *taken == place) {
            Some((_, output)) => Err(CliError::WouldOverwrite { what: self.what, path: output.clone() }),
            None => Ok(()),
        }
    }
}

/// Refuses to read the standard input for two inputs.
pub(crate) fn read_once<'a>(inputs: impl IntoIterator<Item = &'a Path>) -> Result<(), CliError> {
    match inputs.into_iter().filter(|input| is_standard(input)).nth(1) {
        Some(_) => Err(CliError::StdinTwice),
        None => Ok(()),
    }
}

/// Refuses outputs that are inputs, that are one file, or that are there already and are not to be written over.
pub(super) fn check(
    overwrite: bool,
    what: &'static str,
    inputs: &[&Path],
    outputs: &[&Path],
) -> Result<Taken, CliError> {
    read_once(inputs.iter().copied())?;
    let inputs: Vec<Place> = inputs.iter().filter_map(|input| Place::of(input)).collect();
    let mut taken = Taken { what, places: Vec::new() };
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
        if let Some((_, first)) = taken.places.iter().find(|(known, _)| *known == place) {
            return Err(CliError::OneFile { first: first.into(), second: output.into() });
        }
        if !overwrite && matches!(place, Place::There(_)) {
            return Err(CliError::write(what, output, already_there()));
        }
        taken.places.push((place, output.into()));
    }
    Ok(taken)
}
