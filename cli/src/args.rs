//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

use crate::calibrate::args::{CalibrateArguments, CheckArguments, TareArguments};
use crate::convert::ConvertArguments;
use crate::design::args::DesignArguments;
use crate::geometry::GeometryArguments;
use crate::live::args::LiveArguments;
use crate::motion::MotionArguments;
use crate::plan::PlanArguments;
use crate::record::args::RecordArguments;
use crate::refine::RefineArguments;
use crate::serve::args::SimulateArguments;

/// From the strain gauges behind a fingertip to contact, force and slip.
#[derive(Debug, Parser)]
#[command(name = "fingertip", version, about, propagate_version = true)]
#[command(
    after_help = "Exit codes: 0 done, 1 an input is bad or an output cannot be written, 2 wrong usage."
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Simulate a fingertip and compare what the pipeline makes of its volts with the truth
    Demo(DemoArguments),
    /// Turn a recording of wrenches or volts into contacts, slip and a report
    Analyze(AnalyzeArguments),
    /// Record a real or simulated sensor into a CSV or MCAP file
    Record(RecordArguments),
    /// Watch a sensor, a simulation or a recording in the terminal: forces, contact, slip
    Live(LiveArguments),
    /// Convert a recording from CSV to MCAP or back
    Convert(ConvertArguments),
    /// Serve a simulated fingertip over the protocol of a real sensor
    Simulate(SimulateArguments),
    /// Design a sensor: from wanted ranges and size to a layout of gauges and the accuracy to expect
    Design(DesignArguments),
    /// Fit a sensor to known loads, or a payload to poses, and say how good that is
    Calibrate(Box<CalibrateArguments>),
    /// Test a calibration on loads that it has not seen
    Check(CheckArguments),
    /// Give a calibration a new zero from a recording at rest
    Tare(TareArguments),
    /// Say which loads to apply, and how many are enough
    Plan(PlanArguments),
    /// Find the shape or the pose of the fingertip's surface from touches
    Geometry(GeometryArguments),
    /// Calibrate by a weight of known size in unknown directions
    Motion(MotionArguments),
    /// Say what ordinary point contacts tell of a calibration, and mend it by them
    Refine(RefineArguments),
}

#[derive(Debug, Args)]
pub(crate) struct DemoArguments {
    /// Where to write the report
    #[arg(long, value_name = "FILE", default_value = "report.html")]
    pub(crate) out: PathBuf,
    /// Seed of the noise: the same seed gives the same report
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Also write the simulated volts, a recording to try `analyze` on
    #[arg(long, value_name = "FILE")]
    pub(crate) recording: Option<PathBuf>,
    /// Also write the simulated sensor's calibration
    #[arg(long, value_name = "FILE")]
    pub(crate) calibration: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct AnalyzeArguments {
    /// The recording: CSV with units in the column names (fx_N, tz_Nmm, v1_V, t_s), or MCAP (.mcap)
    #[arg(value_name = "FILE")]
    pub(crate) recording: PathBuf,
    /// The scene: surface, pose, thresholds, friction (examples/scenes/README.md)
    #[arg(long, value_name = "SCENE.toml")]
    pub(crate) scene: PathBuf,
    /// The calibration, for a recording of volts
    #[arg(long, value_name = "CAL.toml")]
    pub(crate) calibration: Option<PathBuf>,
    /// What hangs on the sensor, as `calibrate --gravity` wrote it: its weight is taken off, by the columns
    /// qx, qy, qz, qw of the recording
    #[arg(long, value_name = "PAYLOAD.toml")]
    pub(crate) payload: Option<PathBuf>,
    /// Temperature of the whole recording, for a calibration that drifts with it and a recording without
    /// column temperature_C
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true)]
    pub(crate) celsius: Option<f64>,
    /// Which sensor of the recording: the prefix of its columns (S1 for S1_Fx_N); overrides the scene
    #[arg(long, value_name = "PREFIX")]
    pub(crate) sensor: Option<String>,
    /// Where to write one row per sample; `-` is the standard output, and the summary then goes to
    /// the standard error
    #[arg(long, value_name = "FILE", default_value = "contacts.csv")]
    pub(crate) output: PathBuf,
    /// Where to write the report
    #[arg(long, value_name = "FILE", default_value = "report.html", conflicts_with = "no_report")]
    pub(crate) report: PathBuf,
    /// Write no report
    #[arg(long)]
    pub(crate) no_report: bool,
}
