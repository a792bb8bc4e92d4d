//! A recording that is read row by row, whichever way it was recorded.

use std::io::Read;
use std::path::Path;

use fingertip_recordings::{ReaderOptions, RecordingReader};
use indicatif::ProgressBar;

use crate::convert::McapAsCsv;
use crate::error::CliError;
use crate::input::Input;
use crate::progress::bar;
use crate::recording_file::Kind;

/// The rows of a recording.
pub(crate) type Rows = RecordingReader<Box<dyn Read + Send>>;

/// A recording that is read.
pub(crate) struct Opened {
    pub(crate) rows: Rows,
    /// How much of the file was read; of a pipe that cannot be told.
    pub(crate) bar: ProgressBar,
    /// What messages call it.
    pub(crate) name: String,
}

impl Opened {
    /// Opens a recording. One of MCAP is read as what `convert` makes of it, these topics alone if there are any; what to
    /// know of that goes to `notes`.
    pub(crate) fn open(
        path: &Path,
        topics: &[String],
        options: ReaderOptions,
        notes: &mut Vec<String>,
    ) -> Result<Self, CliError> {
        let mut input = Input::open(path)?;
        let bar = bar(input.length());
        let text: Box<dyn Read + Send> = match input.kind() {
            Kind::Mcap => {
                let file = bar.wrap_read(input.messages()?);
                Box::new(McapAsCsv::new(file, &input, topics, notes)?)
            }
            Kind::Csv => Box::new(bar.wrap_read(input.text()?)),
        };
        let name = input.name();
        Ok(Self { rows: Rows::with_options(name.clone(), text, options)?, bar, name })
    }
}
