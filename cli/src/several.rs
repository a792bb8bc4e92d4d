//! Several recordings, one after the other, each with files of its own.

use std::path::{Path, PathBuf};

use crate::error::CliError;
use crate::output::printable;
use crate::standard::{is_standard, shown};

/// Does the same with each recording and its own files. One that is bad does not keep the others from being done: what
/// is wrong is said at once, and at the end how many were.
pub(crate) fn each<F>(
    recordings: &[PathBuf],
    files: &[F],
    run: impl Fn(&Path, &F) -> Result<(), CliError>,
) -> Result<(), CliError> {
    if let ([recording], [files]) = (recordings, files) {
        return run(recording, files);
    }
    let mut bad = 0;
    for (recording, files) in recordings.iter().zip(files) {
        match run(recording, files) {
            Ok(()) => {}
            // Nobody is there to be told of the others.
            Err(CliError::ClosedPipe) => return Err(CliError::ClosedPipe),
            Err(error) => {
                bad += 1;
                eprintln!("error: {}", printable(&error.to_string()));
            }
        }
    }
    if bad == 0 { Ok(()) } else { Err(CliError::Several { bad, of: recordings.len() }) }
}

/// The file that a recording writes: of one alone as it is named, of one of several `contacts.csv` is
/// `RECORDING.contacts.csv`.
pub(crate) fn file_of(recording: &Path, of: &[PathBuf], file: &Path) -> PathBuf {
    if of.len() < 2 || is_standard(file) {
        return file.to_owned();
    }
    let stem = if is_standard(recording) { None } else { recording.file_stem() };
    let stem = stem.map_or_else(|| shown(recording), |stem| stem.to_string_lossy().into_owned());
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    file.with_file_name(format!("{stem}.{name}"))
}

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};

    use super::file_of;

    #[test]
    fn each_of_several_recordings_has_files_of_its_own() {
        let recordings = ["runs/a.csv", "b.mcap", "-"].map(PathBuf::from);
        let files = |file: &str| recordings.each_ref().map(|one| file_of(one, &recordings, Path::new(file)));
        let named = ["out/a.contacts.csv", "out/b.contacts.csv", "out/standard input.contacts.csv"];
        assert_eq!(files("out/contacts.csv"), named.map(PathBuf::from));
        assert_eq!(files("-"), ["-"; 3].map(PathBuf::from));
        let alone = [PathBuf::from("a.csv")];
        assert_eq!(file_of(&alone[0], &alone, Path::new("contacts.csv")), Path::new("contacts.csv"));
    }
}
