//! The two secrets in the addresses.

use core::fmt;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Bytes of a token.
const BYTES: usize = 16;

/// A secret for those who watch, and one for who commands. They are not told by `Debug`.
///
/// ```
/// use fingertip_bridges::web::Tokens;
///
/// let tokens = Tokens::random()?;
/// assert_eq!(tokens.watch().len(), 32);
/// assert_ne!(tokens.watch(), tokens.command());
/// // Logs do not tell them.
/// assert!(!format!("{tokens:?}").contains(tokens.watch()));
/// # Ok::<(), fingertip_bridges::web::TokensError>(())
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct Tokens {
    watch: String,
    command: String,
}

/// Why there are no tokens.
///
/// ```
/// use fingertip_bridges::web::Tokens;
///
/// let folder = tempfile::tempdir()?;
/// let file = folder.path().join("tokens");
/// // Made at first, and the same after that.
/// assert_eq!(Tokens::kept(&file)?, Tokens::kept(&file)?);
/// std::fs::write(&file, "secret\n")?;
/// let told = Tokens::kept(&file).unwrap_err().to_string();
/// assert!(told.contains("does not hold tokens: two lines, each of 32 digits and letters a to f"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TokensError {
    /// The system gives no random numbers.
    #[error("the system gives no random numbers for tokens: {0}")]
    Random(getrandom::Error),
    /// The file of tokens cannot be used.
    #[error("cannot keep tokens in {path}: {source}; give a file that can be written", path = .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// The file holds something else.
    #[error(
        "{path} does not hold tokens: two lines, each of 32 digits and letters a to f; remove it, and it is made anew",
        path = .path.display()
    )]
    NotTokens {
        /// The file.
        path: PathBuf,
    },
}

impl Tokens {
    /// New ones.
    ///
    /// # Errors
    /// [`TokensError::Random`].
    pub fn random() -> Result<Self, TokensError> {
        Ok(Self { watch: random()?, command: random()? })
    }

    /// Those of a file, so that addresses stay when the program is started anew; the file is made if it is not there,
    /// for its owner alone.
    ///
    /// # Errors
    /// [`TokensError`].
    pub fn kept(path: &Path) -> Result<Self, TokensError> {
        let fault = |source| TokensError::File { path: path.to_owned(), source };
        match fs::read_to_string(path) {
            Ok(text) => Self::parse(&text).ok_or_else(|| TokensError::NotTokens { path: path.to_owned() }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let tokens = Self::random()?;
                tokens.write(path).map_err(fault)?;
                Ok(tokens)
            }
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {
                Err(TokensError::NotTokens { path: path.to_owned() })
            }
            Err(error) => Err(fault(error)),
        }
    }

    fn parse(text: &str) -> Option<Self> {
        let is_token = |line: &&str| {
            line.len() == 2 * BYTES && line.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
        };
        let mut lines = text.lines();
        let (watch, command) = (lines.next().filter(is_token)?, lines.next().filter(is_token)?);
        (lines.next().is_none() && watch != command)
            .then(|| Self { watch: watch.to_owned(), command: command.to_owned() })
    }

    /// Whole or not at all, and nobody else's to read.
    fn write(&self, path: &Path) -> io::Result<()> {
        let mut options = fs::OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        let mut half = path.as_os_str().to_owned();
        half.push(".half");
        let half = PathBuf::from(half);
        let mut file = options.open(&half)?;
        let written = writeln!(file, "{}\n{}", self.watch, self.command).and_then(|()| file.sync_all());
        written.and_then(|()| fs::rename(&half, path)).inspect_err(|_| {
            let _ = fs::remove_file(&half);
        })
    }

    /// For those who watch.
    #[must_use]
    pub fn watch(&self) -> &str {
        &self.watch
    }

    /// For who commands.
    #[must_use]
    pub fn command(&self) -> &str {
        &self.command
    }
}

impl fmt::Debug for Tokens {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tokens").finish_non_exhaustive()
    }
}

/// Digits that nobody guesses.
pub(super) fn random() -> Result<String, TokensError> {
    let mut bytes = [0; BYTES];
    getrandom::fill(&mut bytes).map_err(TokensError::Random)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests {
    use super::{Tokens, TokensError};

    #[test]
    fn tokens_are_kept_in_a_file_of_its_owner() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tokens");
        let made = Tokens::kept(&path).unwrap();
        assert!(made == Tokens::kept(&path).unwrap() && made != Tokens::random().unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
        }
        let whole = std::fs::read_to_string(&path).unwrap();
        let same = format!("{}\n{}\n", made.watch(), made.watch());
        for text in ["", "a\nb\n", &whole[..40], &format!("{whole}more\n"), &whole.to_uppercase(), &same] {
            std::fs::write(&path, text).unwrap();
            let error = Tokens::kept(&path).unwrap_err();
            assert!(matches!(error, TokensError::NotTokens { .. }), "{text:?}: {error}");
        }
        let error = Tokens::kept(folder.path()).unwrap_err().to_string();
        assert!(error.contains("cannot keep tokens in"), "{error}");
        assert!(!format!("{made:?}").contains(made.watch()));
    }
}
