//! From MCAP to CSV.

use std::io::{self, Write};
use std::path::Path;

use fingertip_drivers::recording::mcap::Recorded;
use fingertip_drivers::recording::{ContactCells, RecordingWriter, Schema};

use super::{Account, ConvertArguments, fault};
use crate::error::CliError;
use crate::recording_file::{create, csv, mcap, open, unit as unit_of};

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

pub(super) fn convert(arguments: &ConvertArguments) -> Result<Account, CliError> {
    let ConvertArguments { input, output, force, .. } = arguments;
    let (file, account) = to_csv(input, output, || create(output, *force))?;
    let flushed = file.into_inner().map_err(io::IntoInnerError::into_error);
    flushed.map_err(|source| CliError::write("recording", output, source))?;
    Ok(account)
}

/// Writes a recording as CSV to what `destination` opens once it is known that there is something to write;
/// `output` is for messages.
pub(crate) fn to_csv<W: Write>(
    input: &Path,
    output: &Path,
    destination: impl FnOnce() -> Result<W, CliError>,
) -> Result<(W, Account), CliError> {
    let mut account = Account::default();
    let (schema, mut columns) = survey(input, &mut account)?;

    let width = schema.names().len();
    let mut writer = RecordingWriter::new(destination()?, &schema).map_err(|error| csv(output, error))?;
    let mut reader = open(input)?;
    let mut row = vec![f64::NAN; width];
    let mut at: Option<f64> = None;
    let (mut rows, mut not_finite, mut backward, mut names) = (0_u64, 0, 0, 0);
    let mut written = [0_u64; 3];
    while let Some(entry) = reader.next_entry().map_err(|error| mcap(input, &error))? {
        let Some(index) = columns.iter().position(|columns| columns.topic == entry.topic) else { continue };
        let taken = columns.get(index).is_some_and(|columns| columns.filled);
        if let Some(last) = at.filter(|last| taken || *last != entry.time) {
            row[0] = last;
            writer.write(row.iter().copied()).map_err(|error| csv(output, error))?;
            rows += 1;
            backward += u64::from(entry.time <= last);
            row.fill(f64::NAN);
            columns.iter_mut().for_each(|columns| columns.filled = false);
        }
        at = Some(entry.time);
        let Some(place) = columns.get_mut(index) else { continue };
        place.filled = true;
        let values: Vec<f64> = match &entry.recorded {
            Recorded::Wrench(wrench) => {
                written[0] += 1;
                wrench.components().iter().copied().collect()
            }
            Recorded::Signals(signals) => {
                written[1] += 1;
                signals.values.clone()
            }
            Recorded::Contact(contact) => {
                written[2] += 1;
                names += u64::from(contact.name != "fingertip");
                let (position, normal, wrench) = (contact.position, contact.normal, contact.wrench);
                ContactCells { position, normal, wrench }.cells().to_vec()
            }
            _ => continue,
        };
        not_finite += values.iter().filter(|value| !value.is_finite()).count() as u64;
        for (cell, value) in row.iter_mut().skip(place.start).take(place.width).zip(values) {
            *cell = value;
        }
    }
    if let Some(last) = at {
        row[0] = last;
        writer.write(row.iter().copied()).map_err(|error| csv(output, error))?;
        rows += 1;
    }
    let file = writer.finish().map_err(|error| csv(output, error))?;

    let [wrenches, signals, contacts] = written;
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
    let mut frames: Vec<&str> = columns.iter().map(|columns| columns.frame.as_str()).collect();
    frames.sort_unstable();
    frames.dedup();
    account.lost(frames.len() as u64, format!("names of frames: {}", frames.join(", ")));
    Ok((file, account))
}

/// Reads the file through once: what it holds, and the columns for it.
fn survey(input: &Path, account: &mut Account) -> Result<(Schema, Vec<Columns>), CliError> {
    let mut found: Vec<Columns> = Vec::new();
    let mut others: Vec<(String, u64)> = Vec::new();
    let mut reader = open(input)?;
    while let Some(entry) = reader.next_entry().map_err(|error| mcap(input, &error))? {
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
                    input,
                    format!(
                        "topic {} changes its number of values or their unit at {} s",
                        entry.topic, entry.time
                    ),
                ));
            }
            Some(_) => {}
        }
    }
    if found.is_empty() {
        return Err(fault(input, "it holds no wrenches, signals or contacts"));
    }
    for (topic, number) in &others {
        account.lost(*number, format!("messages of {topic}, which CSV has no columns for"));
    }
    let mut schema = Schema::default().time();
    for index in 0..found.len() {
        let name = name(&found, index, account);
        let Some(columns) = found.get_mut(index) else { continue };
        columns.start = schema.names().len();
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
        return Err(fault(input, format!("two topics would both be the column {twice}; rename one of them")));
    }
    Ok((schema, found))
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
