//! `fingertip demo`: the main job with nothing given. A simulated fingertip's volts go through the
//! whole pipeline, and what comes out is compared with what really was.

pub(crate) mod args;
mod export;
mod figures;
mod findings;
mod hand;
mod rest;

use fingertip::Fingertip;
use fingertip::contact::PointContact;
use fingertip::friction::{Coulomb, DropDetector, ForceNoise, SlipVerdict};
use fingertip::surfaces::{DynSurface, SphericalCap};
use fingertip::wrench::GaussianElimination;
use fingertip_simulation::{Options, SessionReport, SessionScore, SimulatedFingertip, standard_session};
use nalgebra::Vector3;

use crate::error::CliError;
use crate::observe::{Observations, Reservoir, Status};
use crate::output::Outputs;
use crate::report;
use crate::scene::least_static_coefficient;
use args::DemoArguments;
use export::VoltsFile;
use fingertip_scene::{Detector, Friction, Limit, Projection, SlipWatch};
use rest::Rest;

/// Forces below so many standard deviations of the rest are no contact.
const THRESHOLD: f64 = 5.0;
/// Most samples whose error is drawn.
const ERROR_POINTS: usize = 1500;

/// The error of one sample against the truth.
#[derive(Clone, Copy, Debug)]
struct SampleError {
    /// True force \[N\].
    load: f64,
    /// Distance of the contact point from the true one \[m\].
    position: f64,
}

/// What the demo found.
struct Outcome {
    report: SessionReport,
    observations: Observations,
    errors: Reservoir<SampleError>,
    rest: Rest,
    cap: SphericalCap<f64>,
    least_force: f64,
    /// The friction coefficient that the pipeline was given.
    coefficient: f64,
    seed: u64,
}

pub(crate) fn run(arguments: &DemoArguments) -> Result<(), CliError> {
    if arguments.hand {
        return hand::run(arguments);
    }
    let paths = [Some(&arguments.out), arguments.recording.as_ref(), arguments.calibration.as_ref()];
    let outputs = Outputs::guard(arguments.overwrite, "output", [], paths.into_iter().flatten())?;
    let outcome = play(arguments, &outputs)?;
    let findings = findings::of(&outcome);
    let figures = figures::of(&outcome);
    let surface = DynSurface::Sphere(outcome.cap);
    let shown =
        report::Shown { surface: &surface, coefficient: Some(outcome.coefficient), spin_torque: false };
    let page = report::with_figures(&findings, figures, &outcome.observations, shown);
    outputs.write("report", &arguments.out, &page)?;
    outputs.say(&findings.to_string(), &[])
}

/// Whatever cannot be built here is a fault of ours, not of the user's.
fn fault(fault: impl ToString) -> CliError {
    CliError::Demo { message: fault.to_string() }
}

fn play(arguments: &DemoArguments, outputs: &Outputs) -> Result<Outcome, CliError> {
    let seed = arguments.seed;
    let mut simulated = SimulatedFingertip::new(&standard_session(), Options { seed, ..Options::default() })
        .map_err(fault)?;
    if let Some(path) = &arguments.calibration {
        export::calibration(path, &simulated, outputs)?;
    }
    let mut volts = VoltsFile::create(arguments.recording.as_deref(), outputs)?;
    let solver = GaussianElimination::new(simulated.calibrated_matrix()).map_err(fault)?;
    let mut score = SessionScore::new(&simulated);

    let sphere = simulated.sphere();
    let pole = Vector3::x();
    let rim = simulated.options().design.greatest_angle();
    let frame = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut observations = Observations::new(Projection::sphere(sphere.centre(), pole, Some(rim), &frame));

    // The first phase is rest: its readings give the zero, and their spread the noise.
    let mut readings = Vec::new();
    let first_touch = loop {
        match simulated.next() {
            Some(sample) if sample.truth.phase == 0 => {
                observations.add_without_wrench(sample.time, Status::Rest);
                volts.write(&sample)?;
                readings.push(sample.reading());
            }
            other => break other,
        }
    };
    let rest = Rest::of(&readings, &solver).map_err(fault)?;
    let least_force = THRESHOLD * rest.force_noise;
    let coefficient = least_static_coefficient(&simulated).ok_or_else(|| fault("the script has no drag"))?;

    let noise = ForceNoise::isotropic(rest.force_noise).map_err(fault)?;
    let cap = SphericalCap::new(sphere, pole, rim.cos()).map_err(fault)?;
    let mut fingertip = Fingertip::builder()
        .zero(rest.zero)
        .solver(solver)
        .contact(cap, PointContact::new(least_force).map_err(fault)?)
        .friction_stage(Friction(Some(Limit::Coulomb(Coulomb::new(coefficient).map_err(fault)?))))
        .slip_stage(SlipWatch(Some(Detector::Drop(DropDetector::new(noise).map_err(fault)?))))
        .build();

    let mut errors = Reservoir::new(ERROR_POINTS);
    let time_step = simulated.options().sample_rate.recip();
    for sample in first_touch.into_iter().chain(&mut simulated) {
        volts.write(&sample)?;
        let touch = fingertip.sense(&sample.reading(), time_step);
        observations.add(sample.time, &touch);
        let point = touch.resolution.contact().map(|contact| contact.point);
        let slipping = touch.slip == Some(SlipVerdict::Slipping);
        score.add(&sample, &touch.wrench, point.as_ref(), slipping);
        if let (Some(point), Some(truth)) = (point, sample.truth.contact) {
            errors.add(|| SampleError { load: truth.force.norm(), position: (point - truth.point).norm() });
        }
    }
    volts.finish()?;
    Ok(Outcome { report: score.report(), observations, errors, rest, cap, least_force, coefficient, seed })
}
