//! A file that appears whole or not at all.

use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use super::standard::is_standard;
use super::unfinished::Unfinished;
use crate::error::CliError;
use crate::verbosity::detail;

/// A file that is written beside its place, as `name.unfinished-….ending`, and takes it when it is
/// [finished](Self::finish); until then, and if it never is, whatever was there stays. Devices and pipes are written
/// where they are, and `-` is the standard output; what must go back in them to write is collected first
/// ([`seekable`](Self::seekable)).
#[derive(Debug)]
pub(crate) struct Whole {
    out: Out,
    what: &'static str,
    path: PathBuf,
    overwrite: bool,
}

#[derive(Debug)]
enum Out {
    Beside {
        file: BufWriter<NamedTempFile>,
        place: PathBuf,
        listed: Unfinished,
    },
    Device(BufWriter<File>),
    Stdout(io::Stdout),
    /// A stream that cannot go back, and what will be written into it.
    Collected {
        whole: BufWriter<File>,
        stream: Box<Self>,
    },
}

/// Files that links may lead through.
const LINKS: usize = 40;

/// What a name leads to, if links lead on.
fn followed(path: &Path) -> PathBuf {
    let mut place = path.to_owned();
    for _ in 0..LINKS {
        let Ok(link) = fs::read_link(&place) else { break };
        place = place.parent().unwrap_or(Path::new("")).join(link);
    }
    place
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
        Ok(Self { out, what, path: path.to_owned(), overwrite })
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
        let Self { out, what, path, overwrite } = self;
        out.finish(overwrite).map_err(|source| CliError::write(what, &path, source))?;
        detail(|| match fs::metadata(&path) {
            Ok(meta) => format!("wrote {what} {}: {} bytes", path.display(), meta.len()),
            Err(_) => format!("wrote {what}"),
        });
        Ok(())
    }
}

impl Out {
    fn open(path: &Path, overwrite: bool) -> io::Result<Self> {
        let place = followed(path);
        let there = fs::metadata(&place).ok();
        if there.as_ref().is_some_and(|meta| !meta.is_file() && !meta.is_dir()) {
            return OpenOptions::new().write(true).open(&place).map(BufWriter::new).map(Self::Device);
        }
        if there.as_ref().is_some_and(fs::Metadata::is_dir) {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if there.is_some() && !overwrite {
            return Err(already_there());
        }
        let stem = place.file_stem().map(OsStr::to_string_lossy).unwrap_or_default();
        let prefix = format!("{stem}.unfinished-");
        let ending = place.extension().map(|ending| format!(".{}", ending.to_string_lossy()));
        let ending = ending.unwrap_or_default();
        let mut builder = Builder::new();
        builder.prefix(&prefix).suffix(&ending);
        // As any other file is made, or as the one that it replaces.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let folder = place.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
        let file = builder.tempfile_in(folder).map_err(plain)?;
        if let Some(meta) = there {
            // A file that may not be written is not to be replaced either.
            OpenOptions::new().append(true).open(&place)?;
            file.as_file().set_permissions(meta.permissions())?;
        }
        let listed = Unfinished::new(file.path());
        Ok(Self::Beside { file: BufWriter::with_capacity(1 << 16, file), place, listed })
    }

    fn finish(self, overwrite: bool) -> io::Result<()> {
        match self {
            Self::Stdout(mut stdout) => stdout.flush(),
            Self::Device(mut file) => file.flush(),
            Self::Collected { mut whole, mut stream } => {
                whole.rewind()?;
                io::copy(whole.get_mut(), &mut stream)?;
                stream.finish(overwrite)
            }
            Self::Beside { file, place, listed } => {
                let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
                // A name must not be on the disk before what it names.
                file.as_file().sync_all()?;
                let put = if overwrite { file.persist(&place) } else { file.persist_noclobber(&place) };
                drop(listed);
                put.map(drop).map_err(|error| match error.error.kind() {
                    io::ErrorKind::AlreadyExists => already_there(),
                    _ => error.error,
                })
            }
        }
    }
}

/// An error without the name of the temporary file, which the user never gave.
fn plain(error: io::Error) -> io::Error {
    error.kind().into()
}

impl Write for Out {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Beside { file, .. } => file.write(bytes),
            Self::Device(file) => file.write(bytes),
            Self::Stdout(stdout) => stdout.write(bytes),
            Self::Collected { whole, .. } => whole.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Beside { file, .. } => file.flush(),
            Self::Device(file) => file.flush(),
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
            Out::Beside { file, .. } => file.seek(to),
            Out::Device(file) => file.seek(to),
            Out::Stdout(_) => Err(io::ErrorKind::NotSeekable.into()),
            Out::Collected { whole, .. } => whole.seek(to),
        }
    }
}
