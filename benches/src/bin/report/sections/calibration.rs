//! Calibration fits: error against the number of samples, for each way in which data are bad.

use std::time::Instant;

use fingertip_calibration::fit::{
    Fit, FitError, Ransac, gauss_helmert, huber, least_squares, ransac, total_least_squares,
};
use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::Part;
use crate::Failure;
use crate::page::Page;
use crate::plots::{Diagram, Series};
use crate::table::{Table, shown};
use crate::timing::{Effort, median};

/// Six loads of unit size, six gauges of about that signal.
const AXES: usize = 6;
/// Standard deviation of the signals.
const NOISE: f64 = 0.01;

#[derive(Clone, Copy, PartialEq)]
enum World {
    Even,
    Uneven,
    Outliers,
    LoadErrors,
}

impl World {
    const ALL: [Self; 4] = [Self::Even, Self::Uneven, Self::Outliers, Self::LoadErrors];

    const fn name(self) -> &'static str {
        match self {
            Self::Even => "noise of 1 %",
            Self::Uneven => "noise of 0.1 to 10 %, known for each sample",
            Self::Outliers => "noise of 1 %, and 5 % of the samples wrong by up to the full scale",
            Self::LoadErrors => "noise of 1 %, loads wrong by 20 % of their spread",
        }
    }

    /// How wrong the loads are.
    const fn load_error(self) -> f64 {
        if matches!(self, Self::LoadErrors) { 0.2 } else { 0.0 }
    }
}

struct Data {
    truth: DMatrix<f64>,
    loads: DMatrix<f64>,
    signals: DMatrix<f64>,
    deviations: Vec<f64>,
}

fn normal(random: &mut Pcg64Mcg) -> f64 {
    StandardNormal.sample(random)
}

fn data(world: World, samples: usize, random: &mut Pcg64Mcg) -> Data {
    let truth = DMatrix::from_fn(AXES, AXES, |i, j| f64::from(u8::from(i == j)) + 0.2 * normal(random));
    let clean = DMatrix::from_fn(samples, AXES, |_, _| normal(random));
    let mut signals = &clean * &truth;
    let mut deviations = Vec::with_capacity(samples);
    for i in 0..samples {
        let deviation =
            if world == World::Uneven { 1e-3 * 100_f64.powf(random.random_range(0.0..1.0)) } else { NOISE };
        let wrong = world == World::Outliers && random.random_bool(0.05);
        for j in 0..AXES {
            let off = if wrong { random.random_range(-1.0..1.0) } else { 0.0 };
            signals[(i, j)] += deviation * normal(random) + off;
        }
        deviations.push(deviation);
    }
    let loads = clean.map(|x| x + world.load_error() * normal(random));
    Data { truth, loads, signals, deviations }
}

type Routine = fn(World, &Data) -> Result<Fit, FitError>;

fn plain(_: World, d: &Data) -> Result<Fit, FitError> {
    least_squares(&d.loads, &d.signals, None)
}

fn weighted(_: World, d: &Data) -> Result<Fit, FitError> {
    let weights: Vec<f64> = d.deviations.iter().map(|s| 1.0 / (s * s)).collect();
    least_squares(&d.loads, &d.signals, Some(&weights))
}

fn robust(_: World, d: &Data) -> Result<Fit, FitError> {
    huber(&d.loads, &d.signals, None)
}

fn consensus(_: World, d: &Data) -> Result<Fit, FitError> {
    ransac(&d.loads, &d.signals, None, &Ransac::new(vec![4.0 * NOISE; AXES]))
}

fn total(world: World, d: &Data) -> Result<Fit, FitError> {
    total_least_squares(&d.loads, &d.signals, &[world.load_error().max(1e-9); AXES], &[NOISE; AXES], false)
}

fn helmert(world: World, d: &Data) -> Result<Fit, FitError> {
    let samples = d.loads.nrows();
    let loads = DMatrix::from_element(samples, AXES, world.load_error());
    let signals = DMatrix::from_fn(samples, AXES, |i, _| d.deviations[i]);
    gauss_helmert(&d.loads, &d.signals, &loads, &signals)
}

const fn routines(world: World) -> &'static [(&'static str, Routine)] {
    match world {
        World::Even => &[("least squares", plain), ("Huber", robust), ("total least squares", total)],
        World::Uneven => &[("least squares", plain), ("weighted", weighted), ("Gauss-Helmert", helmert)],
        World::Outliers => &[("least squares", plain), ("Huber", robust), ("RANSAC", consensus)],
        World::LoadErrors => {
            &[("least squares", plain), ("total least squares", total), ("Gauss-Helmert", helmert)]
        }
    }
}

struct Figure {
    world: World,
    fit: &'static str,
    samples: usize,
    error: f64,
    failed: usize,
    microseconds: f64,
}

fn figure(world: World, fit: (&'static str, Routine), samples: usize, trials: usize) -> Figure {
    let mut random = Pcg64Mcg::seed_from_u64(21);
    let (mut errors, mut times, mut failed) = (Vec::new(), Vec::new(), 0);
    for _ in 0..trials {
        let data = data(world, samples, &mut random);
        let start = Instant::now();
        let found = (fit.1)(world, &data);
        times.push(start.elapsed().as_secs_f64() * 1e6);
        match found {
            Ok(found) => errors.push((found.coefficients - &data.truth).norm() / data.truth.norm()),
            Err(_) => failed += 1,
        }
    }
    Figure {
        world,
        fit: fit.0,
        samples,
        error: median(&mut errors),
        failed,
        microseconds: median(&mut times),
    }
}

pub(crate) fn report(page: &mut Page, effort: Effort) -> Result<Part, Failure> {
    page.heading("Calibration: error against samples");
    page.say(
        "Random sensors of six gauges with crosstalk, loads in all directions. The error is that of the sensor \
         matrix, in the Frobenius norm relative to the matrix, in the median over sensors. A fit whose \
         assumption is right falls with the root of the number of samples; one whose assumption is wrong \
         comes to rest.",
    );
    let all = [12_usize, 20, 40, 100, 300, 1000, 3000];
    let counts: Vec<usize> = all.into_iter().step_by(effort.choose(3, 1)).take(effort.choose(2, 7)).collect();
    let trials = effort.choose(5, 25);
    let mut figures = Vec::new();
    for world in World::ALL {
        for routine in routines(world) {
            for samples in &counts {
                figures.push(figure(world, *routine, *samples, trials));
            }
        }
    }
    let mut short =
        Table::new(&["data", "fit", "error at 100 samples", "at the most samples", "ms at the most"]);
    for (index, world) in World::ALL.into_iter().enumerate() {
        let mut series = Vec::new();
        for (fit, _) in routines(world) {
            let these = || figures.iter().filter(|f| f.world == world && f.fit == *fit);
            series.push(Series {
                name: (*fit).to_owned(),
                points: these().map(|f| (f.samples as f64, f.error)).collect(),
                joined: true,
                ..Series::default()
            });
            let hundred = these().find(|f| f.samples == 100).map_or(f64::NAN, |f| f.error);
            if let Some(last) = these().next_back() {
                let samples = last.samples;
                short.row([
                    world.name().to_owned(),
                    (*fit).to_owned(),
                    shown(hundred),
                    format!("{} ({samples})", shown(last.error)),
                    shown(last.microseconds * 1e-3),
                ]);
            }
        }
        page.diagram(
            &format!("calibration_{index}"),
            &Diagram {
                title: format!("Calibration with {}", world.name()),
                x: "samples",
                y: "median relative error of the sensor matrix",
                series,
                front: false,
            },
        )?;
    }
    page.table(&short);
    let mut table =
        Table::new(&["data", "fit", "samples", "median relative error", "failed", "of", "median µs"]);
    for f in &figures {
        table.row([
            f.world.name().to_owned(),
            f.fit.to_owned(),
            f.samples.to_string(),
            format!("{:.3e}", f.error),
            f.failed.to_string(),
            trials.to_string(),
            format!("{:.0}", f.microseconds),
        ]);
    }
    page.data("calibration", &table);
    Ok(("Calibration".to_owned(), short.markdown()))
}
