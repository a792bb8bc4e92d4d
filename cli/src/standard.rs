//! The standard input and output by their name.

use std::path::Path;

/// Whether a path is the standard input or output.
pub(crate) fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// What titles call an input: its name without its folder.
pub(crate) fn name_of(path: &Path) -> String {
    let named = path.file_name().filter(|_| !is_standard(path));
    named.map_or_else(|| shown(path), |name| name.to_string_lossy().into_owned())
}

/// What messages call an input.
pub(crate) fn shown(path: &Path) -> String {
    if is_standard(path) { "standard input".to_owned() } else { path.display().to_string() }
}
