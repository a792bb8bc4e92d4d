//! Files that appear whole or not at all.

use std::ffi::OsStr;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

/// Files that links may lead through.
const LINKS: usize = 40;

/// Bytes that are collected before they are written.
const BUFFER: usize = 1 << 16;

/// What becomes of a file that is there already.
///
/// ```
/// use fingertip_calibration::file::{Existing, WholeFile};
/// use std::io::{ErrorKind, Write as _};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("report.html");
/// for (existing, text) in [(Existing::Keep, "first"), (Existing::Replace, "second")] {
///     let mut file = WholeFile::create(&path, existing)?;
///     file.write_all(text.as_bytes())?;
///     file.finish()?;
/// }
/// assert_eq!(std::fs::read_to_string(&path)?, "second");
/// // What is there is not written over unless that is said.
/// let refused = WholeFile::create(&path, Existing::Keep).and_then(WholeFile::finish);
/// assert!(refused.is_err_and(|error| error.kind() == ErrorKind::AlreadyExists));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Existing {
    /// It is replaced when the new one is whole; the new one has its rights.
    Replace,
    /// It stays, and the new one is refused with [`io::ErrorKind::AlreadyExists`].
    Keep,
}

/// A file that is written beside its place, as `NAME.unfinished-….ENDING`, and takes it when it is
/// [finished](Self::finish). Until then, and if it never is, whatever was there stays: what a run that was killed or a full
/// disk leaves is not under the name that was asked for. Dropped unfinished, it is taken away again.
///
/// Links are followed, so that they stay links. A device or a pipe is written where it is.
///
/// ```
/// use std::io::Write;
/// use fingertip_calibration::file::{Existing, WholeFile};
///
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("tip.toml");
/// let mut file = WholeFile::create(&path, Existing::Keep)?;
/// file.write_all(b"name = \"tip\"\n")?;
/// assert!(!path.exists());
/// file.finish()?;
/// assert_eq!(std::fs::read_to_string(&path)?, "name = \"tip\"\n");
/// assert!(WholeFile::create(&path, Existing::Keep).is_err());
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct WholeFile {
    to: To,
    existing: Existing,
}

#[derive(Debug)]
enum To {
    Beside { file: BufWriter<NamedTempFile>, place: PathBuf },
    Device(BufWriter<File>),
}

/// Who may read a new file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Readers {
    AsEver,
    OwnerAlone,
}

impl WholeFile {
    /// Begins a file, which others may read as any other file.
    ///
    /// # Errors
    /// Those of the system, without the name of the file beside; [`io::ErrorKind::AlreadyExists`].
    pub fn create(path: impl AsRef<Path>, existing: Existing) -> io::Result<Self> {
        Self::open(path.as_ref(), existing, Readers::AsEver)
    }

    /// Begins a file which its owner alone may read or write, from its first byte on.
    ///
    /// # Errors
    /// As [`create`](Self::create).
    pub fn create_private(path: impl AsRef<Path>, existing: Existing) -> io::Result<Self> {
        Self::open(path.as_ref(), existing, Readers::OwnerAlone)
    }

    fn open(path: &Path, existing: Existing, readers: Readers) -> io::Result<Self> {
        let place = followed(path);
        let there = fs::metadata(&place).ok();
        let to = match &there {
            Some(meta) if meta.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
            Some(meta) if !meta.is_file() => {
                To::Device(OpenOptions::new().write(true).open(&place).map(buffered)?)
            }
            Some(_) if existing == Existing::Keep => return Err(io::ErrorKind::AlreadyExists.into()),
            _ => To::Beside { file: buffered(beside(&place, there.as_ref(), readers)?), place },
        };
        Ok(Self { to, existing })
    }

    /// The file beside that is being written; a device has none.
    #[must_use]
    pub fn beside(&self) -> Option<&Path> {
        match &self.to {
            To::Beside { file, .. } => Some(file.get_ref().path()),
            To::Device(_) => None,
        }
    }

    /// Puts the file into its place, once it is on the disk.
    ///
    /// # Errors
    /// Those of the system: the place then holds what it held before. [`io::ErrorKind::AlreadyExists`] if a file that is to
    /// be [kept](Existing::Keep) has appeared meanwhile.
    pub fn finish(self) -> io::Result<()> {
        match self.to {
            To::Device(mut file) => file.flush(),
            To::Beside { file, place } => {
                let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
                // A name must not be on the disk before what it names.
                file.as_file().sync_all()?;
                let put = match self.existing {
                    Existing::Replace => file.persist(&place),
                    Existing::Keep => file.persist_noclobber(&place),
                };
                put.map(drop).map_err(|error| error.error)
            }
        }
    }
}

/// Writes a file whole or not at all, in the place of any that is there.
///
/// # Errors
/// Those of the system: then the place holds what it held before.
pub fn write_whole(path: impl AsRef<Path>, contents: impl AsRef<[u8]>) -> io::Result<()> {
    let mut file = WholeFile::create(path, Existing::Replace)?;
    file.write_all(contents.as_ref())?;
    file.finish()
}

fn buffered<W: Write>(file: W) -> BufWriter<W> {
    BufWriter::with_capacity(BUFFER, file)
}

/// What a name leads to, if links lead on.
fn followed(path: &Path) -> PathBuf {
    let mut place = path.to_owned();
    for _ in 0..LINKS {
        let Ok(link) = fs::read_link(&place) else { break };
        place = place.parent().unwrap_or(Path::new("")).join(link);
    }
    place
}

/// A file in the folder of another, with the rights of that which it will replace.
fn beside(place: &Path, there: Option<&Metadata>, readers: Readers) -> io::Result<NamedTempFile> {
    let stem = place.file_stem().map(OsStr::to_string_lossy).unwrap_or_default();
    let prefix = format!("{stem}.unfinished-");
    let ending = place.extension().map(|ending| format!(".{}", ending.to_string_lossy())).unwrap_or_default();
    let mut builder = Builder::new();
    builder.prefix(&prefix).suffix(&ending);
    // Of itself the file is its owner's alone.
    #[cfg(unix)]
    if readers == Readers::AsEver {
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    }
    let folder = place.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let file = builder.tempfile_in(folder).map_err(plain)?;
    if let Some(there) = there {
        // A file that may not be written is not to be replaced either.
        OpenOptions::new().append(true).open(place)?;
        if readers == Readers::AsEver {
            take_over(file.as_file(), there)?;
        }
    }
    Ok(file)
}

/// Gives a file the rights of another, and its owner if the system lets us.
fn take_over(file: &File, there: &Metadata) -> io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        // Who may not give a file away keeps it. The rights come behind: a new owner takes some of them off.
        let _ = std::os::unix::fs::fchown(file, Some(there.uid()), Some(there.gid()));
    }
    file.set_permissions(there.permissions())
}

/// An error without the name of the file beside, which the user never gave.
fn plain(error: io::Error) -> io::Error {
    error.kind().into()
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.to {
            To::Beside { file, .. } => file.write(bytes),
            To::Device(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.to {
            To::Beside { file, .. } => file.flush(),
            To::Device(file) => file.flush(),
        }
    }
}

impl Seek for WholeFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match &mut self.to {
            To::Beside { file, .. } => file.seek(to),
            To::Device(file) => file.seek(to),
        }
    }
}

#[cfg(test)]
mod tests;
