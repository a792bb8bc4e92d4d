//! `fingertip info`: what a recording holds, as the other commands would understand it.

mod columns;
mod messages;
mod rows;
pub(crate) mod steps;

use core::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use crate::error::CliError;
use crate::input::Input;
use crate::output::{print, read_once};
use crate::recording_file::Kind;
use crate::span::Span;
use crate::table::{count, short};
use steps::Steps;

#[derive(Debug, Args)]
pub(crate) struct InfoArguments {
    /// The recordings: .csv or .mcap; `-` is the standard input
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    span: Span,
    /// As JSON: one object a line for each file
    #[arg(long)]
    json: bool,
}

/// What was found in a file.
#[derive(Debug, Default, Serialize)]
struct Info {
    file: String,
    format: &'static str,
    /// Rows of CSV, or messages.
    samples: u64,
    #[serde(flatten)]
    steps: Steps,
    /// Of CSV: columns, and what they are taken for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    columns: Vec<Column>,
    /// Of MCAP.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    topics: Vec<Topic>,
    /// What is wrong with it, and what to mind.
    notes: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Column {
    name: String,
    meaning: String,
}

#[derive(Debug, Default, Serialize)]
struct Topic {
    name: String,
    holds: String,
    #[serde(skip_serializing_if = "String::is_empty")]
    frame: String,
    messages: u64,
    #[serde(flatten)]
    steps: Steps,
}

pub(crate) fn run(arguments: &InfoArguments) -> Result<(), CliError> {
    arguments.span.check()?;
    read_once(arguments.files.iter().map(PathBuf::as_path))?;
    for path in &arguments.files {
        let mut input = Input::open(path)?;
        let info = match input.kind() {
            Kind::Csv => rows::of(&mut input, arguments.span)?,
            Kind::Mcap => messages::of(&input, arguments.span)?,
        };
        let text = if arguments.json {
            let json = serde_json::to_string(&info);
            json.map_err(|error| CliError::Stdout(error.into()))? + "\n"
        } else {
            info.to_string()
        };
        print(&text)?;
    }
    Ok(())
}

impl core::fmt::Display for Info {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let what = if self.format == "csv" { "rows" } else { "messages" };
        writeln!(f, "{}: {}, {} {what}", self.file, self.format.to_uppercase(), count(self.samples))?;
        f.write_str(&self.steps.said("  "))?;
        let width = self.columns.iter().map(|column| column.name.chars().count()).max().unwrap_or(0);
        for Column { name, meaning } in &self.columns {
            writeln!(f, "  {name:<width$}  {meaning}")?;
        }
        for topic in &self.topics {
            let mut line = format!("  {}: {} messages, {}", topic.name, count(topic.messages), topic.holds);
            if !topic.frame.is_empty() {
                // Writing to a string cannot fail.
                let _ = write!(line, ", frame {}", topic.frame);
            }
            writeln!(f, "{line}")?;
            f.write_str(&topic.steps.said("    "))?;
        }
        for note in &self.notes {
            writeln!(f, "  note: {note}")?;
        }
        Ok(())
    }
}

/// A number of seconds that a reader expects.
fn seconds(value: f64) -> String {
    format!("{} s", short(value))
}
