//! The command line.

use clap::{Parser, Subcommand};

use crate::analyze::args::AnalyzeArguments;
use crate::analyze::object::ObjectArguments;
use crate::bench::args::BenchArguments;
use crate::calibrate::args::{CalibrateArguments, CheckArguments, TareArguments};
use crate::calibrate::import::ImportArguments;
use crate::convert::ConvertArguments;
use crate::demo::args::DemoArguments;
use crate::design::args::DesignArguments;
use crate::export::ExportArguments;
use crate::geometry::GeometryArguments;
use crate::health::HealthArguments;
use crate::info::InfoArguments;
use crate::live::args::LiveArguments;
use crate::motion::MotionArguments;
use crate::plan::PlanArguments;
use crate::record::args::RecordArguments;
use crate::recover::RecoverArguments;
use crate::refine::RefineArguments;
use crate::scene::command::SceneArguments;
use crate::serve::args::SimulateArguments;
use crate::shell::{CompletionsArguments, ManArguments};
use crate::verbosity::Verbosity;

/// From the strain gauges behind a fingertip to contact, force and slip.
#[derive(Debug, Parser)]
#[command(name = "fingertip", version, about, propagate_version = true)]
#[command(
    after_help = "Exit codes: 0 done, 1 an input is bad or an output cannot be written, 2 wrong usage, 130 interrupted."
)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) verbosity: Verbosity,
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
    /// Begin a scene, say what one means, or list what there is to choose
    Scene(SceneArguments),
    /// Export a scene as a Rust module that runs without files, or as JSON
    Export(ExportArguments),
    /// Convert a recording from CSV to MCAP or back
    Convert(ConvertArguments),
    /// Say what recordings hold: rows, rate, gaps, topics, and columns with units as they are understood
    Info(InfoArguments),
    /// Say what a recording tells of the sensor itself: noise, drift, mains, channels at fault
    Health(HealthArguments),
    /// Write a recording that was cut or damaged anew, as far as it is whole
    Recover(RecoverArguments),
    /// Serve a simulated fingertip over the protocol of a real sensor
    Simulate(SimulateArguments),
    /// Design a sensor: from wanted ranges and size to a layout of gauges and the accuracy to expect
    Design(DesignArguments),
    /// Write what one needs to glue and wire a layout: template at 1:1, drawing, wiring, settings of converters
    Bench(BenchArguments),
    /// Fit a sensor to known loads, or a payload to poses, and say how good that is
    Calibrate(Box<CalibrateArguments>),
    /// Test a calibration on loads that it has not seen
    Check(CheckArguments),
    /// Make a calibration of a plain matrix (CSV, NumPy), of an ATI .cal, or of TOML written by hand
    Import(ImportArguments),
    /// Give a calibration a new zero from a recording at rest
    Tare(TareArguments),
    /// Say which loads to apply, and how many are enough
    Plan(PlanArguments),
    /// Find the shape or the pose of the fingertip's surface from touches
    Geometry(GeometryArguments),
    /// Map an object by touching it: points and normals of its surface, and the plane, sphere or cylinder that they lie on
    Object(ObjectArguments),
    /// Calibrate by a weight of known size in unknown directions
    Motion(MotionArguments),
    /// Say what ordinary point contacts tell of a calibration, and mend it by them
    Refine(RefineArguments),
    /// Print what a shell completes the command line by
    Completions(CompletionsArguments),
    /// Write the pages of the manual, one for each command
    Man(ManArguments),
}
