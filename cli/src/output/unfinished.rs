//! The files that are being written, so that an interruption can take them away.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The names beside the places of all files that were begun, of the whole program, since an interruption is of the whole
/// program. Of a file that is in its place, nothing has that name any more.
static BEGUN: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Remembers a file that is begun beside its place.
pub(super) fn remember(path: &Path) {
    BEGUN.lock().unwrap_or_else(PoisonError::into_inner).push(path.to_owned());
}

/// Takes away those that are not in their places. The program ends behind it: no other begins while the list is held.
pub(crate) fn remove_all(end: impl FnOnce()) {
    let all = BEGUN.lock().unwrap_or_else(PoisonError::into_inner);
    for path in all.iter() {
        let _ = fs::remove_file(path);
    }
    end();
}
