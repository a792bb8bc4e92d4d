//! `fingertip calibrate --gravity`: weight, centre of mass and zero from poses.

use std::fs;
use std::path::Path;

use fingertip_calibration::gravity::{PayloadOptions, fit_payload, poses_from_csv};
use nalgebra::Vector3;

use super::args::{CalibrateArguments, SensorAxis};
use super::print;
use crate::error::CliError;

pub(super) fn run(path: &Path, arguments: &CalibrateArguments) -> Result<(), CliError> {
    let file = fs::File::open(path).map_err(|source| CliError::read("table of poses", path, source))?;
    let bad = |message: String| CliError::Calibrate { path: path.to_owned(), message };
    let mut poses = poses_from_csv(file).map_err(|error| bad(error.to_string()))?;
    if arguments.wrench_in_base {
        poses = poses.iter().map(|pose| pose.with_wrench_in_base(&pose.wrench)).collect();
    }
    let mut options = PayloadOptions::default();
    if arguments.fit_down {
        options.down = None;
    }
    options.centre_on = arguments.centre_on.map(|axis| match axis {
        SensorAxis::X => Vector3::x(),
        SensorAxis::Y => Vector3::y(),
        SensorAxis::Z => Vector3::z(),
    });
    let fit = fit_payload(&poses, &options).map_err(|error| bad(error.to_string()))?;
    let triple =
        |v: &Vector3<f64>, scale: f64| format!("{:+.5} {:+.5} {:+.5}", scale * v.x, scale * v.y, scale * v.z);
    let mut text = format!("{} poses, condition number {:.1}\n", poses.len(), fit.condition_number);
    text.push_str(&format!(
        "weight          {:.5} ± {:.5} N (mass {:.5} kg)\n",
        fit.weight.norm(),
        fit.weight_deviation,
        fit.mass
    ));
    if arguments.fit_down {
        text.push_str(&format!(
            "gravity         {} N in the base, {:.3}° off its −z\n",
            triple(&fit.weight, 1.0),
            fit.tilt.to_degrees()
        ));
    }
    text.push_str(&format!(
        "centre of mass  {} mm (± {})\n",
        triple(&fit.centre_of_mass, 1e3),
        triple(&fit.centre_deviation, 1e3)
    ));
    text.push_str(&format!("force at rest   {} N\n", triple(&fit.force_bias, 1.0)));
    text.push_str(&format!("torque at rest  {} N·m\n", triple(&fit.torque_bias, 1.0)));
    let rms: Vec<String> = fit.rms.iter().map(|rms| format!("{rms:.5}")).collect();
    text.push_str(&format!("RMS left        {} (N, N·m)\n", rms.join(" ")));
    for warning in &fit.warnings {
        text.push_str(&format!("note: {warning}\n"));
    }
    print(&text)
}
