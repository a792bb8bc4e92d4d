//! Diagrams with logarithmic axes, the Pareto front drawn, and the legend beside them.

use core::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::{
    BLACK, ChartBuilder, Color, DashedLineSeries, DrawingArea, EmptyElement, IntoDrawingArea, IntoLogRange,
    LineSeries, PathElement, Polygon, RGBColor, Rectangle, SVGBackend, Text, WHITE,
};

use crate::Failure;
use crate::pareto::front;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Okabe and Ito's colours, which the colour-blind can tell apart, and two more.
const COLOURS: [RGBColor; 9] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(90, 90, 90),
    RGBColor(120, 60, 20),
    RGBColor(110, 60, 160),
];

/// Methods that are compared in several diagrams, not all of them in each.
const FAMILIES: [&[&str]; 2] = [
    &[
        "Gauss",
        "Gauss refined",
        "Inverse",
        "LeastSquares",
        "nalgebra LU",
        "faer LU",
        "Decoupled, as drawn",
        "Decoupled, machined to 0.1 %",
        "Decoupled, machined to 1 %",
    ],
    &["point contact (wrench axis)", "soft finger, closed form", "soft finger, Newton from the last contact"],
];

const SIZE: (u32, u32) = (980, 460);
const LEGEND: u32 = 300;

/// Points of one method.
#[derive(Clone, Debug, Default)]
pub(crate) struct Series {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
    /// Quartiles of the first coordinate, one pair per point or none.
    pub(crate) spread: Vec<(f64, f64)>,
    /// Joined by a line.
    pub(crate) joined: bool,
    /// In single precision: drawn hollow.
    pub(crate) single: bool,
}

/// A diagram.
#[derive(Clone, Debug)]
pub(crate) struct Diagram {
    pub(crate) title: String,
    pub(crate) x: &'static str,
    pub(crate) y: &'static str,
    pub(crate) series: Vec<Series>,
    /// Whether less is better on both axes, so that there is a front.
    pub(crate) front: bool,
}

/// Full decades around the numbers.
pub(crate) fn decades(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    for x in values.filter(|x| *x > 0.0 && x.is_finite()) {
        low = low.min(x);
        high = high.max(x);
    }
    if !(low <= high) {
        return 0.1..10.0;
    }
    let floor = (low * 0.8).log10().floor();
    let ceiling = (high * 1.25).log10().ceil();
    10_f64.powf(floor)..10_f64.powf(ceiling.max(floor + 1.0))
}

/// A number beside an axis.
pub(crate) fn tick(x: f64) -> String {
    if (1e-3..1e5).contains(&x) { format!("{}", (x * 1e6).round() / 1e6) } else { format!("{x:.0e}") }
}

/// How many labels an axis gets: one per decade, or every so many decades.
fn labels(range: &Range<f64>) -> usize {
    let decades = (range.end / range.start).log10().round().max(1.0) as usize;
    decades.min(10) + 1
}

/// Corners of the markers, in pixels: circle-like, triangle, square, diamond.
const MARKERS: [&[(i32, i32)]; 4] = [
    &[(5, 0), (4, 4), (0, 5), (-4, 4), (-5, 0), (-4, -4), (0, -5), (4, -4)],
    &[(0, -6), (5, 4), (-5, 4)],
    &[(-4, -4), (4, -4), (4, 4), (-4, 4)],
    &[(0, -6), (6, 0), (0, 6), (-6, 0)],
];

/// How a series is drawn.
#[derive(Clone, Copy)]
struct Look {
    colour: RGBColor,
    marker: &'static [(i32, i32)],
    hollow: bool,
}

impl Look {
    /// The outline of the marker, closed, about a place.
    fn outline(self, (x, y): (i32, i32)) -> Vec<(i32, i32)> {
        self.marker.iter().chain(self.marker.first()).map(|(dx, dy)| (x + dx, y + dy)).collect()
    }

    fn inside(self) -> RGBColor {
        if self.hollow { WHITE } else { self.colour }
    }
}

impl Diagram {
    /// The picture.
    pub(crate) fn svg(&self) -> Result<String, Failure> {
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
            area.fill(&WHITE)?;
            let (chart, legend) = area.split_horizontally(SIZE.0 - LEGEND);
            self.draw(&chart)?;
            self.legend(&legend)?;
            area.present()?;
        }
        Ok(svg)
    }

    /// The look of each series: both precisions of a method (or both makers of a shape) share it. A
    /// method of the [`FAMILIES`] looks the same in every diagram.
    fn looks(&self) -> Vec<Look> {
        let method =
            |series: &Series| series.name.trim_end_matches(" f32").trim_end_matches(" f64").to_owned();
        let mut methods: Vec<String> = self.series.iter().map(method).collect();
        methods.sort();
        methods.dedup();
        let fixed = |name: &str| FAMILIES.iter().find_map(|family| family.iter().position(|m| *m == name));
        self.series
            .iter()
            .map(|series| {
                let name = method(series);
                let here = || methods.iter().position(|m| *m == name);
                let index = fixed(&name).or_else(here).unwrap_or(0);
                Look {
                    colour: COLOURS[index % COLOURS.len()],
                    marker: MARKERS[index % MARKERS.len()],
                    hollow: series.single,
                }
            })
            .collect()
    }

    fn draw(&self, area: &Area<'_>) -> Result<(), Failure> {
        let all = || self.series.iter().flat_map(|series| series.points.iter());
        let spreads = self.series.iter().flat_map(|series| series.spread.iter()).flat_map(|s| [s.0, s.1]);
        let x = decades(all().map(|p| p.0).chain(spreads));
        let y = decades(all().map(|p| p.1));
        let mut chart = ChartBuilder::on(area)
            .margin(12)
            .x_label_area_size(48)
            .y_label_area_size(70)
            .build_cartesian_2d(x.clone().log_scale(), y.clone().log_scale())?;
        chart
            .configure_mesh()
            .light_line_style(WHITE)
            .bold_line_style(BLACK.mix(0.12))
            .x_labels(labels(&x))
            .y_labels(labels(&y))
            .label_style(("sans-serif", 13))
            .axis_desc_style(("sans-serif", 14))
            .x_desc(self.x)
            .y_desc(self.y)
            .x_label_formatter(&|x| tick(*x))
            .y_label_formatter(&|y| tick(*y))
            .draw()?;
        let inside = |p: &&(f64, f64)| p.0.is_finite() && p.1.is_finite() && p.0 > 0.0 && p.1 > 0.0;
        if self.front {
            let points: Vec<(f64, f64)> = all().filter(inside).copied().collect();
            let best = front(&points);
            // The staircase of what is at least as fast and as exact as a point of the front.
            let mut stairs = Vec::new();
            for index in best {
                let (px, py) = points[index];
                stairs.push((px, stairs.last().map_or(y.end, |last: &(f64, f64)| last.1)));
                stairs.push((px, py));
            }
            if let Some(last) = stairs.last().copied() {
                stairs.push((x.end, last.1));
            }
            chart.draw_series(DashedLineSeries::new(stairs, 5, 4, BLACK.mix(0.55).stroke_width(1)))?;
        }
        for (series, look) in self.series.iter().zip(self.looks()) {
            let colour = look.colour;
            let points = || series.points.iter().filter(inside).copied();
            if series.joined {
                chart.draw_series(LineSeries::new(points(), colour.stroke_width(2)))?;
            }
            for (point, spread) in series.points.iter().zip(&series.spread) {
                let ends = [(spread.0, point.1), (spread.1, point.1)];
                chart.draw_series([PathElement::new(ends, colour.mix(0.6).stroke_width(1))])?;
            }
            chart.draw_series(points().map(|p| {
                EmptyElement::at(p)
                    + Polygon::new(look.outline((0, 0)), look.inside().filled())
                    + PathElement::new(look.outline((0, 0)), colour.stroke_width(2))
            }))?;
        }
        Ok(())
    }

    fn legend(&self, area: &Area<'_>) -> Result<(), Failure> {
        let font = ("sans-serif", 13);
        let mut line = 24;
        for (series, look) in self.series.iter().zip(self.looks()) {
            let colour = look.colour;
            let centre = (20, line + 7);
            if series.joined {
                area.draw(&PathElement::new([(8, line + 7), (32, line + 7)], colour.stroke_width(2)))?;
            }
            area.draw(&Polygon::new(look.outline(centre), look.inside().filled()))?;
            area.draw(&PathElement::new(look.outline(centre), colour.stroke_width(2)))?;
            area.draw(&Text::new(series.name.clone(), (40, line), font))?;
            line += 20;
        }
        if self.front {
            for x in [8, 18, 28] {
                area.draw(&Rectangle::new([(x, line + 7), (x + 5, line + 8)], BLACK.mix(0.55).filled()))?;
            }
            area.draw(&Text::new("Pareto front: nothing is below and left", (40, line), font))?;
        }
        Ok(())
    }
}
