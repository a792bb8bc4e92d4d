//! Figures that only a run with a known truth has.

use super::Outcome;
use crate::observe::Point;
use crate::report::{Axis, Chart, Figure};

const MILLIMETRES: f64 = 1e3;

pub(super) fn of(outcome: &Outcome) -> Vec<Figure> {
    vec![position_error(outcome)]
}

/// What the prototype of 1987 did: `a/|F| + b` fitted to its Fig. 5 (1.0 N: 0.2 mm, 10.1 N:
/// 0.05 mm).
fn prototype(load: f64) -> f64 {
    0.167 / load + 0.033
}

fn position_error(outcome: &Outcome) -> Figure {
    let sampled: Vec<(f64, f64)> = outcome
        .errors
        .kept()
        .iter()
        .map(|error| (error.load, error.position * MILLIMETRES))
        .filter(|(load, error)| *load > 0.0 && *error > 0.0)
        .collect();
    let levels: Vec<(f64, f64)> = outcome
        .report
        .levels()
        .iter()
        .map(|level| (level.force, level.mean_position_error * MILLIMETRES))
        .filter(|(_, error)| *error > 0.0 && error.is_finite())
        .collect();
    let mut errors: Vec<f64> = sampled.iter().map(|(_, error)| *error).collect();
    errors.sort_by(f64::total_cmp);
    // The smallest errors are luck: leave out the lowest hundredth.
    let low = errors.get(errors.len() / 100).copied().unwrap_or(1e-2);
    let high = errors.last().copied().unwrap_or(1.0);
    let (least, greatest) = sampled
        .iter()
        .chain(&levels)
        .fold((f64::INFINITY, 0.0_f64), |(low, high), (load, _)| (low.min(*load), high.max(*load)));
    let mut chart = Chart::new(
        "Position error against load",
        Axis::log("force / N", 0.9 * least, 1.1 * greatest),
        Axis::log("position error / mm", 0.8 * low, 1.2 * high),
    );
    chart.dots("a faint", &sampled);
    let steps = 60;
    let paper: Vec<Point> = (0..=steps)
        .map(|i| 0.1 * 300.0_f64.powf(f64::from(i) / f64::from(steps)))
        .map(|load| Point { time: load, value: prototype(load) })
        .collect();
    chart.curve("e wide", &[paper]);
    chart.dots("b large", &levels);
    Figure {
        title: "Position error against load".to_owned(),
        svg: chart.finish(),
        keys: vec![
            ("a spot", "one sample".to_owned()),
            ("b spot", "press of 0.25 s".to_owned()),
            ("e", "prototype of 1987".to_owned()),
        ],
        caption: "Distance of the contact point from the true one. The curve is 0.167 N·mm/|f| + 0.033 mm, fitted to \
                  what Bicchi & Dario measured at 1 and 10 N. Errors below the lower edge are cut."
            .to_owned(),
        on_white: false,
    }
}
