//! `fingertip demo`: the main job with nothing given. A simulated fingertip's volts go through the
//! whole pipeline, and what comes out is compared with what really was.

mod figures;
mod findings;
mod rest;

use std::io::{self, Write};

use fingertip::Fingertip;
use fingertip::friction::{Coulomb, DropDetector, ForceNoise, SlipVerdict};
use fingertip::surfaces::PointContact;
use fingertip::wrench::GaussianElimination;
use fingertip_drivers::simulation::{
    Options, Segment, SessionReport, SessionScore, SimulatedFingertip, standard_session,
};
use nalgebra::Vector3;

use crate::args::DemoArguments;
use crate::error::CliError;
use crate::observe::{Observations, Reservoir, Status};
use crate::report;
use crate::scene::{Friction, SlipWatch};
use crate::shape::{Capped, Projection};
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
    least_force: f64,
    /// The friction coefficient that the pipeline was given.
    coefficient: f64,
    seed: u64,
}

pub(crate) fn run(arguments: &DemoArguments) -> Result<(), CliError> {
    let outcome = play(arguments.seed).map_err(|message| CliError::Demo { message })?;
    let findings = findings::of(&outcome);
    let figures = figures::of(&outcome);
    let page = report::with_figures(&findings, figures, &outcome.observations, Some(outcome.coefficient));
    report::write(&arguments.out, &page)?;
    let text = format!("{findings}\nWritten: {}\n", arguments.out.display());
    let mut stdout = io::stdout();
    stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(CliError::stdout)
}

fn play(seed: u64) -> Result<Outcome, String> {
    let script = standard_session();
    let mut simulated = SimulatedFingertip::new(&script, Options { seed, ..Options::default() })
        .map_err(|fault| fault.to_string())?;
    let solver = GaussianElimination::new(simulated.calibrated_matrix()).map_err(|fault| fault.to_string())?;
    let mut score = SessionScore::new(&simulated);
    let phases: Vec<Segment> = simulated.phases().iter().map(|phase| phase.segment).collect();

    // The first phase is rest: its readings give the zero, and their spread the noise.
    let pole = Vector3::x();
    let rim = simulated.options().design.greatest_angle();
    let sphere = simulated.sphere();
    let mut observations = Observations::new(Projection::sphere(
        sphere.centre(),
        pole,
        Some(rim),
        &[Vector3::y(), Vector3::z(), Vector3::x()],
    ));
    let mut readings = Vec::new();
    let first_touch = loop {
        match simulated.next_sample() {
            Some(sample) if sample.truth.phase == 0 => {
                observations.add_without_wrench(sample.time, Status::Rest);
                readings.push(sample.reading());
            }
            other => break other,
        }
    };
    let rest = Rest::of(&readings, &solver)?;
    let least_force = THRESHOLD * rest.force_noise;
    let coefficient = least_static_coefficient(&phases).ok_or("the script has no drag")?;

    let noise = ForceNoise::isotropic(rest.force_noise).map_err(|fault| fault.to_string())?;
    let mut fingertip = Fingertip::builder()
        .zero(rest.zero)
        .solver(solver)
        .contact(
            Capped::within(sphere, pole, rim),
            PointContact::new(least_force).map_err(|fault| fault.to_string())?,
        )
        .friction_stage(Friction::known(Coulomb::new(coefficient).map_err(|fault| fault.to_string())?))
        .slip_stage(SlipWatch::Drop(DropDetector::new(noise).map_err(|fault| fault.to_string())?))
        .build();

    let mut errors = Reservoir::new(ERROR_POINTS);
    let time_step = simulated.options().sample_rate.recip();
    for sample in first_touch.into_iter().chain(&mut simulated) {
        let touch = fingertip.sense(&sample.reading(), time_step);
        observations.add(sample.time, &touch);
        let point = touch.resolution.contact().map(|contact| contact.point);
        let slipping = touch.slip == Some(SlipVerdict::Slipping);
        score.add(&sample, &touch.wrench, point.as_ref(), slipping);
        if let (Some(point), Some(truth)) = (point, sample.truth.contact) {
            errors.add(|| SampleError { load: truth.force.norm(), position: (point - truth.point).norm() });
        }
    }
    Ok(Outcome { report: score.report(), observations, errors, rest, least_force, coefficient, seed })
}

/// The friction coefficient that is safe for every drag of the script.
fn least_static_coefficient(phases: &[Segment]) -> Option<f64> {
    phases
        .iter()
        .filter_map(|segment| match segment {
            Segment::Drag { static_coefficient, .. } => Some(*static_coefficient),
            _ => None,
        })
        .min_by(f64::total_cmp)
}
