//! The command line of `calibrate`, `check` and `tare`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use fingertip_calibration::model::Curvature;

use super::inertial_args::InertialArguments;
use super::touches::TouchArguments;
use crate::output::Overwrite;

/// The methods that need to know how uncertain loads and readings are.
const UNCERTAIN: [(&str, &str); 2] = [("method", "total"), ("method", "gauss-helmert")];

#[derive(Debug, Args)]
pub(crate) struct CalibrateArguments {
    /// Known loads and readings: CSV with units in the column names (fx_N, tz_Nm, v1_V; also case, group)
    #[arg(value_name = "LOADS.csv", required_unless_present_any = ["gravity", "inertial"])]
    pub(crate) loads: Vec<PathBuf>,
    /// Find weight, centre of mass and zero from poses instead, and write a payload: CSV with qx, qy, qz,
    /// qw (the sensor in the base frame), fx_N … tz_Nm
    #[arg(long, value_name = "POSES.csv", conflicts_with_all = ["loads", "html", "json", "cal", "rust"])]
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
    /// With --gravity: the quaternions are those of the flange; find how the sensor sits on it too
    #[arg(long, requires = "gravity", conflicts_with_all = ["wrench_in_base", "fit_down"])]
    pub(crate) fit_mounting: bool,
    /// With --gravity or --inertial: the readings are what the fingertip does to the world, not the load on it
    #[arg(long, conflicts_with = "loads")]
    pub(crate) reaction: bool,
    #[command(flatten)]
    pub(crate) inertial: InertialArguments,
    /// Where to write the calibration (calibration.toml), or with --gravity or --inertial the payload (payload.toml)
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
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
    /// Standard deviation of the known loads (total, gauss-helmert): of forces and of torques, or one for
    /// each axis [N, N·m], separated by commas
    #[arg(long, value_delimiter = ',', value_name = "LOADS", required_if_eq_any = UNCERTAIN)]
    pub(crate) load_error: Option<Vec<f64>>,
    /// Standard deviation of a load relative to itself, on top of --load-error (gauss-helmert)
    #[arg(long, value_name = "SHARE", default_value_t = 0.0)]
    pub(crate) load_error_share: f64,
    /// Standard deviation of the readings (total, gauss-helmert): one for all gauges, or one for each
    #[arg(long, value_delimiter = ',', value_name = "READINGS", required_if_eq_any = UNCERTAIN)]
    pub(crate) reading_error: Option<Vec<f64>>,
    /// Earlier calibration that the fit is drawn towards where the loads tell little (implies --method prior)
    #[arg(long, value_name = "CAL.toml", required_if_eq("method", "prior"))]
    pub(crate) prior: Option<PathBuf>,
    /// How well the earlier calibration is believed: deviation of its entries relative to their RMS
    #[arg(long, value_name = "SHARE", default_value_t = 0.1, requires = "prior")]
    pub(crate) prior_error: f64,
    /// Share of samples that may be bad (ransac)
    #[arg(long, value_name = "SHARE", default_value_t = 0.2)]
    pub(crate) bad_share: f64,
    /// What hangs on the sensor: its weight is added to the loads (columns qx, qy, qz, qw)
    #[arg(long, value_name = "PAYLOAD.toml", conflicts_with_all = ["gravity", "inertial", "tare_groups"])]
    pub(crate) payload: Option<PathBuf>,
    /// Read the files row by row, in bounded memory, however long: least squares only, no leaving out
    #[arg(long, conflicts_with_all = ["gravity", "inertial", "curvature", "creep", "tare_groups",
        "reference_celsius", "reject_outliers", "payload", "prior", "inverse", "json", "html"])]
    pub(crate) stream: bool,
    #[command(flatten)]
    pub(crate) touches: TouchArguments,
    /// Fit loads from signals, as many makers do, instead of signals from loads
    #[arg(long)]
    pub(crate) inverse: bool,
    /// Fit no zero: the readings are tared
    #[arg(long)]
    pub(crate) no_bias: bool,
    /// Fit a curved sensor: terms of higher order in the signals (implies --inverse); refused where that over-fits
    #[arg(long, value_enum, default_value_t = CurvatureChoice::Straight)]
    pub(crate) curvature: CurvatureChoice,
    /// Subtract the zero of each group (its samples without load) first
    #[arg(long)]
    pub(crate) tare_groups: bool,
    /// Fit the drift with temperature (column temperature_C), and give the sensor at this one
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true)]
    pub(crate) reference_celsius: Option<f64>,
    /// Find how readings go on changing under a load that stays, from load cycles (columns t_s, group), and take it off;
    /// what gives readings one by one then takes it off, too
    #[arg(long)]
    pub(crate) creep: bool,
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
    /// Exit with 0 although the calibration is judged bad
    #[arg(long)]
    pub(crate) accept_bad: bool,
    /// Serial number of the sensor
    #[arg(long, default_value = "")]
    pub(crate) serial: String,
    /// Date of the calibration, such as 2026-11-21
    #[arg(long, default_value = "")]
    pub(crate) date: String,
    #[command(flatten)]
    pub(crate) overwrite: Overwrite,
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
    /// What hangs on the sensor: its weight is added to the loads (columns qx, qy, qz, qw)
    #[arg(long, value_name = "PAYLOAD.toml")]
    pub(crate) payload: Option<PathBuf>,
    /// Temperature at which all of it was recorded, if there is no column temperature_C
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true)]
    pub(crate) celsius: Option<f64>,
    #[command(flatten)]
    pub(crate) touches: TouchArguments,
    /// Greatest RMS error that is good, % of full scale
    #[arg(long, value_name = "PERCENT")]
    pub(crate) limit: Option<f64>,
    /// Also write the report with plots
    #[arg(long, value_name = "FILE")]
    pub(crate) html: Option<PathBuf>,
    /// Also write the report as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overwrite: Overwrite,
}

#[derive(Debug, Args)]
pub(crate) struct TareArguments {
    /// The calibration, TOML or ATI .cal
    #[arg(value_name = "CAL.toml")]
    pub(crate) calibration: PathBuf,
    /// A recording of the sensor at rest without load: CSV with v1_V …
    #[arg(value_name = "REST.csv")]
    pub(crate) rest: PathBuf,
    /// Temperature at which all of it was recorded, if there is no column temperature_C
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true)]
    pub(crate) celsius: Option<f64>,
    /// Take the zero although the sensor moved
    #[arg(long)]
    pub(crate) accept_motion: bool,
    /// Where to write the calibration with its new zero
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) overwrite: Overwrite,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CurvatureChoice {
    /// None: signals proportional to loads
    Straight,
    /// All products of two signals
    Quadratic,
    /// As many products of two and three signals, and bumps, as predict load cases best that were left out
    Chosen,
}

impl From<CurvatureChoice> for Curvature {
    fn from(choice: CurvatureChoice) -> Self {
        match choice {
            CurvatureChoice::Straight => Self::Straight,
            CurvatureChoice::Quadratic => Self::Quadratic,
            CurvatureChoice::Chosen => Self::Chosen,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum FitMethod {
    /// Least squares, weighted by the column `weight` if there is one
    LeastSquares,
    /// Huber's, which outliers cannot spoil
    Huber,
    /// Of the largest set of samples that agree
    Ransac,
    /// Total least squares: the loads are uncertain too
    Total,
    /// As total, with errors that grow with the load
    GaussHelmert,
    /// Towards an earlier calibration (ridge, Bayes)
    Prior,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum SensorAxis {
    X,
    Y,
    Z,
}
