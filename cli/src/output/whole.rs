//! The files of a run, which appear whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use fingertip_calibration::file::{Existing, WholeFile};

use super::unfinished::remember;
use crate::error::CliError;
use crate::standard::is_standard;
use crate::verbosity::detail;

/// A file that takes its place when it is [finished](Self::finish), and is taken away by an interruption; `-` is the standard
/// output. What must go back in them to write is collected first ([`seekable`](Self::seekable)).
#[derive(Debug)]
pub(crate) struct Whole {
    out: Out,
    what: &'static str,
    path: PathBuf,
}

#[derive(Debug)]
enum Out {
    File(WholeFile),
    Stdout(io::Stdout),
    /// A stream that cannot go back, and what will be written into it.
    Collected {
        whole: BufWriter<File>,
        stream: Box<Self>,
    },
}

/// That a file exists, and what to do.
pub(super) fn already_there() -> io::Error {
    io::Error::new(io::ErrorKind::AlreadyExists, "it exists already; give another name, or --overwrite")
}

impl Whole {
    pub(super) fn create(what: &'static str, path: &Path, overwrite: bool) -> Result<Self, CliError> {
        let out = if is_standard(path) {
            Out::Stdout(io::stdout())
        } else {
            Out::open(path, overwrite).map_err(|source| CliError::write(what, path, source))?
        };
        Ok(Self { out, what, path: path.to_owned() })
    }

    /// For a format that writes lengths into what stands before: a stream, which cannot go back, is given all at the end.
    pub(crate) fn seekable(mut self) -> Result<Self, CliError> {
        if self.stream_position().is_err() {
            let fault = |source| CliError::write(self.what, &self.path, source);
            let whole = tempfile::tempfile().map_err(fault)?;
            self.out = Out::Collected { whole: BufWriter::new(whole), stream: Box::new(self.out) };
        }
        Ok(self)
    }

    /// Puts the file into its place.
    pub(crate) fn finish(self) -> Result<(), CliError> {
        let Self { out, what, path } = self;
        out.finish().map_err(|source| CliError::write(what, &path, source))?;
        detail(|| match fs::metadata(&path) {
            Ok(meta) => format!("wrote {what} {}: {} bytes", path.display(), meta.len()),
            Err(_) => format!("wrote {what}"),
        });
        Ok(())
    }
}

impl Out {
    fn open(path: &Path, overwrite: bool) -> io::Result<Self> {
        let existing = if overwrite { Existing::Replace } else { Existing::Keep };
        let file = WholeFile::create(path, existing).map_err(told)?;
        file.beside().into_iter().for_each(remember);
        Ok(Self::File(file))
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Stdout(mut stdout) => stdout.flush(),
            Self::Collected { mut whole, mut stream } => {
                whole.rewind()?;
                io::copy(whole.get_mut(), &mut stream)?;
                stream.finish()
            }
            Self::File(file) => file.finish().map_err(told),
        }
    }
}

/// What to do about a file that exists is told with it.
fn told(error: io::Error) -> io::Error {
    if error.kind() == io::ErrorKind::AlreadyExists { already_there() } else { error }
}

impl Write for Out {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::File(file) => file.write(bytes),
            Self::Stdout(stdout) => stdout.write(bytes),
            Self::Collected { whole, .. } => whole.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::File(file) => file.flush(),
            Self::Stdout(stdout) => stdout.flush(),
            Self::Collected { whole, .. } => whole.flush(),
        }
    }
}

impl Write for Whole {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl Seek for Whole {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match &mut self.out {
            Out::File(file) => file.seek(to),
            Out::Stdout(_) => Err(io::ErrorKind::NotSeekable.into()),
            Out::Collected { whole, .. } => whole.seek(to),
        }
    }
}
