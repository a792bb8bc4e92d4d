//! The first bytes of a file: which sign parts its columns.

use std::io::Read;

/// The first bytes of the input, up to the end of the header if that is near.
pub(super) fn read_start(input: &mut impl Read) -> std::io::Result<Vec<u8>> {
    let mut start = Vec::new();
    let mut piece = [0; 4096];
    while start.len() < 1 << 16 && header_line(&start).is_none() {
        match input.read(&mut piece) {
            Ok(0) => break,
            Ok(count) => start.extend(piece.iter().take(count)),
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(start)
}

/// The first line that is neither a comment nor blank, if it is complete.
fn header_line(start: &[u8]) -> Option<&[u8]> {
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    let end = text.iter().rposition(|byte| *byte == b'\n')?;
    let mut lines = text.get(..end)?.split(|byte| *byte == b'\n');
    lines.find(|line| !line.starts_with(b"#") && !line.trim_ascii().is_empty())
}

/// A comma, or what parts the columns of a header without one.
pub(super) fn delimiter(start: &[u8]) -> u8 {
    let header = header_line(start).unwrap_or(start);
    [b',', b';', b'\t'].into_iter().find(|delimiter| header.contains(delimiter)).unwrap_or(b',')
}

/// The comments above the header, without their `#`.
pub(super) fn comments(start: &[u8]) -> Vec<String> {
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    let lines = text.split(|byte| *byte == b'\n');
    let above = lines.take_while(|line| line.starts_with(b"#") || line.trim_ascii().is_empty());
    let comment =
        |line: &[u8]| line.strip_prefix(b"#").map(|text| String::from_utf8_lossy(text).trim().to_owned());
    above.filter_map(comment).collect()
}
