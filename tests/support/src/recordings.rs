//! Recordings made by others, which tests use where they are present.

use core::fmt::Display;
use std::io::Write;
use std::path::PathBuf;

/// The path of a recording in the data folder: `FINGERTIP_DATA`, or `../shared/data` beside the workspace.
///
/// `None` where it is absent. That is said at once on standard error, past the capture of a test's output,
/// as a line that starts with "skipped: "; the gate counts these lines.
pub fn recording(path: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("FINGERTIP_DATA").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
        PathBuf::from,
    );
    let found = folder.join(path);
    if found.exists() {
        return Some(found);
    }
    say_skipped(path);
    None
}

/// The text of a [`recording`].
///
/// # Panics
///
/// If the file is there and cannot be read as text.
pub fn recording_text(path: &str) -> Option<String> {
    recording(path).map(|file| std::fs::read_to_string(file).expect("a recording is text"))
}

/// Written in one piece, so that tests that skip beside each other do not mix their lines. What `println`
/// says, the test runner would keep for itself.
fn say_skipped(what: impl Display) {
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test");
    let line = format!("\nskipped: {test}: {what} is not in the data folder (FINGERTIP_DATA)\n");
    // Where standard error is closed nobody listens.
    let _ = std::io::stderr().write_all(line.as_bytes());
}
