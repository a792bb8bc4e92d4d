//! What `calibrate --inertial` is told.

use std::path::PathBuf;

use clap::Args;
use fingertip::wrench::InertialUnit;
use fingertip_calibration::inertial::InertialOptions;
use nalgebra::{Rotation3, Vector3};

use crate::error::CliError;

/// What `calibrate --inertial` takes.
#[derive(Debug, Args)]
pub(crate) struct InertialArguments {
    /// Find mass, centre of mass, inertia and zero from a motion without contact instead, and write a payload: CSV with
    /// t_s, fx_N … tz_Nm, and an accelerometer and a gyroscope, ax_m_per_s2 …, wx_rad_per_s …
    #[arg(long, value_name = "MOTION.csv", conflicts_with_all = ["loads", "gravity", "html", "json", "cal", "rust"])]
    pub(crate) inertial: Option<PathBuf>,
    /// With --inertial: where the accelerometer sits on the sensor [m]
    #[arg(
        long,
        requires = "inertial",
        value_name = "X,Y,Z",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    unit_position: Option<Vec<f64>>,
    /// With --inertial: how its axes are turned against the sensor's, axis times angle [degrees]
    #[arg(
        long,
        requires = "inertial",
        value_name = "X,Y,Z",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    unit_rotation: Option<Vec<f64>>,
    /// With --inertial: seconds at the start in which the sensor rests, which tell noise and what the gyroscope reads at rest
    #[arg(long, requires = "inertial", value_name = "SECONDS")]
    rest: Option<f64>,
    /// With --inertial: time constant of the filter of all readings
    #[arg(long, requires = "inertial", value_name = "SECONDS", default_value_t = 0.01)]
    time_constant: f64,
    /// With --inertial: the inertial readings come later or sooner than the wrench by no more than this; 0 if they do not
    #[arg(long, requires = "inertial", value_name = "SECONDS", default_value_t = 0.1)]
    longest_delay: f64,
    /// With --inertial: how far what hangs on the sensor reaches from it, about
    #[arg(long, requires = "inertial", value_name = "METRES", default_value_t = 0.2)]
    reach: f64,
}

impl InertialArguments {
    pub(super) fn options(&self) -> Result<InertialOptions, CliError> {
        let three = |option, given: &Option<Vec<f64>>| match given.as_deref() {
            None => Ok(Vector3::zeros()),
            Some(&[x, y, z]) if x.is_finite() && y.is_finite() && z.is_finite() => Ok(Vector3::new(x, y, z)),
            Some(list) => {
                let list: Vec<String> = list.iter().map(ToString::to_string).collect();
                Err(CliError::option(option, list.join(","), "must be three numbers, separated by commas"))
            }
        };
        let turn = three("--unit-rotation", &self.unit_rotation)?.map(f64::to_radians);
        let place = three("--unit-position", &self.unit_position)?;
        let unit = InertialUnit::new(Rotation3::from_scaled_axis(turn).into_inner(), place)
            .map_err(|_| CliError::option("--unit-rotation", turn.x, "must be three finite numbers"))?;
        Ok(InertialOptions {
            unit,
            time_constant: self.time_constant,
            longest_delay: self.longest_delay,
            rest: self.rest,
            reach: self.reach,
        })
    }
}
