//! A report as a web page with plots.

use core::fmt::Write as _;

use plotters::prelude::*;

use super::{Report, SampleReport};
use crate::file::Verdict;

const WIDTH: u32 = 480;
const HEIGHT: u32 = 300;

impl Report {
    /// As one HTML page without scripts or outside files, plots as SVG within.
    #[must_use]
    pub fn to_html(&self, title: &str) -> String {
        let mut page = String::from("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n");
        let title = escape(title);
        let (word, colour) = match self.verdict {
            Verdict::Good => ("good", "#1a7f37"),
            Verdict::Bad => ("bad", "#cf222e"),
            Verdict::Unchecked => ("unchecked", "#9a6700"),
        };
        // Writing to a String cannot fail.
        let _ = write!(
            page,
            "<title>{title}</title>\n<style>body{{font-family:sans-serif;max-width:64em;margin:2em auto;padding:0 1em}}\
             pre{{background:#f6f8fa;padding:1em;overflow-x:auto}}.verdict{{color:{colour}}}\
             figure{{display:inline-block;margin:0.5em}}</style></head><body>\n\
             <h1>{title}</h1>\n<p>This calibration is <strong class=\"verdict\">{word}</strong>.</p>\n"
        );
        for (heading, items) in [("Why", &self.reasons), ("Mind", &self.notes)] {
            if !items.is_empty() {
                let _ = write!(page, "<h2>{heading}</h2>\n<ul>");
                for item in items {
                    let _ = write!(page, "<li>{}</li>", escape(item));
                }
                page.push_str("</ul>\n");
            }
        }
        let _ = write!(page, "<h2>Figures</h2>\n<pre>{}</pre>\n<h2>Plots</h2>\n", escape(&self.to_string()));
        for index in 0..self.axes.len() {
            let axis = &self.axes[index];
            for (caption, svg) in [
                (format!("{}: error over load", axis.axis), self.error_over_load(index)),
                (format!("{}: error, sample after sample", axis.axis), self.error_over_samples(index)),
            ] {
                if let Some(svg) = svg {
                    let caption = escape(&caption);
                    let _ = writeln!(page, "<figure>{svg}<figcaption>{caption}</figcaption></figure>");
                }
            }
        }
        page.push_str("</body></html>\n");
        page
    }

    /// Error, % of full scale, over the applied load: points of the fit, and of the loads left out.
    #[must_use]
    pub fn error_over_load(&self, axis: usize) -> Option<String> {
        let report = self.axes.get(axis)?;
        let label = format!("{} [{}]", report.axis, report.axis.unit());
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
        let least = all().map(|p| p.0).fold(f64::INFINITY, f64::min);
        let most = all().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
        let error = all().map(|p| p.1.abs()).fold(0.0, f64::max);
        if !(least.is_finite() && most.is_finite() && error.is_finite()) {
            return None;
        }
        let margin = if most > least { 0.05 * (most - least) } else { 1.0 };
        let error = if error > 0.0 { 1.1 * error } else { 1.0 };
        let mut svg = String::new();
        draw(&mut svg, label, (least - margin, most + margin), error, &fitted, &left_out).ok()?;
        Some(svg)
    }
}

type Failure = Box<dyn core::error::Error>;

fn draw(
    svg: &mut String,
    label: &str,
    (least, most): (f64, f64),
    error: f64,
    fitted: &[(f64, f64)],
    left_out: &[(f64, f64)],
) -> Result<(), Failure> {
    let describe = |error: DrawingAreaErrorKind<_>| -> Failure { format!("{error}").into() };
    let area = SVGBackend::with_string(svg, (WIDTH, HEIGHT)).into_drawing_area();
    area.fill(&WHITE).map_err(describe)?;
    let mut chart = ChartBuilder::on(&area)
        .margin(8)
        .x_label_area_size(36)
        .y_label_area_size(56)
        .build_cartesian_2d(least..most, -error..error)
        .map_err(describe)?;
    chart.configure_mesh().x_desc(label).y_desc("error [% FS]").draw().map_err(describe)?;
    let hollow = RGBColor(207, 34, 46);
    chart
        .draw_series(left_out.iter().map(|point| Circle::new(*point, 4, hollow.stroke_width(1))))
        .map_err(describe)?
        .label("left out");
    let solid = RGBColor(9, 105, 218);
    chart
        .draw_series(fitted.iter().map(|point| Circle::new(*point, 2, solid.filled())))
        .map_err(describe)?
        .label("fitted");
    area.present().map_err(describe)?;
    Ok(())
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
