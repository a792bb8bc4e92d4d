//! `fingertip recover`: a whole recording from one that was cut or is damaged.

use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;

use clap::Args;
use fingertip_recordings::ReaderOptions;
use fingertip_recordings::mcap::{McapError, recover};

use crate::error::CliError;
use crate::input::Input;
use crate::output::{Outputs, Overwrite};
use crate::recording_file::{Kind, Packing, mcap};
use crate::table::count;

#[derive(Debug, Args)]
#[command(
    after_help = "Of an MCAP file all messages that are whole are copied, of any type, with their definitions: those of a \
    chunk that was never closed too. Chunks whose checksum does not fit are left out. Of a CSV all lines but a cut last \
    one are copied as they are. What a recorder that was killed leaves is called NAME.unfinished-…."
)]
pub(crate) struct RecoverArguments {
    /// The recording: .csv or .mcap
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// The recording to write, of the same kind
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// How to pack an MCAP file
    #[arg(long, value_enum, default_value_t = Packing::None)]
    compression: Packing,
    #[command(flatten)]
    overwrite: Overwrite,
}

pub(crate) fn run(arguments: &RecoverArguments) -> Result<(), CliError> {
    let RecoverArguments { input, output, overwrite, .. } = arguments;
    let outputs = Outputs::guard(*overwrite, "recording", [input], [output])?;
    let mut input = Input::open(input)?;
    let text = match input.kind() {
        Kind::Mcap => messages(arguments, &input, &outputs)?,
        Kind::Csv => lines(arguments, &mut input, &outputs)?,
    };
    outputs.say(&text, &[])
}

fn messages(arguments: &RecoverArguments, input: &Input, outputs: &Outputs) -> Result<String, CliError> {
    let path = arguments.output.as_path();
    let file = outputs.create("recording", path)?.seekable()?;
    let failed = |error| match error {
        McapError::Write(_) => mcap(path, &error),
        _ => mcap(input.path(), &error),
    };
    let (found, file) = recover(input.messages()?, file, arguments.compression.into()).map_err(failed)?;
    if found.messages == 0 {
        let message = "no message in it is whole; there is nothing to recover".to_owned();
        return Err(CliError::Mcap { path: input.path().to_owned(), message });
    }
    file.finish()?;
    let mut text = format!("{} messages recovered\n", count(found.messages));
    for (topic, messages) in &found.topics {
        text.push_str(&format!("  {topic}: {}\n", count(*messages)));
    }
    let mut lost = |happened: bool, what: String| {
        if happened {
            text.push_str(&format!("Lost: {what}\n"));
        }
    };
    lost(found.cut, "what came behind them: the file ends in the middle".to_owned());
    lost(found.damaged_chunks > 0, format!("{} chunks that are damaged", count(found.damaged_chunks)));
    lost(found.damaged_records > 0, format!("{} records that are damaged", count(found.damaged_records)));
    if !found.cut && found.damaged_chunks + found.damaged_records == 0 {
        text.push_str("The file was whole.\n");
    }
    Ok(text)
}

/// Copies all lines but a last one that was cut.
fn lines(arguments: &RecoverArguments, input: &mut Input, outputs: &Outputs) -> Result<String, CliError> {
    // It is read twice: to find what is no row, and to copy the rest as it stands.
    input.keep()?;
    let mut rows = input.rows(ReaderOptions::default())?;
    while rows.next_row()?.is_some() {}
    let (quality, path) = (*rows.quality(), arguments.output.as_path());
    let cut = quality.cut_lines.first_lines().first().copied();
    let mut file = outputs.create("recording", path)?;
    let read = |source| CliError::read("recording", &arguments.input, source);
    let mut from = BufReader::new(input.text()?);
    let (mut line, mut number) = (Vec::new(), 0);
    while from.read_until(b'\n', &mut line).map_err(read)? > 0 {
        number += 1;
        if Some(number) == cut {
            break;
        }
        if !line.ends_with(b"\n") {
            line.push(b'\n');
        }
        file.write_all(&line).map_err(|source| CliError::write("recording", path, source))?;
        line.clear();
    }
    file.finish()?;
    let rest = cut.map_or_else(
        || "The file was whole.\n".to_owned(),
        |line| format!("Lost: line {line}, the last, in which the file was cut\n"),
    );
    Ok(format!("{} rows recovered\n{rest}", count(quality.rows)))
}
