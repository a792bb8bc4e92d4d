//! The rows that a recording is written as, in CSV or MCAP.

use core::time::Duration;
use std::path::PathBuf;

use fingertip::contact::Resolution;
use fingertip::wrench::Wrench;
use fingertip_bridges::messages::recorded_touch;
use fingertip_bridges::{About, Felt, Sample};
use fingertip_recordings::mcap::{McapWriter, RecordedContact, RecordedSignals, Topic};
use fingertip_recordings::{ContactCells, RecordingWriter, Schema, SignalUnit};

use super::args::RecordArguments;
use super::drawing::Drawing;
use crate::error::CliError;
use crate::observe::{SceneTouch, Status};
use crate::output::{Outputs, Whole};
use crate::recording_file::{FRAME, Kind, csv, mcap};
use crate::sensor::Volts;

/// One row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<'a> {
    /// \[s\]
    pub(super) time: f64,
    pub(super) wrench: &'a Wrench<f64>,
    pub(super) volts: Option<&'a Volts>,
    pub(super) contact: Option<ContactCells>,
    /// All that was felt, which MCAP holds.
    pub(super) touch: Option<Numbered<'a>>,
}

/// What was felt of a sample, with its number and its time on the clock of the sensor \[s\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Numbered<'a> {
    pub(super) number: u64,
    pub(super) time: f64,
    pub(super) touch: &'a SceneTouch,
}

/// The contact of a touch, with the load at its point.
pub(super) fn contact(touch: &SceneTouch) -> Option<ContactCells> {
    let Resolution::Contact(contact) = &touch.resolution else { return None };
    let wrench = Wrench::on_fingertip(contact.force, contact.normal * contact.spin_torque);
    Some(ContactCells { position: contact.point, normal: contact.normal, wrench })
}

impl Numbered<'_> {
    /// The sample, whose stamp is the time \[s\] that is written.
    fn sample(&self, written: f64) -> Sample {
        let Self { number, time, touch } = *self;
        let felt = Felt::of(touch, Status::of(&touch.resolution).word(), None);
        let stamp = Duration::try_from_secs_f64(written).unwrap_or_default();
        Sample { number, stamp, ..Sample::new(time, touch.wrench, Some(felt)) }
    }
}

/// Writes rows. A file that is finished is whole, whatever ended the recording.
pub(super) struct Output {
    writer: Writer,
    path: PathBuf,
    has_volts: bool,
    has_contacts: bool,
}

enum Writer {
    Csv(RecordingWriter<Whole>),
    Mcap {
        writer: Box<McapWriter<Whole>>,
        wrench: Topic,
        /// Of the gauges, and of the dummy gauge.
        signals: Option<[Topic; 2]>,
        /// Of contacts, and of all that is felt.
        contact: Option<[Topic; 2]>,
        drawing: Option<Drawing>,
    },
}

impl Output {
    /// Begins a file; `about` is what scenes of its fingertip show.
    pub(super) fn create(
        arguments: &RecordArguments,
        outputs: &Outputs,
        has_volts: bool,
        about: &About,
    ) -> Result<Self, CliError> {
        let has_contacts = about.has_scene;
        let path = arguments.output.as_path();
        let kind = Kind::of(path)?;
        let file = outputs.create("recording", path)?;
        let writer = match kind {
            Kind::Csv => {
                let mut schema = Schema::default().time();
                if has_volts {
                    schema = schema.signals("", 6, SignalUnit::Volt).dummy("", SignalUnit::Volt);
                }
                schema = schema.wrench("");
                if has_contacts {
                    schema = schema.contact();
                }
                Writer::Csv(RecordingWriter::new(file, &schema).map_err(|error| csv(path, error))?)
            }
            Kind::Mcap => {
                let file = file.seekable()?;
                let open = || {
                    let mut writer = McapWriter::with_compression(file, arguments.compression.into())?;
                    let wrench = writer.wrenches("/fingertip/wrench", FRAME)?;
                    let signals = if has_volts {
                        let gauges = writer.signals("/fingertip/signals", FRAME)?;
                        Some([gauges, writer.signals("/fingertip/dummy", FRAME)?])
                    } else {
                        None
                    };
                    let contact = if has_contacts {
                        let contact = writer.contacts("/fingertip/contact", FRAME)?;
                        Some([contact, writer.touches("/fingertip/touch", FRAME)?])
                    } else {
                        None
                    };
                    let drawing = if has_contacts { Drawing::begin(&mut writer, about)? } else { None };
                    Ok(Writer::Mcap { writer: Box::new(writer), wrench, signals, contact, drawing })
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
            Writer::Mcap { writer, wrench, signals, contact, drawing } => {
                let mut write = || {
                    if let (Some([gauges, dummy]), Some(volts)) = (*signals, row.volts) {
                        let parts = [(gauges, volts.as_slice().get(..6)), (dummy, volts.as_slice().get(6..))];
                        for (topic, values) in parts {
                            let (unit, values) = ("V".to_owned(), values.unwrap_or_default().to_vec());
                            writer.write_signals(topic, row.time, RecordedSignals { unit, values })?;
                        }
                    }
                    writer.write_wrench(*wrench, row.time, row.wrench)?;
                    if let (Some([topic, _]), Some(ContactCells { position, normal, wrench })) =
                        (*contact, row.contact)
                    {
                        let name = "fingertip".to_owned();
                        writer.write_contact(
                            topic,
                            row.time,
                            RecordedContact { name, position, normal, wrench },
                        )?;
                    }
                    let sample = row.touch.as_ref().map(|touch| touch.sample(row.time));
                    if let (Some([_, topic]), Some(touch)) =
                        (*contact, sample.as_ref().and_then(recorded_touch))
                    {
                        writer.write_touch(topic, row.time, touch)?;
                    }
                    if let (Some(drawing), Some(sample)) = (drawing.as_mut(), &sample) {
                        drawing.write(writer, row.time, sample)?;
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
            Writer::Csv(writer) => writer.finish().map_err(|error| csv(&self.path, error))?,
            Writer::Mcap { writer, .. } => writer.finish().map_err(|error| mcap(&self.path, &error))?,
        }
        .finish()
    }
}
