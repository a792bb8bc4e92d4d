//! The rows of CSV that an MCAP file has, one for each time.

use std::io::Read;
use std::path::{Path, PathBuf};

use fingertip_recordings::mcap::{Entry, McapError, McapReader, Recorded};
use fingertip_recordings::{ContactCells, Schema};

use super::{Account, fault, usual_frame};
use crate::error::CliError;
use crate::input::Input;
use crate::recording_file::{cut, mcap, unit as unit_of};

/// A topic, and the columns that its messages fill.
struct Columns {
    topic: String,
    kind: What,
    frame: String,
    /// The first of its columns.
    start: usize,
    width: usize,
    /// Whether the row at hand has its cells already.
    filled: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum What {
    Wrench,
    Signals(String),
    Contact,
    Other,
}

impl What {
    fn of(recorded: &Recorded) -> (Self, usize) {
        match recorded {
            Recorded::Wrench(_) => (Self::Wrench, 6),
            Recorded::Signals(signals) => (Self::Signals(signals.unit.clone()), signals.values.len()),
            Recorded::Contact(_) => (Self::Contact, 12),
            _ => (Self::Other, 0),
        }
    }
}

/// Reads row after row, in memory that does not grow with the file.
pub(super) struct Rows<R> {
    reader: McapReader<R>,
    input: PathBuf,
    columns: Vec<Columns>,
    row: Vec<f64>,
    /// The first entry of the next row.
    waiting: Option<Entry>,
    /// What the last row holds, and what all do that were counted.
    last: Counts,
    counted: Counts,
}

#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    wrenches: u64,
    signals: u64,
    contacts: u64,
    rows: u64,
    not_finite: u64,
    backward: u64,
    names: u64,
}

impl<R: Read> Rows<R> {
    /// The rows of `file`, which is that at `input`. The latter is read through once, to see what there is; what to
    /// know of that goes to `account`.
    pub(super) fn new(
        file: R,
        input: &Input,
        topics: &[String],
        account: &mut Account,
    ) -> Result<(Schema, Self), CliError> {
        let (schema, columns) = survey(input, topics, account)?;
        let input = input.path();
        let rows = Self {
            reader: McapReader::new(file).map_err(|error| mcap(input, &error))?,
            input: input.to_owned(),
            columns,
            row: vec![f64::NAN; schema.names().len()],
            waiting: None,
            last: Counts::default(),
            counted: Counts::default(),
        };
        Ok((schema, rows))
    }

    /// The next row, a number for each column of the schema; NaN where there is none.
    pub(super) fn next(&mut self) -> Result<Option<&[f64]>, CliError> {
        self.row.fill(f64::NAN);
        self.columns.iter_mut().for_each(|columns| columns.filled = false);
        self.last = Counts::default();
        let mut at = None;
        loop {
            let entry = match self.waiting.take() {
                None => next(&mut self.reader, &self.input)?,
                waiting => waiting,
            };
            let Some(entry) = entry else { break };
            let Some(place) = self.columns.iter_mut().find(|columns| columns.topic == entry.topic) else {
                continue;
            };
            if let Some(last) = at.filter(|last| place.filled || *last != entry.time) {
                self.last.backward += u64::from(entry.time <= last);
                self.waiting = Some(entry);
                break;
            }
            at = Some(entry.time);
            place.filled = true;
            let cells = self.row.iter_mut().skip(place.start).take(place.width);
            match &entry.recorded {
                Recorded::Wrench(wrench) => {
                    self.last.wrenches += 1;
                    self.last.not_finite += put(cells, wrench.components().as_slice());
                }
                Recorded::Signals(signals) => {
                    self.last.signals += 1;
                    self.last.not_finite += put(cells, &signals.values);
                }
                Recorded::Contact(contact) => {
                    self.last.contacts += 1;
                    self.last.names += u64::from(contact.name != "fingertip");
                    let (position, normal, wrench) = (contact.position, contact.normal, contact.wrench);
                    self.last.not_finite += put(cells, &ContactCells { position, normal, wrench }.cells());
                }
                _ => {}
            }
        }
        let (Some(at), Some(time)) = (at, self.row.first_mut()) else { return Ok(None) };
        *time = at;
        self.last.rows += 1;
        Ok(Some(&self.row))
    }

    /// Counts the last row among those that are told of.
    pub(super) fn count(&mut self) {
        let Self { counted: all, last, .. } = self;
        all.wrenches += last.wrenches;
        all.signals += last.signals;
        all.contacts += last.contacts;
        all.rows += last.rows;
        all.not_finite += last.not_finite;
        all.backward += last.backward;
        all.names += last.names;
    }

    /// How many rows were counted.
    pub(super) fn counted(&self) -> u64 {
        self.counted.rows
    }

    /// Says what was counted, and what of it rows cannot hold.
    pub(super) fn account(&self, account: &mut Account) {
        let Counts { wrenches, signals, contacts, rows, not_finite, backward, names } = self.counted;
        account.written("wrenches", wrenches);
        account.written("signals", signals);
        account.written("contacts", contacts);
        account.written("rows", rows);
        account.lost(not_finite, "numbers that are not finite (NaN becomes an empty cell)");
        account.lost(names, "names of contacts");
        if backward > 0 {
            account.notes.push(format!(
                "{backward} rows have a time that is not after that of the row before; other commands pass over them"
            ));
        }
    }
}

/// Fills cells, and counts the values that are not finite.
fn put<'a>(cells: impl Iterator<Item = &'a mut f64>, values: &[f64]) -> u64 {
    for (cell, value) in cells.zip(values) {
        *cell = *value;
    }
    values.iter().filter(|value| !value.is_finite()).count() as u64
}

/// Reads the file through once: what it holds, and the columns for it.
fn survey(
    input: &Input,
    topics: &[String],
    account: &mut Account,
) -> Result<(Schema, Vec<Columns>), CliError> {
    let mut found: Vec<Columns> = Vec::new();
    let mut others: Vec<(String, u64)> = Vec::new();
    let mut passed_over: Vec<String> = Vec::new();
    let mut reader = input.entries()?;
    let path = input.path();
    loop {
        let entry = match reader.next_entry() {
            Ok(Some(entry)) => entry,
            Ok(None) => break,
            Err(McapError::Cut) => {
                account.notes.push(cut(path, reader.messages()));
                break;
            }
            Err(error) => return Err(mcap(path, &error)),
        };
        if !(topics.is_empty() || topics.contains(&entry.topic)) {
            if !passed_over.contains(&entry.topic) {
                passed_over.push(entry.topic);
            }
            continue;
        }
        let (kind, width) = What::of(&entry.recorded);
        let second_contact = kind == What::Contact
            && found.iter().any(|known| known.kind == kind && known.topic != entry.topic);
        if kind == What::Other || second_contact {
            match others.iter_mut().find(|(topic, _)| *topic == entry.topic) {
                Some((_, number)) => *number += 1,
                None => others.push((entry.topic, 1)),
            }
            continue;
        }
        match found.iter().find(|known| known.topic == entry.topic) {
            None => {
                let (topic, frame) = (entry.topic, entry.frame);
                found.push(Columns { topic, kind, frame, start: 0, width, filled: false });
            }
            Some(known) if known.width != width || known.kind != kind => {
                return Err(fault(
                    path,
                    format!(
                        "topic {} changes its number of values or their unit at {} s",
                        entry.topic, entry.time
                    ),
                ));
            }
            Some(_) => {}
        }
    }
    let has = |topic: &str| {
        found.iter().any(|known| known.topic == topic) || others.iter().any(|(known, _)| known == topic)
    };
    if let Some(topic) = topics.iter().find(|topic| !has(topic)) {
        let known = found.iter().map(|known| &known.topic).chain(&passed_over);
        let known: Vec<&str> = known.map(String::as_str).collect();
        return Err(CliError::NoTopic {
            path: path.to_owned(),
            topic: topic.clone(),
            known: known.join(", "),
        });
    }
    if found.is_empty() {
        return Err(fault(path, "it holds no wrenches, signals or contacts"));
    }
    for (topic, number) in &others {
        account.lost(*number, format!("messages of {topic}, which CSV has no columns for"));
    }
    let mut schema = Schema::default().time();
    let mut frames: Vec<(String, String)> = Vec::new();
    for index in 0..found.len() {
        let name = name(&found, index, account);
        let Some(columns) = found.get_mut(index) else { continue };
        columns.start = schema.names().len();
        frames.push((name.clone(), columns.frame.clone()));
        schema = match &columns.kind {
            What::Wrench => schema.wrench(&name),
            What::Signals(unit) => {
                let unit = unit_of(unit);
                if columns.topic.ends_with("/dummy") && columns.width == 1 {
                    schema.dummy(&name, unit)
                } else {
                    schema.signals(&name, columns.width, unit)
                }
            }
            What::Contact => schema.contact(),
            What::Other => schema,
        };
    }
    let mut names = schema.names().to_vec();
    names.sort_unstable();
    if let Some([twice, _]) = names.array_windows().find(|[a, b]| a == b) {
        return Err(fault(path, format!("two topics would both be the column {twice}; rename one of them")));
    }
    Ok((with_frames(schema, &frames, account), found))
}

/// Names the frames that are not those which `convert` gives by itself; of two for one sensor the first.
fn with_frames(mut schema: Schema, frames: &[(String, String)], account: &mut Account) -> Schema {
    let mut lost: Vec<&str> = Vec::new();
    for (index, (sensor, frame)) in frames.iter().enumerate() {
        match frames.iter().take(index).find(|(of, _)| of == sensor) {
            Some((_, first)) if first != frame => lost.push(frame),
            None if *frame != usual_frame(sensor) => schema = schema.frame(sensor, frame),
            _ => {}
        }
    }
    lost.sort_unstable();
    lost.dedup();
    account.lost(lost.len() as u64, format!("names of frames: {}", lost.join(", ")));
    schema
}

/// The next entry; a file that was cut, which the survey has said, ends there.
fn next<R: Read>(reader: &mut McapReader<R>, path: &Path) -> Result<Option<Entry>, CliError> {
    match reader.next_entry() {
        Err(McapError::Cut) => Ok(None),
        entry => entry.map_err(|error| mcap(path, &error)),
    }
}

/// The name of the sensor of a topic, as the prefix of its columns: nothing for our own topics without one,
/// and for the only topic of its kind.
fn name(found: &[Columns], index: usize, account: &mut Account) -> String {
    let Some(columns) = found.get(index) else { return String::new() };
    let own = columns.topic.strip_prefix("/fingertip/");
    if let Some((path, _)) = own.map(|path| path.rsplit_once('/').unwrap_or(("", path))) {
        return path.to_owned();
    }
    let same =
        |other: &&Columns| core::mem::discriminant(&other.kind) == core::mem::discriminant(&columns.kind);
    if found.iter().filter(same).count() == 1 {
        account.notes.push(format!("topic {} has the columns without a name", columns.topic));
        return String::new();
    }
    let plain = columns.topic.trim_matches('/').replace(|letter: char| !letter.is_alphanumeric(), "-");
    account.notes.push(format!("topic {} has the columns {plain}_…", columns.topic));
    plain
}
