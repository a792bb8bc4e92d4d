//! What can go wrong, each in a sentence that says how to mend it.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why nothing was made.
#[derive(Debug, Error)]
pub(crate) enum Failure {
    #[error("{path}: {source}", path = .path.display())]
    File { path: PathBuf, source: io::Error },
    #[error("mdBook gave a book that is not understood: {0}")]
    Book(String),
    #[error("{0} dead links; mend each of the above")]
    DeadLinks(usize),
    #[error("{0} pages are stale; run `fingertip-book {1}` and commit what it writes")]
    Stale(usize, &'static str),
    #[error("{0}")]
    Command(String),
    #[error("{0} tutorials do not do what they tell")]
    Tutorials(usize),
}

impl Failure {
    pub(crate) fn file(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::File { path: path.to_owned(), source }
    }
}
