//! `report.html`: one file that needs nothing else.

mod axis;
mod chart;
mod colours;
pub(crate) mod contours;
mod figures;
mod map;
mod page;
mod read_back;
mod svg;
pub(crate) mod unrolled_tube;

pub(crate) use axis::Axis;
pub(crate) use chart::Chart;

use crate::observe::Observations;
use crate::scene::Scene;
use crate::summary::Findings;

/// A drawing with its legend.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    pub(crate) title: String,
    pub(crate) svg: String,
    /// Class of the style sheet, and what is drawn so.
    pub(crate) keys: Vec<(&'static str, String)>,
    pub(crate) caption: String,
}

/// The report of a recording.
pub(crate) fn of_recording(findings: &Findings, observations: &Observations, scene: &Scene) -> String {
    let figures = figures::of(observations, scene.friction.coefficient());
    page::render(findings, &figures)
}

/// The report of a run with figures of its own before the usual ones.
pub(crate) fn with_figures(
    findings: &Findings,
    mut figures: Vec<Figure>,
    observations: &Observations,
    coefficient: Option<f64>,
) -> String {
    figures.extend(figures::of(observations, coefficient));
    page::render(findings, &figures)
}

/// The report of something else than a recording.
pub(crate) fn of_design(findings: &Findings, figures: &[Figure]) -> String {
    page::render(findings, figures)
}
