//! From CSV to MCAP.

use std::io;

use fingertip::wrench::Wrench;
use fingertip_recordings::mcap::{Header, McapError, McapWriter, RecordedContact, RecordedSignals, Topic};
use fingertip_recordings::{ContactCells, RecordingReader, SignalColumns, WrenchColumns};

use super::{Account, ConvertArguments, fault, topic};
use crate::error::CliError;
use crate::recording_file::{FRAME, create, mcap};

/// Times that a stamp holds less exactly than this were rounded \[s\].
const ROUNDED: f64 = 1e-10;

pub(super) fn convert(arguments: &ConvertArguments) -> Result<Account, CliError> {
    let ConvertArguments { input, output, .. } = arguments;
    let mut reader = RecordingReader::open(input)?;
    let layout = reader.layout().clone();
    if !layout.has_time() && arguments.rate.is_none() {
        return Err(fault(
            input,
            "it has no column of time; add one (t_s), or state the samples per second: --rate",
        ));
    }
    let failed = |error: McapError| mcap(output, &error);
    let mut writer = McapWriter::new(create(output, arguments.force)?).map_err(failed)?;
    let frame = |name: &str| if name.is_empty() { FRAME.to_owned() } else { format!("{FRAME}_{name}") };
    let mut wrenches: Vec<(&WrenchColumns, Topic)> = Vec::new();
    for columns in layout.wrenches() {
        let name = columns.name();
        wrenches.push((columns, writer.wrenches(&topic(name, "wrench"), &frame(name)).map_err(failed)?));
    }
    let mut signals: Vec<(&SignalColumns, Topic, Option<Topic>)> = Vec::new();
    for columns in layout.signals() {
        let name = columns.name();
        let gauges = writer.signals(&topic(name, "signals"), &frame(name)).map_err(failed)?;
        let dummy = if columns.has_dummy() {
            Some(writer.signals(&topic(name, "dummy"), &frame(name)).map_err(failed)?)
        } else {
            None
        };
        signals.push((columns, gauges, dummy));
    }
    let contacts = match layout.contacts() {
        Some(columns) => Some((columns, writer.contacts(&topic("", "contact"), FRAME).map_err(failed)?)),
        None => None,
    };

    let (mut rows, mut timeless, mut rounded, mut incomplete) = (0_u64, 0, 0, 0);
    let (mut wrenches_written, mut signals_written, mut contacts_written) = (0, 0, 0);
    while let Some(row) = reader.next_row()? {
        let time = match arguments.rate.filter(|_| !layout.has_time()) {
            Some(rate) => Some(rows as f64 / rate),
            None => row.time(),
        };
        rows += 1;
        let Some(time) = time else {
            timeless += 1;
            continue;
        };
        let stamp = Header::stamped(time, "").ok_or_else(|| {
            fault(input, format!("line {}: a time of {time} s cannot be written to MCAP, whose times are from 0 to 2147483647 s", row.line()))
        })?;
        rounded += u64::from((stamp.time() - time).abs() > ROUNDED + time * f64::EPSILON);
        for (columns, topic) in &wrenches {
            let components = row.unchecked_components(columns);
            if components.iter().all(|component| component.is_finite()) {
                writer
                    .write_wrench(*topic, time, &Wrench::from_components(&components.into()))
                    .map_err(failed)?;
                wrenches_written += 1;
            } else {
                incomplete += 1;
            }
        }
        for (columns, gauges, dummy) in &signals {
            let mut values: Vec<f64> = row.unchecked_signals(columns).collect();
            if values.iter().any(|value| !value.is_finite()) {
                incomplete += 1;
                continue;
            }
            let unit = columns.unit().name().to_owned();
            if let Some((dummy, value)) = dummy.zip(values.pop_if(|_| columns.has_dummy())) {
                let signals = RecordedSignals { unit: unit.clone(), values: vec![value] };
                writer.write_signals(dummy, time, signals).map_err(failed)?;
            }
            writer.write_signals(*gauges, time, RecordedSignals { unit, values }).map_err(failed)?;
            signals_written += 1;
        }
        if let Some((columns, topic)) = contacts
            && let Some(ContactCells { position, normal, wrench }) = row.contact(columns)
        {
            let name = "fingertip".to_owned();
            let contact = RecordedContact { name, position, normal, wrench };
            writer.write_contact(topic, time, contact).map_err(failed)?;
            contacts_written += 1;
        }
    }
    let file = writer.finish().map_err(failed)?;
    let written = file.into_inner().map_err(io::IntoInnerError::into_error);
    written.map_err(|source| CliError::write("recording", output, source))?;

    let mut account = Account::default();
    account.written("wrenches", wrenches_written);
    account.written("signals", signals_written);
    account.written("contacts", contacts_written);
    if rows == 0 {
        return Err(CliError::NoRows { path: input.clone() });
    }
    account.lost(timeless, "rows without a usable time");
    account.lost(incomplete, "samples of which a number is missing or not finite");
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
