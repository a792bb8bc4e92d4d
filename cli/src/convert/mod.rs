//! `fingertip convert`: recordings from CSV to MCAP and back.

mod from_csv;
mod from_mcap;
mod mcap_rows;

use core::cell::Cell;
use core::fmt::Display;
use std::path::{Path, PathBuf};

use clap::Args;

pub(crate) use from_mcap::McapAsCsv;

use crate::error::CliError;
use crate::input::Input;
use crate::output::{Outputs, Overwrite, read_once};
use crate::recording_file::{FRAME, Kind, Packing};
use crate::several;
use crate::span::Span;
use crate::standard::{is_standard, shown};
use crate::table::count;

#[derive(Debug, Args)]
#[command(after_help = "\
CSV holds one row for each time, MCAP one message for each sensor and time:
  fx_N … tz_Nm                       /fingertip/wrench, geometry_msgs/msg/WrenchStamped
  v1_V …                             /fingertip/signals, fingertip_msgs/msg/Signals
  dummy_V                            /fingertip/dummy, the same
  contact_x_m … contact_spin_z_Nm    /fingertip/contact, tactile_msgs/msg/TactileContact
A sensor NAME (columns NAME_fx_N …) has the topics /fingertip/NAME/wrench and so on. Whatever the
other format cannot hold is counted and named at the end.")]
pub(crate) struct ConvertArguments {
    /// The recordings to read: .csv or .mcap; `-` is the standard input
    #[arg(value_name = "IN", required = true)]
    pub(crate) inputs: Vec<PathBuf>,
    /// The recording to write: .mcap or .csv; or a folder that is there, where RUN.csv becomes RUN.mcap, and RUN.mcap
    /// RUN.csv: of several recordings it must be one
    #[arg(value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) span: Span,
    /// Samples per second of a CSV file that has no column of time
    #[arg(long, value_name = "HZ")]
    pub(crate) rate: Option<f64>,
    /// Of an MCAP file, this topic alone; several times for several
    #[arg(long = "topic", value_name = "TOPIC")]
    pub(crate) topics: Vec<String>,
    /// How to pack an MCAP file
    #[arg(long, value_enum, default_value_t = Packing::None)]
    pub(crate) compression: Packing,
    #[command(flatten)]
    pub(crate) overwrite: Overwrite,
    /// As --overwrite
    #[arg(long, hide = true)]
    pub(crate) force: bool,
}

/// What was converted, and what was not.
#[derive(Clone, Debug, Default)]
struct Account {
    written: Vec<(&'static str, u64)>,
    lost: Vec<String>,
    /// What the columns came from.
    notes: Vec<String>,
}

impl Account {
    fn written(&mut self, what: &'static str, number: u64) {
        if number > 0 {
            self.written.push((what, number));
        }
    }

    /// Says that something was lost so many times, if it was.
    fn lost(&mut self, number: u64, what: impl Display) {
        if number > 0 {
            self.lost.push(format!("{} {what}", count(number)));
        }
    }
}

/// What one recording becomes.
struct Task {
    input: Input,
    output: PathBuf,
}

pub(crate) fn run(arguments: &ConvertArguments) -> Result<(), CliError> {
    let ConvertArguments { inputs, output, .. } = arguments;
    arguments.span.check()?;
    if let Some(rate) = arguments.rate
        && !(rate > 0.0 && rate.is_finite())
    {
        return Err(CliError::option("--rate", rate, "must be above 0"));
    }
    read_once(inputs.iter().map(PathBuf::as_path))?;
    if let (false, [first, _, ..]) = (output.is_dir(), inputs.as_slice()) {
        let message = format!(
            "of several recordings the last path must be a folder that is there, which {} is not",
            shown(output)
        );
        return Err(fault(first, message));
    }
    if let ([input], false) = (inputs.as_slice(), output.is_dir()) {
        // Before the standard input is waited for.
        let outputs = guard(arguments, [input], [output])?;
        Kind::of(output)?;
        return one(arguments, Task { input: Input::open(input)?, output: output.clone() }, &outputs);
    }
    let tasks = inputs.iter().map(|input| {
        let input = Input::open(input)?;
        let output = output.join(name_in_folder(&input));
        Ok(Task { input, output })
    });
    let tasks: Vec<Task> = tasks.collect::<Result<_, CliError>>()?;
    let outputs = guard(arguments, inputs, tasks.iter().map(|task| &task.output))?;
    let tasks: Vec<Cell<Option<Task>>> = tasks.into_iter().map(|task| Cell::new(Some(task))).collect();
    several::each(inputs, &tasks, |_, task| match task.take() {
        Some(task) => one(arguments, task, &outputs.part()),
        None => Ok(()),
    })
}

fn guard<'a>(
    arguments: &ConvertArguments,
    inputs: impl IntoIterator<Item = &'a PathBuf>,
    outputs: impl IntoIterator<Item = &'a PathBuf>,
) -> Result<Outputs, CliError> {
    Outputs::guard(arguments.overwrite.or(arguments.force), "recording", inputs, outputs)
}

/// The name of what a recording becomes, in a folder.
fn name_in_folder(input: &Input) -> String {
    let stem = input.path().file_stem().filter(|_| !is_standard(input.path()));
    let stem = stem.map_or_else(|| input.name(), |stem| stem.to_string_lossy().into_owned());
    let ending = match input.kind() {
        Kind::Csv => "mcap",
        Kind::Mcap => "csv",
    };
    format!("{stem}.{ending}")
}

/// One of the recordings.
fn one(arguments: &ConvertArguments, task: Task, outputs: &Outputs) -> Result<(), CliError> {
    let Task { mut input, output } = task;
    let account = match (input.kind(), Kind::of(&output)?) {
        (Kind::Csv, Kind::Mcap) => from_csv::convert(arguments, &mut input, &output, outputs),
        (Kind::Mcap, Kind::Csv) => from_mcap::convert(arguments, &input, &output, outputs),
        _ => {
            let same = "input and output are of the same kind; one must be .csv and the other .mcap";
            Err(fault(input.path(), same))
        }
    }?;
    let mut text = String::new();
    let written: Vec<String> =
        account.written.iter().map(|(what, number)| format!("{} {what}", count(*number))).collect();
    text.push_str(&format!("{} → {}: {}\n", input.name(), output.display(), written.join(", ")));
    for note in arguments.span.note().iter().chain(&account.notes) {
        text.push_str(&format!("Note: {note}\n"));
    }
    match account.lost.as_slice() {
        [] => text.push_str("Nothing was lost.\n"),
        lost => text.push_str(&format!("Lost: {}\n", lost.join("; "))),
    }
    outputs.tell(&text)
}

fn fault(path: &Path, message: impl Display) -> CliError {
    CliError::Convert { path: path.to_owned(), message: message.to_string() }
}

/// The name of a sensor's frame, where nothing else names one.
fn usual_frame(sensor: &str) -> String {
    if sensor.is_empty() { FRAME.to_owned() } else { format!("{FRAME}_{sensor}") }
}

/// The topic of a sensor's messages.
fn topic(sensor: &str, what: &str) -> String {
    if sensor.is_empty() { format!("/fingertip/{what}") } else { format!("/fingertip/{sensor}/{what}") }
}
