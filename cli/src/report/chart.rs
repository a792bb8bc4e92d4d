//! A chart with two axes.

use super::axis::Axis;
use super::svg::{Anchor, Svg};
use crate::observe::Point;

/// Drawing units: the width of a phone's column, so that letters keep their size there.
const WIDTH: f64 = 340.0;
const HEIGHT: f64 = 235.0;
const LEFT: f64 = 44.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 36.0;
const PLOT: (f64, f64) = (WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);

/// Axes first, then whatever is drawn on them.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    svg: Svg,
    x: Axis,
    y: Axis,
}

impl Chart {
    /// An empty chart with grid and labels.
    pub(crate) fn new(title: &str, x: Axis, y: Axis) -> Self {
        let mut chart = Self { svg: Svg::new(WIDTH, HEIGHT, title), x, y };
        chart.draw_axes();
        chart.svg.begin_clip((LEFT, TOP), PLOT);
        chart
    }

    fn draw_axes(&mut self) {
        let (bottom, right) = (TOP + PLOT.1, LEFT + PLOT.0);
        for tick in self.y.ticks(5) {
            let y = self.place((self.x.low, tick.value)).1;
            self.svg.line("grid", (LEFT, y), (right, y));
            self.svg.label("tick", (LEFT - 5.0, y + 3.5), Anchor::End, &tick.label);
        }
        for tick in self.x.ticks(6) {
            let x = self.place((tick.value, self.y.low)).0;
            self.svg.line("axis", (x, bottom), (x, bottom + 4.0));
            self.svg.label("tick", (x, bottom + 15.0), Anchor::Middle, &tick.label);
        }
        self.svg.line("axis", (LEFT, bottom), (right, bottom));
        self.svg.label("name", (2.0, 12.0), Anchor::Start, &self.y.label);
        self.svg.label("name", (right, bottom + 31.0), Anchor::End, &self.x.label);
    }

    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (LEFT + PLOT.0 * self.x.place(x), TOP + PLOT.1 * (1.0 - self.y.place(y)))
    }

    /// A curve, broken between its pieces.
    pub(crate) fn curve(&mut self, class: &str, pieces: &[Vec<Point>]) {
        let placed: Vec<Vec<(f64, f64)>> = pieces
            .iter()
            .map(|piece| piece.iter().map(|point| self.place((point.time, point.value))).collect())
            .collect();
        self.svg.curve(class, placed.iter().map(Vec::as_slice));
    }

    /// Separate points.
    pub(crate) fn dots(&mut self, class: &str, points: &[(f64, f64)]) {
        let placed: Vec<_> = points.iter().map(|point| self.place(*point)).collect();
        self.svg.dots(class, placed.into_iter());
    }

    /// A line across, at a value of the y axis.
    pub(crate) fn level(&mut self, class: &str, value: f64) {
        let y = self.place((self.x.low, value)).1;
        self.svg.line(class, (LEFT, y), (LEFT + PLOT.0, y));
    }

    /// Lines upright, at values of the x axis.
    pub(crate) fn marks(&mut self, class: &str, values: impl Iterator<Item = f64>) {
        for value in values {
            let x = self.place((value, self.y.low)).0;
            self.svg.line(class, (x, TOP), (x, TOP + PLOT.1));
        }
    }

    pub(crate) fn finish(mut self) -> String {
        self.svg.end_clip();
        self.svg.finish()
    }
}
