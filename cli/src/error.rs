//! What can stop a run, each in one sentence: what is wrong, where, and how to mend it.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a run stopped.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    /// A file that is to be read cannot be.
    #[error("cannot read {what} {path}: {source}; check the path and its permissions", path = .path.display())]
    Read { what: &'static str, path: PathBuf, source: io::Error },
    /// A file that is to be written cannot be.
    #[error(
        "cannot write {what} {path}: {source}; choose a folder that exists and may be written to",
        path = .path.display()
    )]
    Write { what: &'static str, path: PathBuf, source: io::Error },
    /// An output would overwrite an input.
    #[error("{what} {path} is also an input of this run and would be overwritten; give another path", path = .path.display())]
    WouldOverwrite { what: &'static str, path: PathBuf },
    /// The scene does not say what it must.
    #[error("scene {path}{place}: {message}", path = .path.display())]
    Scene { path: PathBuf, place: Place, message: String },
    /// The recording cannot be used.
    #[error("recording {path}: {message}", path = .path.display())]
    Recording { path: PathBuf, message: String },
    /// The calibration cannot be used.
    #[error("calibration {path}: {message}", path = .path.display())]
    Calibration { path: PathBuf, message: String },
    /// The simulated fingertip or a stage of the demo could not be built.
    #[error("the demo cannot run: {message}")]
    Demo { message: String },
    /// Whoever read our standard output has gone: not a fault.
    #[error("the reader of the standard output has closed it")]
    ClosedPipe,
    /// The standard output cannot be written for another reason.
    #[error("cannot write to the standard output: {0}; check where it is redirected to")]
    Stdout(io::Error),
}

/// A line of a text file, if it is known.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Place(pub(crate) Option<usize>);

impl core::fmt::Display for Place {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self.0 {
            Some(line) => write!(formatter, ", line {line}"),
            None => Ok(()),
        }
    }
}

impl CliError {
    pub(crate) fn read(what: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Read { what, path: path.to_owned(), source }
    }

    pub(crate) fn write(what: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Write { what, path: path.to_owned(), source }
    }

    /// What went wrong with the standard output.
    pub(crate) fn stdout(source: io::Error) -> Self {
        if source.kind() == io::ErrorKind::BrokenPipe { Self::ClosedPipe } else { Self::Stdout(source) }
    }
}
