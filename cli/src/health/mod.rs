//! `fingertip health`: what a recording tells of the sensor itself.

mod columns;
mod library;
mod page;
mod pictures;
mod words;

use std::path::{Path, PathBuf};

use clap::Args;
use fingertip_recordings::health::{Depth, Health, Level};
use fingertip_recordings::{HeaderProblem, ReaderOptions};

use crate::calibrated::Calibration;
use crate::error::CliError;
use crate::gauge_rows::KnownTemperature;
use crate::opened::Opened;
use crate::output::{Outputs, Overwrite};
use crate::several::{self, file_of};
use crate::span::{Place, Span, Window};
pub(crate) use columns::{WatchedRows, of_gauges, of_table, of_wrench};
pub use library::{HealthOf, health};
pub(crate) use words::{seen, seen_in_loads};

#[derive(Debug, Args)]
#[command(after_help = "\
Best is a recording of some seconds in which the sensor rests: that tells its noise, drift and
lines. One with loads tells which channels are dead, stuck or clipped. Exit code 1: readings are
wrong.")]
pub(crate) struct HealthArguments {
    /// The recording: .csv or .mcap; `-` is the standard input. Of several, each writes files of its own: RUN.csv with
    /// --html page.html writes RUN.page.html
    #[arg(value_name = "FILE", required = true)]
    recordings: Vec<PathBuf>,
    /// The calibration, for a recording of signals: TOML, or an ATI .cal; figures are then given of the wrench, too
    #[arg(long, value_name = "CAL")]
    calibration: Option<PathBuf>,
    /// Temperature of the whole recording, for a calibration that drifts with it and a recording without
    /// column temperature_C
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true)]
    celsius: Option<f64>,
    /// This sensor alone: the prefix of its columns (S1 for S1_Fx_N)
    #[arg(long, value_name = "PREFIX")]
    sensor: Option<String>,
    /// Of an MCAP file, this topic alone; several times for several
    #[arg(long = "topic", value_name = "TOPIC")]
    topics: Vec<String>,
    #[command(flatten)]
    span: Span,
    /// Samples per second of a recording that has no column of time
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// Write a page with pictures
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Write all figures as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    #[command(flatten)]
    overwrite: Overwrite,
}

impl HealthArguments {
    /// Options that mean something.
    fn check(&self) -> Result<(), CliError> {
        match self.rate.filter(|rate| !(*rate > 0.0 && rate.is_finite())) {
            Some(rate) => {
                Err(CliError::option("--rate", rate, "must be a number of samples a second above 0"))
            }
            None => Ok(()),
        }
    }
}

pub(crate) fn run(arguments: &HealthArguments) -> Result<(), CliError> {
    arguments.check()?;
    arguments.span.check()?;
    let files = |recording: &PathBuf| {
        let own = |file: &PathBuf| file_of(recording, &arguments.recordings, file);
        [arguments.html.as_ref().map(own), arguments.json.as_ref().map(own)]
    };
    let all: Vec<[Option<PathBuf>; 2]> = arguments.recordings.iter().map(files).collect();
    let inputs = arguments.recordings.iter().chain(&arguments.calibration);
    let outputs = Outputs::guard(arguments.overwrite, "output", inputs, all.iter().flatten().flatten())?;
    several::each(&arguments.recordings, &all, |recording, files| {
        one(recording, arguments, files, &outputs.part())
    })
}

/// One of the recordings.
fn one(
    recording: &Path,
    arguments: &HealthArguments,
    [html, json]: &[Option<PathBuf>; 2],
    outputs: &Outputs,
) -> Result<(), CliError> {
    let mut notes = Vec::new();
    let (health, name) = watched(recording, arguments, &mut notes)?;
    let findings = words::findings(&health, &name, notes);
    if let Some(path) = html {
        outputs.write("report", path, &page::of(&health, &findings))?;
    }
    if let Some(path) = json {
        let text = serde_json::to_string_pretty(&health);
        let text = text.map_err(|error| CliError::write("report", path, error.into()))?;
        outputs.write("report", path, &(text + "\n"))?;
    }
    outputs.say(&findings.to_string(), &[])?;
    let worst = health.findings.first().filter(|finding| finding.level == Level::Bad);
    match worst {
        Some(worst) => Err(CliError::Unhealthy { path: recording.to_owned(), reason: worst.said.clone() }),
        None => Ok(()),
    }
}

/// Everything that the recording shows, and its name.
fn watched(
    recording: &Path,
    arguments: &HealthArguments,
    notes: &mut Vec<String>,
) -> Result<(Health, String), CliError> {
    let options = ReaderOptions::default();
    let Opened { rows: mut reader, bar, name } = Opened::open(recording, &arguments.topics, options, notes)?;
    let temperature = arguments
        .celsius
        .map(KnownTemperature::Constant)
        .or_else(|| reader.watch("temperature_C").map(KnownTemperature::Column));
    let layout = reader.layout().clone();
    let header = |problem: HeaderProblem| CliError::Recording(reader.header_error(problem));
    let calibration = arguments.calibration.as_deref().map(Calibration::read).transpose()?;
    let mut rows = WatchedRows::of(&layout, arguments.sensor.as_deref(), Depth::Full).map_err(header)?;
    if let Some(calibration) = &calibration {
        rows =
            rows.calibrated(&layout, arguments.sensor.as_deref(), calibration, temperature, notes, header)?;
    }
    if let Some(rate) = arguments.rate {
        rows = rows.with_rate(rate);
    }
    for left_out in layout.left_out() {
        notes.push(left_out.problem.to_string());
    }
    if !layout.has_time() && arguments.rate.is_none() {
        notes.push(
            "the recording has no column of time: times are numbers of samples; state --rate for a spectrum"
                .to_owned(),
        );
    }
    arguments.span.needs_time(layout.has_time() || arguments.rate.is_some())?;
    notes.extend(arguments.span.note());
    let (mut window, mut number) = (Window::new(arguments.span), 0_u64);
    while let Some(row) = reader.next_row()? {
        let counted = arguments.rate.filter(|_| !layout.has_time()).map(|rate| number as f64 / rate);
        number += 1;
        match window.place(row.time().or(counted).unwrap_or(f64::NAN)) {
            Place::Before => {}
            Place::Behind => break,
            Place::Within => rows.add(&row),
        }
    }
    bar.finish_and_clear();
    if rows.samples() == 0 {
        return Err(window.nothing_of(recording));
    }
    Ok((rows.finish(), name))
}
