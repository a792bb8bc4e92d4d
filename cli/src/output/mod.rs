//! What a run leaves: words on the standard output, and files that are none of those it has read.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::error::CliError;

/// Prints to the standard output, at once.
pub(crate) fn print(text: &str) -> Result<(), CliError> {
    let mut stdout = io::stdout();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(CliError::stdout)
}

/// Prints a text, what to mind, and what was written.
pub(crate) fn say(text: &str, notes: &[String], files: &[PathBuf]) -> Result<(), CliError> {
    let mut text = text.to_owned();
    for note in notes {
        text.push_str(&format!("note: {note}\n"));
    }
    if !files.is_empty() {
        text.push_str(&format!("\n{}", written(files)));
    }
    print(&text)
}

/// The line that names what was written.
pub(crate) fn written<P: AsRef<Path>>(files: impl IntoIterator<Item = P>) -> String {
    let list: Vec<String> = files.into_iter().map(|path| path.as_ref().display().to_string()).collect();
    format!("Written: {}\n", list.join(", "))
}

/// Writes a file of text.
pub(crate) fn write(what: &'static str, path: &Path, text: &str) -> Result<(), CliError> {
    fs::write(path, text).map_err(|source| CliError::write(what, path, source))
}

/// Writes a file of text that is not there yet: what a user has written by hand is not lost.
pub(crate) fn write_new(what: &'static str, path: &Path, text: &str) -> Result<(), CliError> {
    let file = fs::File::create_new(path);
    file.and_then(|mut file| file.write_all(text.as_bytes()))
        .map_err(|source| CliError::write(what, path, source))
}

/// Refuses to write over what is read; `what` the outputs are is for the message.
pub(crate) fn guard<'a>(
    what: &'static str,
    inputs: impl IntoIterator<Item = &'a PathBuf>,
    outputs: impl IntoIterator<Item = &'a PathBuf>,
) -> Result<(), CliError> {
    let inputs: Vec<PathBuf> = inputs.into_iter().filter_map(|input| fs::canonicalize(input).ok()).collect();
    for output in outputs {
        let Ok(place) = fs::canonicalize(output) else { continue };
        // A device may well be read and written.
        let file = fs::metadata(&place).is_ok_and(|meta| meta.is_file());
        if file && inputs.contains(&place) {
            return Err(CliError::WouldOverwrite { what, path: output.clone() });
        }
    }
    Ok(())
}
