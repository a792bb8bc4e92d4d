//! What an MCAP file holds.

use alloc::collections::BTreeMap;

use fingertip_recordings::Timing;
use fingertip_recordings::mcap::{McapError, Recorded};

use super::{Info, Topic};
use crate::error::CliError;
use crate::input::Input;
use crate::recording_file::{cut, mcap};
use crate::span::{Place, Span, Window};

pub(super) fn of(input: &Input, span: Span) -> Result<Info, CliError> {
    let mut info = Info { file: input.name(), format: "mcap", ..Info::default() };
    let mut topics: BTreeMap<String, (Topic, Timing)> = BTreeMap::new();
    let mut timing = Timing::default();
    let mut reader = input.entries()?;
    let (mut damaged, mut window) = (0_u64, Window::new(span));
    info.notes.extend(span.note());
    loop {
        let entry = match reader.next_entry() {
            Ok(Some(entry)) => entry,
            Ok(None) => break,
            Err(McapError::Cut) => {
                info.notes.push(cut(input.path(), reader.messages()));
                break;
            }
            Err(McapError::Message { .. }) => {
                damaged += 1;
                continue;
            }
            Err(error) => return Err(mcap(input.path(), &error)),
        };
        match window.place(entry.time) {
            Place::Before => continue,
            Place::Behind => break,
            Place::Within => info.samples += 1,
        }
        timing.add(entry.time);
        let name = entry.topic;
        let (topic, times) = topics.entry(name).or_insert_with_key(|name| {
            let holds = holds(&entry.recorded);
            let topic = Topic { name: name.clone(), holds, frame: entry.frame, ..Topic::default() };
            (topic, Timing::default())
        });
        topic.messages += 1;
        times.add(entry.time);
    }
    info.samples += damaged;
    if damaged > 0 {
        info.notes.push(format!("{damaged} messages are not what their definition says"));
    }
    let said = |(topic, times): (Topic, Timing)| Topic { steps: (&times).into(), ..topic };
    info.topics = topics.into_values().map(said).collect();
    // Of several topics beside one another the times of all say nothing.
    if info.topics.len() <= 1 {
        info.steps = (&timing).into();
    }
    Ok(info)
}

fn holds(recorded: &Recorded) -> String {
    match recorded {
        Recorded::Wrench(_) => "wrenches [N, N·m]".to_owned(),
        Recorded::Signals(signals) => format!("{} signals [{}]", signals.values.len(), signals.unit),
        Recorded::Contact(_) => "contacts".to_owned(),
        Recorded::Touch(_) => "touches: contact, forces, margin, slip".to_owned(),
        _ => "messages of a type that is not read".to_owned(),
    }
}
