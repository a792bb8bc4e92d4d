//! `fingertip calibrate --inertial`: mass, centre, inertia, zero and delay from a motion, as a payload file.

use std::path::{Path, PathBuf};

use fingertip_calibration::inertial::{InertialFit, fit_inertial, moving_samples};
use fingertip_recordings::ReaderOptions;
use nalgebra::{Matrix3, Vector6};

use super::args::CalibrateArguments;
use super::files::bad;
use crate::error::CliError;
use crate::opened::Opened;
use crate::output::Outputs;
use crate::standard::shown;

pub(super) fn run(path: &Path, arguments: &CalibrateArguments) -> Result<(), CliError> {
    let output = arguments.output.clone().unwrap_or_else(|| PathBuf::from("payload.toml"));
    let outputs = Outputs::guard(arguments.overwrite, "output", [&path.to_owned()], [&output])?;
    let options = arguments.inertial.options()?;
    let fault = |error: &dyn core::fmt::Display| bad(path, &error);
    let mut notes = Vec::new();
    let Opened { rows: mut reader, .. } = Opened::open(path, &[], ReaderOptions::default(), &mut notes)?;
    let (mut samples, left_out) = moving_samples(&mut reader, None, None)?;
    if left_out > 0 {
        notes.push(format!("{left_out} rows without a time, a wrench or a motion are left out"));
    }
    if arguments.reaction {
        samples.iter_mut().for_each(|sample| sample.wrench.neg_mut());
    }
    let fit = fit_inertial(&samples, &options).map_err(|error| fault(&error))?;
    let mut file = fit.to_file().map_err(|error| fault(&error))?;
    file.provenance.serial.clone_from(&arguments.serial);
    file.provenance.date.clone_from(&arguments.date);
    file.provenance.source = shown(path);
    outputs.write("payload", &output, &file.to_toml().map_err(|error| fault(&error))?)?;
    notes.extend(fit.warnings.clone());
    outputs.say(&told(&fit), &notes)
}

fn told(fit: &InertialFit) -> String {
    let list = |v: &[f64], scale: f64, places: usize| {
        v.iter().map(|x| format!("{:+.places$}", scale * x)).collect::<Vec<_>>().join(" ")
    };
    let spread = |v: &[f64], scale: f64, places: usize| {
        v.iter().map(|x| format!("{:.places$}", scale * x)).collect::<Vec<_>>().join(" ")
    };
    let upper = |m: &Matrix3<f64>| [m[(0, 0)], m[(1, 1)], m[(2, 2)], m[(0, 1)], m[(0, 2)], m[(1, 2)]];
    let six = |v: &Vector6<f64>| spread(v.as_slice(), 1.0, 5);
    let body = &fit.body;
    let (force, torque) = fit.bias_deviation.as_slice().split_at(3);
    let mut text = format!(
        "Payload: {}\n{} rows of motion, {:.1} ms apart\n",
        fit.verdict().name().to_uppercase(),
        fit.rows,
        fit.time_constant * 1e3
    );
    text += &format!("mass            {:.5} ± {:.5} kg\n", body.mass, fit.mass_deviation);
    text += &format!(
        "centre of mass  {} mm (± {})\n",
        list(body.centre.as_slice(), 1e3, 3),
        spread(fit.centre_deviation.as_slice(), 1e3, 3)
    );
    text += &format!(
        "inertia         {} kg·mm² (± {}; xx yy zz xy xz yz, about the centre of mass)\n",
        list(&upper(&body.inertia), 1e6, 2),
        spread(&upper(&fit.inertia_deviation), 1e6, 2)
    );
    text += &format!(
        "force at rest   {} N (± {})\n",
        list(fit.force_bias.as_slice(), 1.0, 5),
        spread(force, 1.0, 5)
    );
    text += &format!(
        "torque at rest  {} N·m (± {})\n",
        list(fit.torque_bias.as_slice(), 1.0, 5),
        spread(torque, 1.0, 5)
    );
    if let Some(delay) = fit.delay {
        text += &format!(
            "delay           inertial readings come {:+.2} ms later (± {:.2})\n",
            delay.seconds * 1e3,
            delay.deviation * 1e3
        );
    }
    text += &format!("RMS of the load {} (N, N·m)\n", six(&fit.load));
    text += &format!("RMS left        {}\n", six(&fit.left));
    if let Some((noise, over)) = fit.noise.as_ref().zip(fit.over_noise()) {
        text += &format!("noise at rest   {}; left is {over:.2} times as much at worst\n", six(noise));
    }
    text += &format!(
        "[inertial_unit] of a scene takes it off in motion; what changes slowly then comes {:.1} ms late\n",
        fit.filter_delay() * 1e3
    );
    text
}
