//! From CSV to MCAP.

use std::io;
use std::path::Path;

use fingertip::wrench::Wrench;
use fingertip_recordings::mcap::{Header, McapError, McapWriter, RecordedContact, RecordedSignals, Topic};
use fingertip_recordings::{
    ContactCells, ContactColumns, Layout, ReaderOptions, Row, SignalColumns, WrenchColumns,
};

use super::{Account, ConvertArguments, fault, topic, usual_frame};
use crate::error::CliError;
use crate::input::Input;
use crate::output::Outputs;
use crate::recording_file::mcap;
use crate::span::{Place, Window};

/// Times that a stamp holds less exactly than this were rounded \[s\].
const ROUNDED: f64 = 1e-10;

pub(super) fn convert(
    arguments: &ConvertArguments,
    input: &mut Input,
    output: &Path,
    outputs: &Outputs,
) -> Result<Account, CliError> {
    let mut reader = input.rows(ReaderOptions::default())?;
    let input = input.path();
    let layout = reader.layout().clone();
    if !layout.has_time() && arguments.rate.is_none() {
        return Err(fault(
            input,
            "it has no column of time; add one (t_s), or state the samples per second: --rate",
        ));
    }
    let failed = |error: McapError| mcap(output, &error);
    let file = outputs.create("recording", output)?.seekable()?;
    let writer = McapWriter::with_compression(file, arguments.compression.into()).map_err(failed)?;
    let mut topics = Topics::open(writer, &layout).map_err(failed)?;
    let (mut rows, mut within, mut timeless, mut rounded) = (0_u64, 0_u64, 0, 0);
    let mut window = Window::new(arguments.span);
    while let Some(row) = reader.next_row()? {
        let time = match arguments.rate.filter(|_| !layout.has_time()) {
            Some(rate) => Some(rows as f64 / rate),
            None => row.time(),
        };
        rows += 1;
        match window.place(time.unwrap_or(f64::NAN)) {
            Place::Before => continue,
            Place::Behind => break,
            Place::Within => within += 1,
        }
        let Some(time) = time else {
            timeless += 1;
            continue;
        };
        let stamp = Header::stamped(time, "").ok_or_else(|| {
            fault(input, format!("line {}: a time of {time} s cannot be written to MCAP, whose times are from 0 to 2147483647 s", row.line()))
        })?;
        rounded += u64::from((stamp.time() - time).abs() > ROUNDED + time * f64::EPSILON);
        topics.write(time, &row).map_err(failed)?;
    }
    let Topics { writer, counts, .. } = topics;
    let file = writer.finish().map_err(failed)?;
    if within == 0 {
        return Err(window.nothing_of(input));
    }
    file.finish()?;
    let mut account = Account::default();
    let cut = reader.quality().cut_lines;
    if let Some(line) = cut.first_lines().first() {
        account.lost.push(format!("line {line}, the last, in which the file was cut"));
    }
    account.written("wrenches", counts.wrenches);
    account.written("signals", counts.signals);
    account.written("contacts", counts.contacts);
    account.lost(timeless, "rows without a usable time");
    account.lost(counts.incomplete, "samples of which a number is missing or not finite");
    account.lost(rounded, "times rounded to nanoseconds");
    let ignored: Vec<&str> = layout.ignored().collect();
    if !ignored.is_empty() {
        account.lost(
            ignored.len() as u64,
            format!("columns that MCAP has no message for here: {}", ignored.join(", ")),
        );
    }
    for left_out in layout.left_out() {
        account.lost.push(left_out.problem.to_string());
    }
    Ok(account)
}

/// The topics of a file, each for columns of a recording.
struct Topics<'a, W: io::Write + io::Seek> {
    writer: McapWriter<W>,
    wrenches: Vec<(&'a WrenchColumns, Topic)>,
    /// With that of the dummy gauge.
    signals: Vec<(&'a SignalColumns, Topic, Option<Topic>)>,
    contacts: Option<(&'a ContactColumns, Topic)>,
    counts: Counts,
}

/// How many messages were written, and how many samples were not.
#[derive(Default)]
struct Counts {
    wrenches: u64,
    signals: u64,
    contacts: u64,
    incomplete: u64,
}

impl<'a, W: io::Write + io::Seek> Topics<'a, W> {
    fn open(mut writer: McapWriter<W>, layout: &'a Layout) -> Result<Self, McapError> {
        let frame = |name: &str| layout.frame(name).map_or_else(|| usual_frame(name), str::to_owned);
        let mut wrenches = Vec::new();
        for columns in layout.wrenches() {
            let name = columns.name();
            wrenches.push((columns, writer.wrenches(&topic(name, "wrench"), &frame(name))?));
        }
        let mut signals = Vec::new();
        for columns in layout.signals() {
            let name = columns.name();
            let gauges = writer.signals(&topic(name, "signals"), &frame(name))?;
            let dummy = match columns.has_dummy() {
                true => Some(writer.signals(&topic(name, "dummy"), &frame(name))?),
                false => None,
            };
            signals.push((columns, gauges, dummy));
        }
        let contacts = match layout.contacts() {
            Some(columns) => Some((columns, writer.contacts(&topic("", "contact"), &frame(""))?)),
            None => None,
        };
        Ok(Self { writer, wrenches, signals, contacts, counts: Counts::default() })
    }

    fn write(&mut self, time: f64, row: &Row<'_>) -> Result<(), McapError> {
        let Self { writer, counts, .. } = self;
        for (columns, topic) in &self.wrenches {
            let components = row.unchecked_components(columns);
            if components.iter().all(|component| component.is_finite()) {
                writer.write_wrench(*topic, time, &Wrench::from_components(&components.into()))?;
                counts.wrenches += 1;
            } else {
                counts.incomplete += 1;
            }
        }
        for (columns, gauges, dummy) in &self.signals {
            let mut values: Vec<f64> = row.unchecked_signals(columns).collect();
            if values.iter().any(|value| !value.is_finite()) {
                counts.incomplete += 1;
                continue;
            }
            let unit = columns.unit().name().to_owned();
            if let Some((dummy, value)) = dummy.zip(values.pop_if(|_| columns.has_dummy())) {
                let signals = RecordedSignals { unit: unit.clone(), values: vec![value] };
                writer.write_signals(dummy, time, signals)?;
            }
            writer.write_signals(*gauges, time, RecordedSignals { unit, values })?;
            counts.signals += 1;
        }
        if let Some((columns, topic)) = self.contacts
            && let Some(ContactCells { position, normal, wrench }) = row.contact(columns)
        {
            let name = "fingertip".to_owned();
            writer.write_contact(topic, time, RecordedContact { name, position, normal, wrench })?;
            counts.contacts += 1;
        }
        Ok(())
    }
}
