//! A recording that is read: a file, or the standard input; CSV or MCAP, by what stands in it.

use std::fs::{self, File};
use std::io::{self, BufReader, Chain, Cursor, Read};
use std::path::{Path, PathBuf};

use fingertip_recordings::mcap::McapReader;
use fingertip_recordings::{ReaderOptions, RecordingReader};
use tempfile::NamedTempFile;

use crate::error::CliError;
use crate::recording_file::{Kind, mcap};
use crate::standard::{is_standard, shown};
use crate::verbosity::detail;

/// How an MCAP file begins.
const MCAP: &[u8] = b"\x89MCAP0\r\n";
/// How a database begins, as older bags of ROS 2 are.
const SQLITE: &[u8] = b"SQLite format 3\0";

/// A recording, known by its first bytes.
pub(crate) struct Input {
    path: PathBuf,
    kind: Kind,
    from: From,
}

/// Where it comes from.
enum From {
    File,
    /// The standard input, and what was taken of it already; it can be read once.
    Stdin(Vec<u8>),
    /// The standard input, kept to be read twice.
    Kept(NamedTempFile),
}

/// Bytes of text, from the start.
pub(crate) enum Text {
    File(File),
    Stdin(Chain<Cursor<Vec<u8>>, io::Stdin>),
}

impl Read for Text {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::File(file) => file.read(buffer),
            Self::Stdin(stdin) => stdin.read(buffer),
        }
    }
}

impl Input {
    /// Looks at the start of a recording; `-` is the standard input.
    pub(crate) fn open(path: &Path) -> Result<Self, CliError> {
        let fault = |source| CliError::read("recording", path, source);
        let path = path.to_owned();
        if is_standard(&path) {
            let mut start = Vec::new();
            io::stdin().take(16).read_to_end(&mut start).map_err(fault)?;
            if kind(&path, &start)? == Kind::Csv {
                return Ok(Self { path, kind: Kind::Csv, from: From::Stdin(start) });
            }
            let mut kept = NamedTempFile::new().map_err(fault)?;
            io::copy(&mut Cursor::new(start).chain(io::stdin()), &mut kept).map_err(fault)?;
            return Ok(Self { path, kind: Kind::Mcap, from: From::Kept(kept) });
        }
        let meta = fs::metadata(&path).map_err(fault)?;
        detail(|| format!("reads recording {}: {} bytes", shown(&path), meta.len()));
        if meta.is_dir() {
            let bag = path.join("metadata.yaml").exists();
            return Err(if bag {
                CliError::BagFolder { path }
            } else {
                fault(io::ErrorKind::IsADirectory.into())
            });
        }
        // What is no file can be read but once: its name says what it is.
        let kind = if meta.is_file() {
            let mut start = Vec::new();
            File::open(&path).and_then(|file| file.take(16).read_to_end(&mut start)).map_err(fault)?;
            kind(&path, &start)?
        } else {
            Kind::of(&path).unwrap_or(Kind::Csv)
        };
        Ok(Self { path, kind, from: From::File })
    }

    /// Has what can be read but once kept, to be read twice.
    pub(crate) fn keep(&mut self) -> Result<(), CliError> {
        if self.length().is_none() && !matches!(self.from, From::Kept(_)) {
            let mut kept = NamedTempFile::new().map_err(|source| self.fault(source))?;
            let mut text = self.text()?;
            io::copy(&mut text, &mut kept).map_err(|source| self.fault(source))?;
            self.from = From::Kept(kept);
        }
        Ok(())
    }

    fn fault(&self, source: io::Error) -> CliError {
        CliError::read("recording", &self.path, source)
    }

    pub(crate) const fn kind(&self) -> Kind {
        self.kind
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Its length, if it is a file.
    pub(crate) fn length(&self) -> Option<u64> {
        let file = matches!(self.from, From::File).then(|| fs::metadata(&self.path).ok()).flatten();
        file.filter(fs::Metadata::is_file).map(|meta| meta.len())
    }

    /// The text of a CSV, from its start.
    pub(crate) fn text(&mut self) -> Result<Text, CliError> {
        match &mut self.from {
            From::Stdin(start) => Ok(Text::Stdin(Cursor::new(core::mem::take(start)).chain(io::stdin()))),
            From::Kept(_) | From::File => self.bytes().map(Text::File),
        }
    }

    /// The bytes, from the start; of a standard input, those that were kept.
    fn bytes(&self) -> Result<File, CliError> {
        let file = match &self.from {
            From::Kept(kept) => kept.reopen(),
            From::File | From::Stdin(_) => File::open(&self.path),
        };
        file.map_err(|source| self.fault(source))
    }

    /// The rows of a CSV.
    pub(crate) fn rows(&mut self, options: ReaderOptions) -> Result<RecordingReader<Text>, CliError> {
        let text = self.text()?;
        Ok(RecordingReader::with_options(self.name(), text, options)?)
    }

    /// The bytes of an MCAP file, from the start.
    pub(crate) fn messages(&self) -> Result<BufReader<File>, CliError> {
        self.bytes().map(BufReader::new)
    }

    /// The entries of an MCAP file, from the start.
    pub(crate) fn entries(&self) -> Result<McapReader<BufReader<File>>, CliError> {
        McapReader::new(self.messages()?).map_err(|error| mcap(&self.path, &error))
    }

    /// What messages call it.
    pub(crate) fn name(&self) -> String {
        shown(&self.path)
    }
}

/// What the first bytes say.
fn kind(path: &Path, start: &[u8]) -> Result<Kind, CliError> {
    let named = Kind::of(path);
    let ends = |ending: &str| path.extension().is_some_and(|end| end.eq_ignore_ascii_case(ending));
    if start.starts_with(SQLITE) || ends("db3") {
        Err(CliError::Bag { path: path.to_owned() })
    } else if start.starts_with(MCAP) {
        Ok(Kind::Mcap)
    } else if matches!(named, Ok(Kind::Mcap)) {
        Err(CliError::NoMcap { path: path.to_owned() })
    } else {
        Ok(Kind::Csv)
    }
}
