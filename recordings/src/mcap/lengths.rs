//! Lengths in the records that the library parses.
//!
//! The library allocates what the length of a string says before it looks whether there are as many bytes: a
//! schema of 13 bytes can make it ask for 4 GiB, which ends the program where that is refused. So all lengths are
//! compared with the bytes there are before it is called.

use ::mcap::records::op;

use super::error::McapError;

/// Checks the lengths in a schema or a channel; there are none in other records.
///
/// # Errors
/// [`McapError::Length`] for the first that is beyond the record.
pub(super) fn check(opcode: u8, contents: &[u8]) -> Result<(), McapError> {
    match opcode {
        op::SCHEMA => {
            let (_, rest) = counted("the name of a schema", behind(contents, 2))?;
            let (_, rest) = counted("the encoding of a schema", rest)?;
            counted("the text of a schema", rest)?;
        }
        op::CHANNEL => {
            let (_, rest) = counted("the topic of a channel", behind(contents, 4))?;
            let (_, rest) = counted("the encoding of a channel", rest)?;
            let (mut entries, _) = counted("the metadata of a channel", rest)?;
            while !entries.is_empty() {
                (_, entries) = counted("a key of metadata", entries)?;
                (_, entries) = counted("a value of metadata", entries)?;
            }
        }
        _ => {}
    }
    Ok(())
}

/// What is left behind the numbers at the front; nothing, if they are not whole.
fn behind(contents: &[u8], numbers: usize) -> &[u8] {
    contents.get(numbers..).unwrap_or_default()
}

/// The bytes that a length of four bytes counts, and what is behind them.
fn counted<'a>(what: &'static str, rest: &'a [u8]) -> Result<(&'a [u8], &'a [u8]), McapError> {
    let Some((length, bytes)) = rest.split_first_chunk::<4>() else {
        return Err(McapError::Length { what, stated: 4, found: rest.len() });
    };
    let stated = u32::from_le_bytes(*length);
    let length = usize::try_from(stated).unwrap_or(usize::MAX);
    bytes.split_at_checked(length).ok_or(McapError::Length { what, stated, found: bytes.len() })
}

/// The string at the front, if there is one.
pub(super) fn first_string(contents: &[u8]) -> Option<&str> {
    counted("a string", contents).ok().and_then(|(string, _)| core::str::from_utf8(string).ok())
}
