//! `fingertip calibrate --gravity`: weight, centre of mass and zero from poses, as a payload file.

use std::path::{Path, PathBuf};

use fingertip_calibration::gravity::{
    FrameTrial, Frames, PayloadOptions, fit_orientation, fit_payload, poses_from_csv, try_frames,
};
use nalgebra::Vector3;

use super::args::{CalibrateArguments, SensorAxis};
use super::files::{bad, open};
use crate::error::CliError;
use crate::output::Outputs;
use crate::standard::shown;

const DEGREES: f64 = 180.0 / core::f64::consts::PI;

pub(super) fn run(path: &Path, arguments: &CalibrateArguments) -> Result<(), CliError> {
    let output = arguments.output.clone().unwrap_or_else(|| PathBuf::from("payload.toml"));
    let outputs = Outputs::guard(arguments.overwrite, "output", [&path.to_owned()], [&output])?;
    let fault = |error: &dyn core::fmt::Display| bad(path, &error);
    let mut poses = poses_from_csv(open("table of poses", path)?).map_err(|error| fault(&error))?;
    if arguments.reaction {
        poses.iter_mut().for_each(|pose| pose.wrench.neg_mut());
    }
    let recorded = poses.clone();
    if arguments.wrench_in_base {
        poses = poses.iter().map(|pose| pose.with_wrench_in_base(&pose.wrench)).collect();
    }
    let mut options = PayloadOptions::default();
    let mut text = String::new();
    let mut mounting = None;
    if arguments.fit_mounting {
        let fit = fit_orientation(&poses, &-Vector3::z()).map_err(|error| fault(&error))?;
        poses = poses.iter().map(|pose| pose.on_mount(&fit.sensor_from_flange)).collect();
        let turn = nalgebra::Rotation3::from_matrix_unchecked(fit.sensor_from_flange);
        text.push_str(&format!(
            "mounting        turned by {} degrees (rotation vector; ± {}), distortion {:.2} %\n",
            triple(&turn.scaled_axis(), DEGREES),
            spread(&fit.turn_deviation, DEGREES),
            100.0 * fit.distortion
        ));
        mounting = Some(fit.sensor_from_flange);
    }
    if arguments.fit_down {
        options.down = None;
    }
    options.centre_on = arguments.centre_on.map(|axis| match axis {
        SensorAxis::X => Vector3::x(),
        SensorAxis::Y => Vector3::y(),
        SensorAxis::Z => Vector3::z(),
    });
    let fit = fit_payload(&poses, &options).map_err(|error| {
        let tried = if arguments.fit_mounting { Vec::new() } else { try_frames(&recorded, &options) };
        match tried.first() {
            Some(best) => fault(&format!(
                "{error}; with {} only {:.5} N would be left: {}",
                best.frames,
                best.rms,
                mend(best.frames)
            )),
            None => fault(&error),
        }
    })?;
    let mut file = fit.to_file(poses.len()).map_err(|error| fault(&error))?;
    if let Some(turn) = mounting {
        file.sensor_from_flange = core::array::from_fn(|i| core::array::from_fn(|j| turn[(i, j)]));
    }
    file.provenance.serial.clone_from(&arguments.serial);
    file.provenance.date.clone_from(&arguments.date);
    file.provenance.source = shown(path);
    outputs.write("payload", &output, &file.to_toml().map_err(|error| fault(&error))?)?;
    text.insert_str(0, &format!("{} poses, condition number {:.1}\n", poses.len(), fit.condition_number));
    text.push_str(&format!(
        "weight          {:.5} ± {:.5} N (mass {:.5} kg)\n",
        fit.weight.norm(),
        fit.weight_deviation,
        fit.mass
    ));
    if arguments.fit_down {
        text.push_str(&format!(
            "gravity         {} N in the base, {:.3}° off its −z (± {:.3}°)\n",
            triple(&fit.weight, 1.0),
            fit.tilt.to_degrees(),
            fit.direction_deviation.to_degrees()
        ));
    }
    text.push_str(&format!(
        "centre of mass  {} mm (± {})\n",
        triple(&fit.centre_of_mass, 1e3),
        spread(&fit.centre_deviation, 1e3)
    ));
    text.push_str(&format!(
        "force at rest   {} N (± {})\n",
        triple(&fit.force_bias, 1.0),
        spread(&fit.force_bias_deviation, 1.0)
    ));
    text.push_str(&format!(
        "torque at rest  {} N·m (± {})\n",
        triple(&fit.torque_bias, 1.0),
        spread(&fit.torque_bias_deviation, 1.0)
    ));
    let rms: Vec<String> = fit.rms.iter().map(|rms| format!("{rms:.5}")).collect();
    text.push_str(&format!("RMS left        {} (N, N·m)\n", rms.join(" ")));
    let mut notes = fit.warnings.clone();
    if !arguments.fit_mounting {
        let stated = Frames { wrench_in_base: arguments.wrench_in_base, inverse: false };
        notes.extend(better_frames(&try_frames(&recorded, &options), stated, &mut text));
    }
    text.insert_str(0, &format!("Payload: {}\n", fit.verdict().name().to_uppercase()));
    outputs.say(&text, &notes)
}

/// Says what is left of the force if the frames are as stated and in the best other way, and which to state if that is
/// much better.
fn better_frames(trials: &[FrameTrial], stated: Frames, text: &mut String) -> Option<String> {
    let of = |trial: &&FrameTrial| trial.frames == stated;
    let as_stated = trials.iter().find(of)?;
    let other = trials.iter().find(|trial| !of(trial))?;
    text.push_str(&format!(
        "frames          as stated {:.5} N are left; best otherwise: {:.5} N with {}\n",
        as_stated.rms, other.rms, other.frames
    ));
    let is_better = 2.0 * other.rms < as_stated.rms;
    is_better.then(|| format!("the frames seem to be {}: {}", other.frames, mend(other.frames)))
}

/// How to say that the frames are so.
const fn mend(frames: Frames) -> &'static str {
    match (frames.wrench_in_base, frames.inverse) {
        (_, true) => "turn the quaternions round (the signs of qx, qy, qz)",
        (true, false) => "state --wrench-in-base",
        (false, false) => "leave out --wrench-in-base",
    }
}

fn triple(v: &Vector3<f64>, scale: f64) -> String {
    format!("{:+.5} {:+.5} {:+.5}", scale * v.x, scale * v.y, scale * v.z)
}

/// Deviations have no sign.
fn spread(v: &Vector3<f64>, scale: f64) -> String {
    format!("{:.5} {:.5} {:.5}", scale * v.x, scale * v.y, scale * v.z)
}
