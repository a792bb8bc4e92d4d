//! Texts of bounded length.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

/// The longest file that is read \[MiB\]: a calibration or a scene has some kilobytes.
const LONGEST: u64 = 16;

/// All of a calibration's, a payload's or a scene's file, unless it is longer than any that is meant.
///
/// # Errors
/// Those of reading; [`io::ErrorKind::FileTooLarge`] beyond 16 MiB.
pub fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read_bounded(File::open(path)?)?)
        .map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "it is not text in UTF-8"))
}

/// The bytes up to the end of what is no longer than any such file, wherever they come from.
///
/// # Errors
/// Those of reading; [`io::ErrorKind::FileTooLarge`] beyond 16 MiB.
pub fn read_bounded(reader: impl io::Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let most = LONGEST << 20;
    let length = reader.take(most + 1).read_to_end(&mut bytes)?;
    if length as u64 > most {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, format!("it is longer than {LONGEST} MiB")));
    }
    Ok(bytes)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    #[test]
    fn a_file_without_an_end_is_refused() {
        let error = super::read_text("/dev/zero".as_ref()).unwrap_err().to_string();
        assert!(error.contains("longer than 16 MiB"), "{error}");
    }
}
