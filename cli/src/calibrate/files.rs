//! The files of the commands that calibrate.

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use fingertip_calibration::file::{self, CalibrationFile, FileError, PayloadFile, ReadError};
use fingertip_calibration::loads::{Columns, LoadReader, LoadTable};
use fingertip_calibration::report::Report;

use crate::error::CliError;
use crate::output::Outputs;
use crate::progress::bar;
use crate::standard::{is_standard, shown};
use crate::verbosity::detail;

/// What is wrong with a table, in an error that names its file.
pub(crate) fn bad(path: &Path, message: &impl ToString) -> CliError {
    CliError::Calibrate { path: path.to_owned(), message: message.to_string() }
}

/// A table of known loads; columns that are not used go to `notes`.
pub(crate) fn read_loads(path: &Path, notes: &mut Vec<String>) -> Result<LoadTable, CliError> {
    let mut reader = LoadReader::new(open("table of loads", path)?).map_err(|error| bad(path, &error))?;
    let table = LoadTable::from_reader(&mut reader).map_err(|error| bad(path, &error))?;
    notes.extend(of_reading(path, &reader));
    Ok(table)
}

/// What to mind of a table that was read.
pub(super) fn of_reading<R: Read>(path: &Path, reader: &LoadReader<R>) -> Vec<String> {
    let ignored = reader.ignored();
    let unused =
        (!ignored.is_empty()).then(|| format!("{}: columns not used: {}", shown(path), ignored.join(", ")));
    unused.into_iter().chain(reader.cut_line().map(|line| cut(path, line))).collect()
}

/// That a file was cut in its last line.
pub(crate) fn cut(path: &Path, line: u64) -> String {
    format!("{}: the file was cut in line {line}, its last, which is left out", shown(path))
}

/// A table whose columns are taken by name.
pub(crate) fn read_columns(what: &'static str, path: &Path) -> Result<Columns, CliError> {
    Columns::from_csv(open(what, path)?).map_err(|error| bad(path, &error))
}

/// The bytes of a file; `-` is the standard input.
pub(crate) fn open(what: &'static str, path: &Path) -> Result<Box<dyn Read>, CliError> {
    if is_standard(path) {
        return Ok(Box::new(io::stdin()));
    }
    let fault = |source| CliError::read(what, path, source);
    let file = fs::File::open(path).map_err(fault)?;
    let meta = file.metadata().map_err(fault)?;
    detail(|| format!("reads {what} {}: {} bytes", shown(path), meta.len()));
    Ok(Box::new(bar(meta.is_file().then_some(meta.len())).wrap_read(file)))
}

/// All of a text; `-` is the standard input.
pub(crate) fn text(what: &'static str, path: &Path) -> Result<String, CliError> {
    let not_text = |_| io::ErrorKind::InvalidData.into();
    String::from_utf8(bytes(what, path)?)
        .map_err(not_text)
        .map_err(|source| CliError::read(what, path, source))
}

/// All of a file that is no longer than such files are; `-` is the standard input.
pub(super) fn bytes(what: &'static str, path: &Path) -> Result<Vec<u8>, CliError> {
    let read = if is_standard(path) {
        file::read_bounded(io::stdin())
    } else {
        fs::File::open(path).and_then(file::read_bounded)
    };
    let bytes = read.map_err(|source| CliError::read(what, path, source))?;
    detail(|| format!("reads {what} {}: {} bytes", shown(path), bytes.len()));
    Ok(bytes)
}

/// Our TOML, or ATI's `.cal` by its extension.
pub(crate) fn read_calibration(path: &Path) -> Result<CalibrationFile, CliError> {
    if is_standard(path) {
        let unusable =
            |error: FileError| CliError::Calibration { path: path.to_owned(), message: error.to_string() };
        return CalibrationFile::from_toml(&text("calibration", path)?).map_err(unusable);
    }
    file::read_calibration(path).map_err(|error| match error {
        ReadError::Io(source) => CliError::read("calibration", path, source),
        other => CliError::Calibration { path: path.to_owned(), message: other.to_string() },
    })
}

/// What hangs on the sensor.
pub(crate) fn read_payload(path: &Path) -> Result<PayloadFile, CliError> {
    let text = text("payload", path)?;
    PayloadFile::from_toml(&text).map_err(|error| bad(path, &error))
}

pub(super) fn write_reports(
    report: &Report,
    title: &str,
    of: &[(&str, String)],
    html: Option<&PathBuf>,
    json: Option<&PathBuf>,
    outputs: &Outputs,
) -> Result<(), CliError> {
    if let Some(path) = html {
        outputs.write("report", path, &report.to_html(title, of))?;
    }
    if let Some(path) = json {
        let text = report.to_json().map_err(|error| CliError::write("report", path, error.into()))?;
        outputs.write("report", path, &text)?;
    }
    Ok(())
}
