//! The file of a recording: CSV or MCAP, by its ending.

use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use fingertip::surfaces::Resolution;
use fingertip::wrench::Wrench;
use fingertip_drivers::recording::mcap::{McapError, McapWriter, RecordedContact, RecordedSignals, Topic};
use fingertip_drivers::recording::{ContactCells, RecordingError, RecordingWriter, Schema, SignalUnit};

use crate::error::CliError;
use crate::observe::SceneTouch;
use crate::sensor::Volts;

/// Name of the frame in MCAP files.
pub(crate) const FRAME: &str = "fingertip_sensor";

/// What the ending of a name says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Csv,
    Mcap,
}

impl Kind {
    pub(crate) fn of(path: &Path) -> Result<Self, CliError> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("csv" | "txt") => Ok(Self::Csv),
            Some("mcap") => Ok(Self::Mcap),
            _ => Err(CliError::UnknownEnding { path: path.to_owned() }),
        }
    }
}

/// Creates a file; one that exists is written over only if that is wanted.
pub(crate) fn create(path: &Path, force: bool) -> Result<BufWriter<File>, CliError> {
    let mut options = OpenOptions::new();
    let options = if force { options.create(true).truncate(true) } else { options.create_new(true) };
    options.write(true).open(path).map(BufWriter::new).map_err(|source| match source.kind() {
        io::ErrorKind::AlreadyExists => {
            let source = io::Error::new(source.kind(), "it exists already; give another name, or --force");
            CliError::write("recording", path, source)
        }
        _ => CliError::write("recording", path, source),
    })
}

/// One row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<'a> {
    /// \[s\]
    pub(super) time: f64,
    pub(super) wrench: &'a Wrench<f64>,
    pub(super) volts: Option<&'a Volts>,
    pub(super) contact: Option<ContactCells>,
}

/// The contact of a touch, with the load at its point.
pub(super) fn contact(touch: &SceneTouch) -> Option<ContactCells> {
    let Resolution::Contact(contact) = &touch.resolution else { return None };
    let wrench = Wrench::on_fingertip(contact.force, contact.normal * contact.spin_torque);
    Some(ContactCells { position: contact.point, normal: contact.normal, wrench })
}

/// Writes rows. A file that is finished is whole, whatever ended the recording.
pub(super) struct Output {
    writer: Writer,
    path: PathBuf,
    has_volts: bool,
    has_contacts: bool,
}

enum Writer {
    Csv(RecordingWriter<BufWriter<File>>),
    Mcap {
        writer: Box<McapWriter<BufWriter<File>>>,
        wrench: Topic,
        /// Of the gauges, and of the dummy gauge.
        signals: Option<[Topic; 2]>,
        contact: Option<Topic>,
    },
}

impl Output {
    pub(super) fn create(
        path: &Path,
        force: bool,
        has_volts: bool,
        has_contacts: bool,
    ) -> Result<Self, CliError> {
        let kind = Kind::of(path)?;
        let file = create(path, force)?;
        let writer = match kind {
            Kind::Csv => {
                let mut schema = Schema::default().time();
                if has_volts {
                    schema = schema.signals("", 6, SignalUnit::Volts).dummy("", SignalUnit::Volts);
                }
                schema = schema.wrench("");
                if has_contacts {
                    schema = schema.contact();
                }
                Writer::Csv(RecordingWriter::new(file, &schema).map_err(|error| csv(path, error))?)
            }
            Kind::Mcap => {
                let open = || {
                    let mut writer = McapWriter::new(file)?;
                    let wrench = writer.wrenches("/fingertip/wrench", FRAME)?;
                    let signals = if has_volts {
                        let gauges = writer.signals("/fingertip/signals", FRAME)?;
                        Some([gauges, writer.signals("/fingertip/dummy", FRAME)?])
                    } else {
                        None
                    };
                    let contact =
                        if has_contacts { Some(writer.contacts("/fingertip/contact", FRAME)?) } else { None };
                    Ok(Writer::Mcap { writer: Box::new(writer), wrench, signals, contact })
                };
                open().map_err(|error| mcap(path, &error))?
            }
        };
        Ok(Self { writer, path: path.to_owned(), has_volts, has_contacts })
    }

    pub(super) fn write(&mut self, row: &Row<'_>) -> Result<(), CliError> {
        match &mut self.writer {
            Writer::Csv(writer) => {
                let volts = if self.has_volts { 7 } else { 0 };
                let volts = (0..volts)
                    .map(|index| row.volts.and_then(|volts| volts.get(index)).copied().unwrap_or(f64::NAN));
                let contact = row.contact.map_or([f64::NAN; 12], |contact| contact.cells());
                let contact = contact.into_iter().take(if self.has_contacts { 12 } else { 0 });
                let wrench = row.wrench.components();
                let cells =
                    core::iter::once(row.time).chain(volts).chain(wrench.iter().copied()).chain(contact);
                writer.write(cells).map_err(|error| csv(&self.path, error))
            }
            Writer::Mcap { writer, wrench, signals, contact } => {
                let mut write = || {
                    if let (Some([gauges, dummy]), Some(volts)) = (*signals, row.volts) {
                        let parts = [(gauges, volts.as_slice().get(..6)), (dummy, volts.as_slice().get(6..))];
                        for (topic, values) in parts {
                            let (unit, values) = ("V".to_owned(), values.unwrap_or_default().to_vec());
                            writer.write_signals(topic, row.time, RecordedSignals { unit, values })?;
                        }
                    }
                    writer.write_wrench(*wrench, row.time, row.wrench)?;
                    if let (Some(topic), Some(ContactCells { position, normal, wrench })) =
                        (*contact, row.contact)
                    {
                        let name = "fingertip".to_owned();
                        writer.write_contact(
                            topic,
                            row.time,
                            RecordedContact { name, position, normal, wrench },
                        )?;
                    }
                    Ok(())
                };
                write().map_err(|error| mcap(&self.path, &error))
            }
        }
    }

    /// Writes the rest, so that the file is whole.
    pub(super) fn finish(self) -> Result<(), CliError> {
        match self.writer {
            Writer::Csv(writer) => writer.finish().map(drop).map_err(|error| csv(&self.path, error)),
            Writer::Mcap { writer, .. } => {
                let file = writer.finish().map_err(|error| mcap(&self.path, &error))?;
                let written = file.into_inner().map_err(io::IntoInnerError::into_error);
                written.map(drop).map_err(|source| CliError::write("recording", &self.path, source))
            }
        }
    }
}

/// An error of a CSV file that is written, with its name.
pub(crate) fn csv(path: &Path, error: RecordingError) -> CliError {
    match error {
        RecordingError::Write { source } => CliError::write("recording", path, source),
        other => CliError::Recording(other),
    }
}

/// An error of an MCAP file, with its name.
pub(crate) fn mcap(path: &Path, error: &McapError) -> CliError {
    CliError::Mcap { path: path.to_owned(), message: error.to_string() }
}
