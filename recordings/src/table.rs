//! The cells of a CSV, row by row.

use core::cmp::Ordering;
use core::fmt;
use std::io::{Chain, Cursor, Read};

use crate::bounded::Bounded;
use crate::error::RecordingError;
use crate::record::{Record, Records};
use crate::start::{comments, delimiter, read_start};

/// Reads the rows of any CSV with a header, in memory that does not grow with the file: what
/// [`RecordingReader`](crate::RecordingReader) and every other reader of tables stand on. Columns are parted by commas,
/// or by semicolons or tabs where the header has no comma; lines that begin with `#`, and blank ones, are passed over.
///
/// ```
/// use fingertip_recordings::TableReader;
///
/// let file = "# weighed on Monday\nmass_kg;pose\n0.5; upright\n";
/// let mut table = TableReader::new("weights.csv", file.as_bytes())?;
/// assert_eq!(table.comments(), ["weighed on Monday"]);
/// assert_eq!(table.names(), ["mass_kg", "pose"]);
/// assert!(table.advance()?);
/// assert_eq!((table.line(), table.text(1)), (3, "upright"));
/// assert!(!table.advance()?);
/// # Ok::<(), fingertip_recordings::RecordingError>(())
/// ```
pub struct TableReader<R> {
    file: String,
    records: Records<Chain<Cursor<Vec<u8>>, R>>,
    pub(super) record: Record,
    names: Vec<String>,
    comments: Vec<String>,
    line: u64,
    cut_line: Option<u64>,
    /// Whether the row at hand is the first, and was not given yet.
    is_ahead: bool,
}

impl<R> fmt::Debug for TableReader<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, names, line, .. } = self;
        f.debug_struct("TableReader")
            .field("file", file)
            .field("names", names)
            .field("line", line)
            .finish_non_exhaustive()
    }
}

impl<R: Read> TableReader<R> {
    /// Reads the header of `input`; `file` is what errors call it. No buffer is needed around it.
    ///
    /// # Errors
    /// [`RecordingError`] if it cannot be read or there is no header.
    pub fn new(file: impl Into<String>, input: R) -> Result<Self, RecordingError> {
        let mut table = Self::begin(file, input)?;
        let name =
            |cell: &[u8]| String::from_utf8_lossy(cell).trim_start_matches('\u{feff}').trim().to_owned();
        table.names = table.record.iter().map(name).collect();
        Ok(table)
    }

    /// The same of a table without a header: its columns are called by their numbers, `1`, `2` and so on.
    ///
    /// # Errors
    /// [`RecordingError`] if it cannot be read or is empty.
    pub fn without_header(file: impl Into<String>, input: R) -> Result<Self, RecordingError> {
        let mut table = Self::begin(file, input)?;
        table.names = (1..=table.record.len()).map(|number| number.to_string()).collect();
        table.is_ahead = true;
        Ok(table)
    }

    /// Up to its first line.
    fn begin(file: impl Into<String>, mut input: R) -> Result<Self, RecordingError> {
        let file = file.into();
        let start = match read_start(&mut input) {
            Ok(start) => start,
            Err(source) => return Err(RecordingError::Read { file, line: 0, source }),
        };
        let (delimiter, comments) = (delimiter(&start), comments(&start));
        let mut table = Self {
            file,
            records: Records::new(Cursor::new(start).chain(input), delimiter),
            record: Record::default(),
            names: Vec::new(),
            comments,
            line: 0,
            cut_line: None,
            is_ahead: false,
        };
        if !table.advance_to_any()? {
            return Err(RecordingError::Empty { file: table.file });
        }
        Ok(table)
    }

    /// The names of the columns.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The comments above the header, without their `#`.
    #[must_use]
    pub fn comments(&self) -> &[String] {
        &self.comments
    }

    /// What errors call the file.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// The line of the row at hand, counting from 1.
    #[must_use]
    pub const fn line(&self) -> u64 {
        self.line
    }

    /// The line that the file ends in, if that was cut: it has no end, and its last cells are missing or no numbers.
    /// It is not among the rows.
    #[must_use]
    pub const fn cut_line(&self) -> Option<u64> {
        self.cut_line
    }

    /// Bytes taken from the input so far, those read ahead included: for a progress bar.
    #[must_use]
    pub fn bytes_read(&self) -> u64 {
        self.records.input().total()
    }

    /// Goes to the next row; `false` at the end.
    ///
    /// # Errors
    /// [`RecordingError`] for a row with too few or too many cells, or if reading fails. The next call goes on behind
    /// the bad row.
    pub fn advance(&mut self) -> Result<bool, RecordingError> {
        if !core::mem::take(&mut self.is_ahead) && !self.advance_to_any()? {
            return Ok(false);
        }
        let (expected, found) = (self.names.len(), self.record.len());
        match found.cmp(&expected) {
            Ordering::Equal => Ok(true),
            Ordering::Less if self.records.is_at_cut_end() => {
                self.cut_line = Some(self.line);
                Ok(false)
            }
            _ => Err(RecordingError::Ragged { file: self.file.clone(), line: self.line, expected, found }),
        }
    }

    /// The text of a cell of the row at hand, without blanks around it; empty if it is no UTF-8.
    #[must_use]
    pub fn text(&self, column: usize) -> &str {
        let cell = self.record.get(column).unwrap_or_default().trim_ascii();
        core::str::from_utf8(cell).unwrap_or_default()
    }

    /// Whether this cell, which says nothing, is where the file was cut: the row at hand is then none.
    pub fn is_cut_in(&mut self, column: usize) -> bool {
        let is_cut = column + 1 == self.names.len() && self.records.is_at_cut_end();
        if is_cut {
            self.cut_line = Some(self.line);
        }
        is_cut
    }

    /// Goes to the next line that is not blank.
    fn advance_to_any(&mut self) -> Result<bool, RecordingError> {
        loop {
            match self.records.read(&mut self.record) {
                Ok(true) if is_blank(&self.record) => {}
                Ok(true) => {
                    self.line = self.records.line();
                    return Ok(true);
                }
                Ok(false) => return Ok(false),
                Err(source) => {
                    let (file, line) = (self.file.clone(), self.line);
                    return Err(if self.records.input().reached() {
                        RecordingError::TooLong { file, line, limit: Bounded::<()>::LIMIT }
                    } else {
                        RecordingError::Read { file, line, source }
                    });
                }
            }
        }
    }
}

/// A line of nothing but blanks.
fn is_blank(record: &Record) -> bool {
    record.len() <= 1 && record.get(0).is_none_or(|cell| cell.trim_ascii().is_empty())
}
