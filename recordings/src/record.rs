//! The cells of the rows of a CSV.

use std::io::{self, Read};

use csv_core::ReadRecordResult;

use crate::bounded::Bounded;
use crate::plain::{ONES, WINDOW};

/// Bytes that are read at a time.
const BUFFER: usize = 1 << 16;
/// Bytes and cells by which room grows that is too small for a row, beside twice what there is.
const ROOM: usize = 1 << 6;

/// The cells of one row.
pub(super) struct Record {
    /// The row behind as many bytes as a window has, so that there is one at the end of every cell.
    bytes: Vec<u8>,
    /// Where cells end in the row, of which the first so many are its own.
    ends: Vec<usize>,
    cells: usize,
    /// Bytes between a cell and the next.
    between: usize,
}

impl Default for Record {
    fn default() -> Self {
        Self { bytes: vec![0; WINDOW], ends: Vec::new(), cells: 0, between: 0 }
    }
}

impl Record {
    /// How many cells it has.
    pub(super) const fn len(&self) -> usize {
        self.cells
    }

    /// A cell, and the last bytes up to its end, which may be more; `None` beyond the last.
    #[inline]
    pub(super) fn cell(&self, column: usize) -> Option<(&[u8], &[u8; WINDOW])> {
        let end = WINDOW + self.ends.get(..self.cells)?.get(column)?;
        let start = match column.checked_sub(1) {
            Some(before) => WINDOW + self.ends.get(before)? + self.between,
            None => WINDOW,
        };
        let row = self.bytes.get(..end)?;
        Some((row.get(start..)?, row.last_chunk()?))
    }

    /// A cell; `None` beyond the last.
    #[inline]
    pub(super) fn get(&self, column: usize) -> Option<&[u8]> {
        self.cell(column).map(|(cell, _)| cell)
    }

    /// The cells in their order.
    pub(super) fn iter(&self) -> impl Iterator<Item = &[u8]> {
        (0..self.cells).map_while(|column| self.get(column))
    }

    /// Takes the row that a text begins with, and says how many bytes it has with its end; `None` unless it ends there and
    /// is neither a comment nor has a quote: what stands in its cells is then what stands between its delimiters.
    #[inline]
    fn take_plain(&mut self, text: &[u8], delimiter: u8) -> Option<usize> {
        let length = memchr::memchr(b'\n', text)?;
        let line = text.get(..length)?;
        if line.first() == Some(&b'#') || memchr::memchr(b'"', line).is_some() {
            return None;
        }
        self.bytes.truncate(WINDOW);
        self.bytes.extend_from_slice(line);
        self.ends.clear();
        push_places(delimiter, line, &mut self.ends);
        self.ends.push(length);
        (self.cells, self.between) = (self.ends.len(), 1);
        Some(length + 1)
    }
}

/// Appends where a byte stands in a text. Eight bytes are looked at at once: cells are so short that a search for each takes
/// longer to begin than to end.
#[inline]
fn push_places(byte: u8, text: &[u8], places: &mut Vec<usize>) {
    let sought = ONES * u64::from(byte);
    let (pieces, rest) = text.as_chunks::<8>();
    for (number, piece) in pieces.iter().enumerate() {
        let unlike = u64::from_le_bytes(*piece) ^ sought;
        // The highest bit of every byte that is the one sought.
        let mut found = !(((unlike & (ONES * 0x7f)) + ONES * 0x7f) | unlike) & (ONES * 0x80);
        while found != 0 {
            places.push(8 * number + found.trailing_zeros() as usize / 8);
            found &= found - 1;
        }
    }
    let before = text.len() - rest.len();
    places.extend(
        rest.iter().enumerate().filter(|(_, found)| **found == byte).map(|(place, _)| before + place),
    );
}

/// Reads rows one by one. Quotes, comments and rows that the buffer holds in parts are for `csv_core`; most rows are but
/// numbers between delimiters, and are parted there, which takes a third of the instructions.
pub(super) struct Records<R> {
    input: Bounded<R>,
    core: csv_core::Reader,
    delimiter: u8,
    buffer: Vec<u8>,
    /// What was read and not yet taken.
    start: usize,
    filled: usize,
    /// Bytes taken.
    taken: u64,
    /// Whether the end was met, or reading failed.
    has_ended: bool,
}

impl<R: Read> Records<R> {
    pub(super) fn new(input: R, delimiter: u8) -> Self {
        let core = csv_core::ReaderBuilder::new()
            .comment(Some(b'#'))
            .delimiter(delimiter)
            // A carriage return before it is trimmed with the blanks around a cell.
            .terminator(csv_core::Terminator::Any(b'\n'))
            .build();
        let buffer = vec![0; BUFFER];
        let input = Bounded::new(input);
        Self { input, core, delimiter, buffer, start: 0, filled: 0, taken: 0, has_ended: false }
    }

    /// Where the bytes come from.
    pub(super) const fn input(&self) -> &Bounded<R> {
        &self.input
    }

    /// The line of the row read last, counting from 1: every row ends with the end of a line.
    #[inline]
    pub(super) fn line(&self) -> u64 {
        self.core.line().saturating_sub(1)
    }

    /// Whether the file ends in the row read last, without the end of the line.
    pub(super) fn is_at_cut_end(&self) -> bool {
        // The end that was added is a byte that the file does not have.
        self.taken > self.input.total()
    }

    /// Reads the next row; `false` at the end, and behind a failure. Empty lines may be passed over.
    ///
    /// # Errors
    /// If reading fails.
    #[inline]
    pub(super) fn read(&mut self, record: &mut Record) -> io::Result<bool> {
        self.input.start_record();
        // The first row, before which a mark of the order of bytes may stand, is not in the buffer yet.
        if let Some(rest) = self.buffer.get(self.start..self.filled)
            && let Some(length) = record.take_plain(rest, self.delimiter)
        {
            self.take(length);
            self.core.set_line(self.core.line() + 1);
            return Ok(true);
        }
        self.read_any(record)
    }

    #[inline]
    const fn take(&mut self, bytes: usize) {
        self.start += bytes;
        self.taken += bytes as u64;
    }

    /// The next row, whatever it is.
    #[inline(never)]
    fn read_any(&mut self, record: &mut Record) -> io::Result<bool> {
        let Record { bytes, ends, cells, between } = record;
        (*cells, *between) = (0, 0);
        if core::mem::replace(&mut self.has_ended, true) {
            return Ok(false);
        }
        let (mut written, mut ended) = (0, 0);
        loop {
            if self.start == self.filled {
                (self.start, self.filled) = (0, 0);
                self.filled = self.input.read(&mut self.buffer)?;
            }
            let input = self.buffer.get(self.start..self.filled).unwrap_or_default();
            let output = bytes.get_mut(WINDOW + written..).unwrap_or_default();
            let (result, read, wrote, new) =
                self.core.read_record(input, output, ends.get_mut(ended..).unwrap_or_default());
            self.take(read);
            written += wrote;
            ended += new;
            match result {
                ReadRecordResult::InputEmpty => {}
                ReadRecordResult::OutputFull => bytes.resize(2 * bytes.len() + ROOM, 0),
                ReadRecordResult::OutputEndsFull => ends.resize(2 * ends.len() + ROOM, 0),
                ReadRecordResult::Record => {
                    *cells = ended;
                    self.has_ended = false;
                    return Ok(true);
                }
                ReadRecordResult::End => return Ok(false),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::{self, Read};

    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::{Record, Records};

    /// Gives a text in pieces of at most so many bytes.
    struct Pieces<'a>(&'a [u8], usize);

    impl Read for Pieces<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let most = self.1.min(buffer.len());
            (&mut self.0).take(most as u64).read(buffer)
        }
    }

    /// The rows that are not blank, each with its line.
    type Rows = Vec<(u64, Vec<Vec<u8>>)>;

    fn is_blank(row: &[Vec<u8>]) -> bool {
        row.concat().is_empty() && row.len() <= 1
    }

    fn rows(text: &[u8], piece: usize) -> Rows {
        let mut records = Records::new(Pieces(text, piece), b',');
        let (mut record, mut rows) = (Record::default(), Rows::new());
        while records.read(&mut record).unwrap() {
            let row: Vec<Vec<u8>> = record.iter().map(<[u8]>::to_vec).collect();
            assert_eq!(row.len(), record.len());
            assert!(record.get(record.len()).is_none());
            if !is_blank(&row) {
                rows.push((records.line(), row));
            }
        }
        assert!(!records.read(&mut record).unwrap() && record.len() == 0);
        let ends = text.last().is_none_or(|last| *last == b'\n');
        assert_eq!(records.input().total(), text.len() as u64);
        assert_eq!(records.is_at_cut_end(), !ends);
        rows
    }

    /// The same by the crate `csv`.
    fn expected(text: &[u8]) -> Rows {
        let mut text = text.to_vec();
        if text.last().is_some_and(|last| *last != b'\n') {
            text.push(b'\n');
        }
        let mut csv = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .terminator(csv::Terminator::Any(b'\n'))
            .from_reader(&*text);
        let (mut record, mut rows) = (csv::ByteRecord::new(), Rows::new());
        while csv.read_byte_record(&mut record).unwrap() {
            let row: Vec<Vec<u8>> = record.iter().map(<[u8]>::to_vec).collect();
            if !is_blank(&row) {
                rows.push((csv.position().line() - 1, row));
            }
        }
        rows
    }

    #[test]
    fn rows_are_those_of_the_crate_csv_however_they_come() {
        let mut random = Pcg64Mcg::seed_from_u64(12);
        for letters in [&b"0123456789.-,,,,\n\n"[..], b"01,\n\r\"# \xef", b"a,,\n\"\"#"] {
            for _ in 0..3000 {
                let length = random.random_range(0..200);
                let mut text: Vec<u8> =
                    (0..length).map(|_| letters[random.random_range(0..letters.len())]).collect();
                // A mark of the order of bytes is known if it comes with what is behind it, as the start of a table does.
                let is_marked = length > 2 && random.random_range(0..20) == 0;
                if is_marked {
                    text.splice(0..0, *b"\xef\xbb\xbf");
                }
                let expected = expected(&text);
                for piece in if is_marked { [5, 7, 1000] } else { [1, 7, 1000] } {
                    assert_eq!(rows(&text, piece), expected, "{:?}", String::from_utf8_lossy(&text));
                }
            }
        }
    }

    /// More than the buffer holds, so that rows lie in two of its fillings; and rows of more cells and bytes than there is
    /// room for at first.
    #[test]
    fn long_texts_and_wide_rows_are_whole() {
        let mut random = Pcg64Mcg::seed_from_u64(13);
        let mut text = Vec::new();
        for row in 0..3000 {
            let cells = if row % 500 == 0 { 3000 } else { random.random_range(1..40) };
            for cell in 0..cells {
                let comma = if cell > 0 { "," } else { "" };
                text.extend(format!("{comma}{:.*}", row % 9, random.random_range(-1.0..1.0)).bytes());
            }
            text.extend(if row % 700 == 0 { b",\"a\"\n" } else { b",bcd\n" });
        }
        assert!(text.len() > 8 * super::BUFFER);
        assert_eq!(rows(&text, 50_000), expected(&text));
    }

    /// Fails in between, once.
    struct Failing<'a>(Vec<&'a [u8]>);

    impl Read for Failing<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let Some(piece) = self.0.pop() else { return Ok(0) };
            if piece.is_empty() { Err(io::Error::other("cut")) } else { (&*piece).read(buffer) }
        }
    }

    #[test]
    fn nothing_comes_behind_a_failure() {
        let input = Failing(vec![b"4,5\n", b"", b"1,2\n\"3,\n"]);
        let (mut records, mut record) = (Records::new(input, b','), Record::default());
        assert!(records.read(&mut record).unwrap());
        assert_eq!((records.line(), record.get(1)), (1, Some(&b"2"[..])));
        assert!(records.read(&mut record).is_err() && record.len() == 0 && record.get(0).is_none());
        assert!(!records.read(&mut record).unwrap() && record.len() == 0);
    }
}
