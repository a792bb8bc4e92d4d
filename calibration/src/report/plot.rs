//! The plots of a report, as SVG.

use plotters::prelude::*;

use super::{Report, SampleReport};
use crate::page::{Counting, Placed, text_width};

const WIDTH: u32 = 480;
const HEIGHT: u32 = 300;
/// Room around what is drawn: at the edges, for the numbers across and for those upwards.
const MARGIN: u32 = 8;
const BELOW: u32 = 44;
const BESIDE: u32 = 64;
/// Letters of the ticks and of the names of samples.
const TICK: f64 = 14.0;
const NAME: f64 = 13.0;
/// Longer names of samples are cut.
const LONGEST_NAME: usize = 24;

/// Of the fit.
pub(super) const FITTED: RGBColor = RGBColor(9, 105, 218);
/// Of the loads that were left out of the fit.
pub(super) const LEFT_OUT: RGBColor = RGBColor(207, 34, 46);

impl Report {
    /// Error, % of full scale, over the applied load: points of the fit, and of the loads left out.
    #[must_use]
    pub fn error_over_load(&self, axis: usize) -> Option<String> {
        let report = self.axes.get(axis)?;
        let label = format!("{} / {}", report.axis, report.axis.unit());
        self.plot(axis, &label, |_, sample| sample.applied.get(axis).copied())
    }

    /// Error, % of full scale, in the order of the samples.
    #[must_use]
    pub fn error_over_samples(&self, axis: usize) -> Option<String> {
        self.plot(axis, "sample", |index, _| Some(index as f64 + 1.0))
    }

    fn plot(
        &self,
        axis: usize,
        label: &str,
        position: impl Fn(usize, &SampleReport) -> Option<f64>,
    ) -> Option<String> {
        let full_scale = self.axes.get(axis)?.full_scale;
        let (mut fitted, mut left_out) = (Vec::new(), Vec::new());
        for (index, sample) in self.details.iter().enumerate() {
            let (x, applied) = (position(index, sample)?, *sample.applied.get(axis)?);
            let percent = |value: f64| 100.0 * (value - applied) / full_scale;
            fitted.push((x, percent(*sample.measured.get(axis)?)));
            if let Some(value) = sample.left_out.as_ref().and_then(|load| load.get(axis)) {
                left_out.push((x, percent(*value)));
            }
        }
        let all = || fitted.iter().chain(&left_out);
        // A maximum passes over NaN.
        if fitted.is_empty() || !all().all(|(x, error)| x.is_finite() && error.is_finite()) {
            return None;
        }
        let least = all().map(|p| p.0).fold(f64::INFINITY, f64::min);
        let most = all().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
        let error = all().map(|p| p.1.abs()).fold(0.0, f64::max);
        let margin = if most > least { 0.05 * (most - least) } else { 1.0 };
        let error = if error > 0.0 { 1.1 * error } else { 1.0 };
        let mut svg = String::new();
        let outliers = self.outlier_places(axis, &position, full_scale);
        let chart = Chart { label, error, fitted: &fitted, left_out: &left_out, outliers: &outliers };
        chart.draw(&mut svg, (least - margin, most + margin)).ok()?;
        Some(svg)
    }

    /// Name and place of the samples that do not fit the others, which plots label.
    fn outlier_places(
        &self,
        axis: usize,
        position: &impl Fn(usize, &SampleReport) -> Option<f64>,
        full_scale: f64,
    ) -> Vec<(String, (f64, f64))> {
        let named = |name: &str| self.outliers.iter().any(|outlier| outlier.sample == name);
        let place = |(index, sample): (usize, &SampleReport)| {
            let error = sample.measured.get(axis)? - sample.applied.get(axis)?;
            Some((sample.name.clone(), (position(index, sample)?, 100.0 * error / full_scale)))
        };
        self.details.iter().enumerate().filter(|(_, sample)| named(&sample.name)).filter_map(place).collect()
    }
}

type Failure = Box<dyn core::error::Error>;

/// What a plot shows.
struct Chart<'a> {
    label: &'a str,
    /// Greatest error to show.
    error: f64,
    fitted: &'a [(f64, f64)],
    left_out: &'a [(f64, f64)],
    outliers: &'a [(String, (f64, f64))],
}

impl Chart<'_> {
    fn draw(&self, svg: &mut String, (least, most): (f64, f64)) -> Result<(), Failure> {
        let describe = |error: DrawingAreaErrorKind<_>| -> Failure { format!("{error}").into() };
        let area = SVGBackend::with_string(svg, (WIDTH, HEIGHT)).into_drawing_area();
        area.fill(&WHITE).map_err(describe)?;
        let mut chart = ChartBuilder::on(&area)
            .margin(MARGIN)
            .x_label_area_size(BELOW)
            .y_label_area_size(BESIDE)
            .build_cartesian_2d(least..most, -self.error..self.error)
            .map_err(describe)?;
        let (across, up) = (Counting::of(least, most), Counting::of(-self.error, self.error));
        chart
            .configure_mesh()
            .disable_x_mesh()
            .max_light_lines(0)
            .bold_line_style(RGBColor(225, 228, 232))
            .axis_style(RGBColor(110, 118, 129))
            .label_style(("sans-serif", TICK))
            .axis_desc_style(("sans-serif", 15))
            .x_labels(7)
            .y_labels(7)
            .x_label_formatter(&|value| tick(across.said(*value)))
            .y_label_formatter(&|value| tick(up.said(*value)))
            .x_desc(across.title(self.label))
            .y_desc(up.title("error / % of full scale"))
            .draw()
            .map_err(describe)?;
        let zero = [(least, 0.0), (most, 0.0)];
        chart
            .draw_series(LineSeries::new(zero, RGBColor(110, 118, 129).stroke_width(1)))
            .map_err(describe)?;
        let hollow = |point: &(f64, f64)| Circle::new(*point, 5, LEFT_OUT.stroke_width(1));
        chart.draw_series(self.left_out.iter().map(hollow)).map_err(describe)?;
        let solid = |point: &(f64, f64)| Circle::new(*point, 3, FITTED.filled());
        chart.draw_series(self.fitted.iter().map(solid)).map_err(describe)?;
        let mut placed = Placed::default();
        for (name, (x, y)) in self.outliers {
            let name = shortened(name);
            let is_left = *x < 0.5 * (least + most);
            if !placed.take(self.place_of(&name, (*x, *y), (least, most), is_left)) {
                continue;
            }
            // Towards the middle, so that the name stays within the plot.
            let (shift, anchor) = if is_left {
                (9, plotters::style::text_anchor::HPos::Left)
            } else {
                (-9, plotters::style::text_anchor::HPos::Right)
            };
            let place =
                plotters::style::text_anchor::Pos::new(anchor, plotters::style::text_anchor::VPos::Center);
            let style = TextStyle::from(("sans-serif", NAME).into_font()).pos(place);
            let mark = EmptyElement::at((*x, *y)) + Text::new(name, (shift, 0), style);
            chart.draw_series(core::iter::once(mark)).map_err(describe)?;
        }
        area.present().map_err(describe)?;
        Ok(())
    }

    /// The box in the drawing of the name beside a point.
    fn place_of(&self, name: &str, (x, y): (f64, f64), (least, most): (f64, f64), is_left: bool) -> [f64; 4] {
        let (wide, high) = (WIDTH - 2 * MARGIN - BESIDE, HEIGHT - 2 * MARGIN - BELOW);
        let across = f64::from(wide) * (x - least) / (most - least);
        let down = f64::from(high) * 0.5 * (1.0 - y / self.error);
        let long = text_width(name, NAME);
        let left = if is_left { across + 9.0 } else { across - 9.0 - long };
        [left, left + long, down - 0.5 * NAME, down + 0.5 * NAME]
    }
}

/// A name that leaves room for others.
fn shortened(name: &str) -> String {
    match name.char_indices().nth(LONGEST_NAME) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.to_owned(),
    }
}

/// A number as short as it can be; no zero has a sign.
fn tick(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    if rounded == 0.0 { "0".to_owned() } else { format!("{rounded}").replace('-', "−") }
}
