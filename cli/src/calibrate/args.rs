//! The command line of `calibrate`, `check` and `tare`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

#[derive(Debug, Args)]
pub(crate) struct CalibrateArguments {
    /// Known loads and readings: CSV with units in the column names (fx_N, tz_Nm, v1_V; also case, group)
    #[arg(value_name = "LOADS.csv", required_unless_present = "gravity")]
    pub(crate) loads: Vec<PathBuf>,
    /// Find weight, centre of mass and zero from poses instead: CSV with qx, qy, qz, qw, fx_N … tz_Nm
    #[arg(long, value_name = "POSES.csv", conflicts_with_all = ["loads", "output", "html", "json", "cal", "rust"])]
    pub(crate) gravity: Option<PathBuf>,
    /// With --gravity: the readings are in the axes of the base, not of the sensor
    #[arg(long, requires = "gravity")]
    pub(crate) wrench_in_base: bool,
    /// With --gravity: the base may stand crooked, so fit the direction of gravity too
    #[arg(long, requires = "gravity")]
    pub(crate) fit_down: bool,
    /// With --gravity: the centre of mass is known to lie on this axis of the sensor
    #[arg(long, requires = "gravity", value_name = "AXIS")]
    pub(crate) centre_on: Option<SensorAxis>,
    /// Where to write the calibration
    #[arg(short, long, value_name = "FILE", default_value = "calibration.toml")]
    pub(crate) output: PathBuf,
    /// Also write the report with plots
    #[arg(long, value_name = "FILE")]
    pub(crate) html: Option<PathBuf>,
    /// Also write the report as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Also write an ATI .cal file
    #[arg(long, value_name = "FILE")]
    pub(crate) cal: Option<PathBuf>,
    /// Also write Rust constants (f32) for firmware
    #[arg(long, value_name = "FILE")]
    pub(crate) rust: Option<PathBuf>,
    /// How to fit
    #[arg(long, value_enum, default_value_t = FitMethod::LeastSquares)]
    pub(crate) method: FitMethod,
    /// Fit loads from signals, as many makers do, instead of signals from loads
    #[arg(long)]
    pub(crate) inverse: bool,
    /// Fit no zero: the readings are tared
    #[arg(long)]
    pub(crate) no_bias: bool,
    /// Fit products of signals too (with --inverse); refused where that over-fits
    #[arg(long, requires = "inverse")]
    pub(crate) quadratic: bool,
    /// Subtract the zero of each group (its samples without load) first
    #[arg(long)]
    pub(crate) tare_groups: bool,
    /// Leave out samples that do not fit the others
    #[arg(long)]
    pub(crate) reject_outliers: bool,
    /// Leave out samples with a reading at or beyond these
    #[arg(long, num_args = 2, value_names = ["LOW", "HIGH"], allow_negative_numbers = true)]
    pub(crate) range: Option<Vec<f64>>,
    /// Full scale of each axis in N and N·m, separated by commas; the greatest loads without it
    #[arg(long, value_delimiter = ',', value_name = "LOADS")]
    pub(crate) full_scale: Option<Vec<f64>>,
    /// Greatest error that is good, % of full scale, on loads left out of the fit
    #[arg(long, value_name = "PERCENT")]
    pub(crate) limit: Option<f64>,
    /// Serial number of the sensor
    #[arg(long, default_value = "")]
    pub(crate) serial: String,
    /// Date of the calibration, such as 2026-11-21
    #[arg(long, default_value = "")]
    pub(crate) date: String,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    /// The calibration, TOML or ATI .cal
    #[arg(value_name = "CAL.toml")]
    pub(crate) calibration: PathBuf,
    /// Known loads and readings that it was not fitted to
    #[arg(value_name = "LOADS.csv")]
    pub(crate) loads: PathBuf,
    /// Subtract the zero of each group first, and use no zero of the calibration
    #[arg(long)]
    pub(crate) tare_groups: bool,
    /// Greatest RMS error that is good, % of full scale
    #[arg(long, value_name = "PERCENT")]
    pub(crate) limit: Option<f64>,
    /// Also write the report with plots
    #[arg(long, value_name = "FILE")]
    pub(crate) html: Option<PathBuf>,
    /// Also write the report as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct TareArguments {
    /// The calibration, TOML or ATI .cal
    #[arg(value_name = "CAL.toml")]
    pub(crate) calibration: PathBuf,
    /// A recording of the sensor at rest without load: CSV with v1_V …
    #[arg(value_name = "REST.csv")]
    pub(crate) rest: PathBuf,
    /// Where to write the calibration with its new zero
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum FitMethod {
    /// Least squares, weighted by the column `weight` if there is one
    LeastSquares,
    /// Huber's, which outliers cannot spoil
    Huber,
    /// Of the largest set of samples that agree; up to a fifth may be bad
    Ransac,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum SensorAxis {
    X,
    Y,
    Z,
}
