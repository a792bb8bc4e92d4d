//! `fingertip design`: from wanted ranges to a layout of gauges and the accuracy to expect.

pub(crate) mod args;
mod figures;
mod findings;
mod task;

use fingertip::surfaces::Sphere;
use fingertip_calibration::design::{
    Accuracy, Assessment, DesignError, DesignTouch, Findings as Found, LayoutFile, LoadedTube, MatrixUsed,
    Placement, Progress, Search, ToleranceReport, Touches, Trial, TubeLayout, TubeStrength, search,
    tolerance,
};
use indicatif::{ProgressBar, ProgressStyle};

use crate::bench::Bench;
use crate::error::CliError;
use crate::output::Outputs;
use crate::report;
use crate::verbosity::is_quiet;
use args::DesignArguments;
use task::Task;

/// Sensors that are made to see what placement errors do.
const SENSORS: usize = 200;
/// Sensors of a trial, each touched all over.
const TRIAL_SENSORS: usize = 10;
/// Loads of the simulated calibration, and how well they are known.
const CALIBRATION_LOADS: usize = 100;
const LOAD_ERROR: f64 = 2e-3;

/// Everything that the report tells.
struct Outcome {
    task: Task,
    found: Found,
    file: LayoutFile,
    layout: TubeLayout,
    strength: TubeStrength,
    /// This design, and others on the same terms.
    compared: Vec<(String, Assessment)>,
    tolerance: ToleranceReport,
    /// What was tried, at which force \[N\], and what came out.
    trials: Vec<(&'static str, f64, Accuracy)>,
}

fn fault(error: impl ToString) -> CliError {
    CliError::Design { message: error.to_string() }
}

pub(crate) fn run(arguments: &DesignArguments) -> Result<(), CliError> {
    let paths = [&arguments.out, &arguments.report].into_iter().chain(arguments.calibration.as_ref());
    let paths = paths.chain(arguments.files.paths());
    let outputs = Outputs::guard(arguments.overwrite, "output", [], paths)?;
    // Before the search, which takes its time.
    arguments.parts.foil().validate().map_err(fault)?;
    let outcome = design(arguments).map_err(fault)?;
    let bench = Bench::new(&outcome.file, Some(outcome.task.tip_radius), &arguments.parts).map_err(fault)?;
    let findings = findings::of(&outcome, &bench);
    let mut figures = figures::of(&outcome).map_err(fault)?;
    figures.extend(bench.figures());
    outputs.write("layout", &arguments.out, &outcome.file.to_toml().map_err(fault)?)?;
    if let Some(path) = &arguments.calibration {
        let file = outcome.file.predicted_calibration().map_err(fault)?;
        outputs.write("calibration", path, &file.to_toml().map_err(fault)?)?;
    }
    bench.write(&outputs, &arguments.files)?;
    outputs.write("report", &arguments.report, &report::of_design(&findings, figures))?;
    outputs.say(&findings.to_string(), &[])
}

fn design(arguments: &DesignArguments) -> Result<Outcome, DesignError> {
    let mut task = Task::new(arguments)?;
    let bar = bar(arguments.starts);
    let how = Search { starts: arguments.starts, seed: arguments.seed, ..Search::default() };
    let progress = |progress: Progress| {
        if let Some(bar) = &bar {
            bar.set_position(progress.done as u64);
            bar.set_message(format!("{:.4}", progress.best));
        }
    };
    let mut found = search(&task.space, &task.criterion, &task.tube.loads, &how, &progress)?;
    if let Some(space) = task.turned.take() {
        let turned = search(&space, &task.criterion, &task.tube.loads, &how, &progress)?;
        let least = |found: &Found| found.best().map_or(f64::INFINITY, |best| best.criterion);
        // Where both are as good, rounding does not decide.
        if least(&turned) < least(&found) * (1.0 - 1e-6) {
            (task.space, found) = (space, turned);
        }
    }
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
    let best = found.best().ok_or(DesignError::Singular { reason: "no start gave a sensor" })?;
    let layout = task.space.layout(&best.values)?;
    let tube = LoadedTube { radius: layout.beam.radius, ..task.tube };
    let file = LayoutFile::new(&layout, &tube, task.excitation)?;
    let strength = tube.strength(layout.beam.thickness)?;
    let placement = arguments.parts.placement();
    let list =
        DesignTouch::on_sphere(task.tip_radius, task.half_angle, arguments.friction, 0.1 * arguments.force)?;
    let touches = Touches::new(&list)?;
    let tolerance = tolerance(&layout, &task.tube.loads, placement, Some(&touches), SENSORS, arguments.seed)?;
    let compared = task.compare(&layout)?;
    let trials = trials(&task, &layout, placement, arguments)?;
    Ok(Outcome { task, found, file, layout, strength, compared, tolerance, trials })
}

fn trials(
    task: &Task,
    layout: &TubeLayout,
    placement: Placement,
    arguments: &DesignArguments,
) -> Result<Vec<(&'static str, f64, Accuracy)>, DesignError> {
    let sphere = Sphere::centred(task.tip_radius)
        .map_err(|_| DesignError::Singular { reason: "the fingertip has no radius" })?;
    let exact = Placement { angle: 0.0, position: 0.0 };
    let calibrated = MatrixUsed::Calibrated { loads: CALIBRATION_LOADS, load_error: LOAD_ERROR };
    let cases = [
        ("made exactly", exact, MatrixUsed::AsDesigned),
        ("made with tolerance, calibrated", placement, calibrated),
        ("made with tolerance, not calibrated", placement, MatrixUsed::AsDesigned),
    ];
    let mut trials = Vec::new();
    for (name, placement, matrix) in cases {
        for share in [1.0 / 30.0, 1.0 / 3.0] {
            let force = share * arguments.force;
            let touches =
                DesignTouch::on_sphere(task.tip_radius, task.half_angle, arguments.friction, force)?;
            let trial = Trial {
                loads: task.tube.loads,
                placement,
                noise: task.noise,
                resolution: 0.0,
                matrix,
                sensors: TRIAL_SENSORS,
                seed: arguments.seed,
            };
            trials.push((name, force, trial.run(layout, &sphere, &touches)?));
        }
    }
    Ok(trials)
}

/// A bar on the standard error, if that is a terminal.
fn bar(starts: usize) -> Option<ProgressBar> {
    if is_quiet() {
        return None;
    }
    let bar = ProgressBar::new(starts as u64);
    bar.set_style(ProgressStyle::with_template("{wide_bar} start {pos} of {len}, best {msg}").ok()?);
    Some(bar)
}
