//! From MCAP to CSV: into a file, or as it is read.

use std::io::{self, Read};
use std::path::Path;

use fingertip_recordings::RecordingWriter;

use super::mcap_rows::Rows;
use super::{Account, ConvertArguments};
use crate::error::CliError;
use crate::input::Input;
use crate::output::Outputs;
use crate::recording_file::csv;
use crate::span::{Place, Window};

pub(super) fn convert(
    arguments: &ConvertArguments,
    input: &Input,
    output: &Path,
    outputs: &Outputs,
) -> Result<Account, CliError> {
    let failed = |error| csv(output, error);
    let mut account = Account::default();
    let (schema, mut rows) = Rows::new(input.messages()?, input, &arguments.topics, &mut account)?;
    // Only what holds something becomes a file.
    let mut writer = RecordingWriter::new(outputs.create("recording", output)?, &schema).map_err(failed)?;
    let mut window = Window::new(arguments.span);
    while let Some(row) = rows.next()? {
        // The first cell is the time.
        match window.place(row.first().copied().unwrap_or(f64::NAN)) {
            Place::Before => {}
            Place::Behind => break,
            Place::Within => {
                writer.write(row.iter().copied()).map_err(failed)?;
                rows.count();
            }
        }
    }
    if rows.counted() == 0 {
        return Err(window.nothing_of(input.path()));
    }
    writer.finish().map_err(failed)?.finish()?;
    rows.account(&mut account);
    Ok(account)
}

/// The text that an MCAP file is converted to, made while it is read: in memory that does not grow with the file.
pub(crate) struct McapAsCsv<R> {
    rows: Rows<R>,
    writer: RecordingWriter<Vec<u8>>,
    /// How many bytes of what the writer holds were given.
    given: usize,
}

/// So many bytes are made at once, or a little more.
const PIECE: usize = 1 << 16;

impl<R: Read> McapAsCsv<R> {
    /// The text of `file`, which is that at `input`; what to know of its columns goes to `notes`.
    pub(crate) fn new(
        file: R,
        input: &Input,
        topics: &[String],
        notes: &mut Vec<String>,
    ) -> Result<Self, CliError> {
        let mut account = Account::default();
        let (schema, rows) = Rows::new(file, input, topics, &mut account)?;
        notes.append(&mut account.notes);
        let writer = RecordingWriter::new(Vec::new(), &schema).map_err(|error| csv(input.path(), error))?;
        Ok(Self { rows, writer, given: 0 })
    }
}

impl<R: Read> Read for McapAsCsv<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.given == self.writer.get_mut().len() {
            self.writer.get_mut().clear();
            self.given = 0;
            while self.writer.get_mut().len() < PIECE
                && let Some(row) = self.rows.next().map_err(io::Error::other)?
            {
                self.writer.write(row.iter().copied()).map_err(io::Error::other)?;
            }
        }
        let mut left = self.writer.get_mut().get(self.given..).unwrap_or_default();
        let read = left.read(buffer)?;
        self.given += read;
        Ok(read)
    }
}
