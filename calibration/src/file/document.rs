//! What all our files have in common: TOML with a version and a checksum in front.

use core::fmt::Write as _;

use serde::Serialize;
use toml::{Table, Value};

use super::FileError;
use super::checksum::checksum;

/// The newest version of the formats; those of before are read, too. A file is written in the first version that has
/// what is in it, so that programs of before can read what they know.
pub const VERSION: i64 = 4;

/// Takes version and checksum off the front: the fields, and the checksum that the file claims, if it does.
pub(super) fn open(text: &str) -> Result<(Table, Option<String>), FileError> {
    let mut table: Table = text.parse().map_err(malformed)?;
    match table.remove("version") {
        Some(Value::Integer(1..=VERSION)) => {}
        Some(Value::Integer(found)) => return Err(FileError::UnknownVersion { found, known: VERSION }),
        Some(_) => return Err(malformed("field `version` is not an integer")),
        None => return Err(malformed("missing field `version`")),
    }
    match table.remove("checksum") {
        Some(Value::String(found)) => Ok((table, Some(found))),
        Some(_) => Err(malformed("field `checksum` is not a text")),
        None => Ok((table, None)),
    }
}

/// The checksum of what a file says.
pub(super) fn checksum_of(contents: &impl Serialize) -> Result<String, FileError> {
    Ok(checksum(&Value::try_from(contents).map_err(malformed)?))
}

/// Refuses contents that are not those that the checksum was taken of.
pub(super) fn compare(contents: &impl Serialize, found: String) -> Result<(), FileError> {
    let expected = checksum_of(contents)?;
    if found == expected { Ok(()) } else { Err(FileError::WrongChecksum { found, expected }) }
}

/// The text of a file: rows of matrices one to a line.
pub(super) fn write(heading: &str, version: i64, contents: &impl Serialize) -> Result<String, FileError> {
    let Value::Table(fields) = Value::try_from(contents).map_err(malformed)? else {
        return Err(malformed("its contents are no table"));
    };
    // Writing to a String cannot fail.
    let mut text = format!("# {heading}, written by fingertip.\n");
    let _ = writeln!(text, "version = {version}\nchecksum = {:?}\n", checksum_of(contents)?);
    // Top-level values come before the tables, or they would belong to the last of these.
    for (key, value) in fields.iter().filter(|(_, value)| !value.is_table()) {
        write_entry(&mut text, key, value);
    }
    for (key, value) in &fields {
        if let Value::Table(entries) = value {
            let _ = writeln!(text, "\n[{key}]");
            for (key, value) in entries {
                write_entry(&mut text, key, value);
            }
        }
    }
    Ok(text)
}

/// Matrices get a row to a line, everything else a line.
fn write_entry(text: &mut String, key: &str, value: &Value) {
    match value {
        Value::Array(rows) if rows.first().is_some_and(Value::is_array) => {
            let _ = writeln!(text, "{key} = [");
            for row in rows {
                let _ = writeln!(text, "    {row},");
            }
            let _ = writeln!(text, "]");
        }
        _ => {
            let _ = writeln!(text, "{key} = {value}");
        }
    }
}

pub(super) fn malformed(message: impl ToString) -> FileError {
    FileError::Malformed { message: message.to_string().trim_end().to_owned() }
}
