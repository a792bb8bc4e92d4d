//! The files that a scene names.

use core::cell::RefCell;
use std::path::{Path, PathBuf};

/// The folder in which the files of a scene are looked for, and those that were.
pub(crate) struct Folder<'a> {
    path: &'a Path,
    files: RefCell<Vec<PathBuf>>,
}

impl<'a> Folder<'a> {
    pub(crate) const fn new(path: &'a Path) -> Self {
        Self { path, files: RefCell::new(Vec::new()) }
    }

    /// Where a file is that the scene names.
    pub(crate) fn file(&self, name: &Path) -> PathBuf {
        let path = self.path.join(name);
        self.note(&path);
        path
    }

    /// Remembers a file that another one names.
    pub(crate) fn note(&self, path: &Path) {
        self.files.borrow_mut().push(path.to_owned());
    }

    /// All of them.
    pub(crate) fn into_files(self) -> Vec<PathBuf> {
        self.files.into_inner()
    }
}
