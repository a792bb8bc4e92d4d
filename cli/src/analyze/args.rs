//! The command line of `analyze`.

use std::path::PathBuf;

use clap::Args;

use crate::output::Overwrite;
use crate::span::Span;

#[derive(Clone, Debug, Args)]
pub(crate) struct AnalyzeArguments {
    /// The recording: CSV with units in the column names (fx_N, tz_Nmm, v1_V, t_s), or MCAP (.mcap); `-` is the standard
    /// input. Of several, each writes files of its own: RUN.csv writes RUN.contacts.csv and RUN.report.html
    #[arg(value_name = "FILE", required = true)]
    pub(crate) recordings: Vec<PathBuf>,
    /// The scene: surface, pose, thresholds, friction (book/src/reference/scene.md); or a hand scene, which names those
    /// of several fingers (examples/hands/two_pads.toml)
    #[arg(long, value_name = "SCENE.toml")]
    pub(crate) scene: PathBuf,
    /// The calibration, for a recording of volts: TOML as `calibrate` writes it, or an ATI .cal; in the place of
    /// [sensor] of the scene
    #[arg(long, value_name = "CAL")]
    pub(crate) calibration: Option<PathBuf>,
    /// What hangs on the sensor, as `calibrate --gravity` wrote it: its weight is taken off, by the columns
    /// qx, qy, qz, qw of the recording; in the place of [payload] of the scene
    #[arg(long, value_name = "PAYLOAD.toml")]
    pub(crate) payload: Option<PathBuf>,
    /// Temperature of the whole recording, for a calibration that drifts with it and a recording without
    /// column temperature_C
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true)]
    pub(crate) celsius: Option<f64>,
    /// Which sensor of the recording: the prefix of its columns (S1 for S1_Fx_N); overrides the scene
    #[arg(long, value_name = "PREFIX")]
    pub(crate) sensor: Option<String>,
    /// Of an MCAP file, this topic alone; several times for several
    #[arg(long = "topic", value_name = "TOPIC")]
    pub(crate) topics: Vec<String>,
    #[command(flatten)]
    pub(crate) span: Span,
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
    /// Print the summary as JSON, in a line: counts, quantiles, slips, faults, notes, in SI units
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) overwrite: Overwrite,
}
