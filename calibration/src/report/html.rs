//! A report as a web page with tables and plots.

use core::fmt::Write as _;

use super::plot::{FITTED, LEFT_OUT};
use super::{AxisReport, Report};

const STYLE: &str = "body{font-family:sans-serif;max-width:66em;margin:2em auto;padding:0 1em;color:#1f2328}\
    table{border-collapse:collapse;margin:.8em 0}td,th{padding:.25em .7em;text-align:right;\
    border-bottom:1px solid #d0d7de}td:first-child,th:first-child{text-align:left}\
    .text td,.text th{text-align:left}thead th{border-bottom:2px solid #8c959f}tr.first td{font-weight:bold}\
    .wide{overflow-x:auto}.verdict{font-weight:bold}.good{color:#1a7f37}.bad{color:#cf222e}\
    .unchecked,.suspect{color:#9a6700}figure{display:inline-block;margin:.5em}figcaption{text-align:center}\
    .legend span{display:inline-block;width:.7em;height:.7em;border-radius:50%;margin:0 .4em 0 1em}\
    p.small{color:#57606a;font-size:90%}svg{max-width:100%;height:auto}";

type Column = fn(&AxisReport) -> Option<f64>;

/// Rows of the table of errors, and what each means.
const ROWS: [(&str, &str, Column); 10] = [
    ("RMS", "root mean square of the error on these loads", |a| Some(a.rms_percent)),
    ("greatest", "greatest error on these loads", |a| Some(a.greatest_percent)),
    ("left out, RMS", "each load case predicted by a fit without it", |a| a.left_out_percent),
    ("left out, greatest", "the same, greatest", |a| a.left_out_greatest_percent),
    ("one reading", "standard deviation of one reading, from what the fit leaves", |a| a.deviation_percent),
    ("linearity", "greatest deviation from the best line through zero", |a| a.linearity_percent),
    ("hysteresis", "greatest difference between rising and falling load", |a| a.hysteresis_percent),
    ("repeatability", "standard deviation of readings of the same load", |a| a.repeatability_percent),
    ("zero return", "greatest change of the reading without load, after loading", |a| a.zero_return_percent),
    ("creep", "greatest change of the reading while a load is held", |a| a.creep_percent),
];

impl Report {
    /// As one HTML page without scripts or outside files, plots as SVG within.
    #[must_use]
    pub fn to_html(&self, title: &str) -> String {
        let title = escape(title);
        let word = self.verdict.name();
        let mut page = format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" \
             content=\"width=device-width,initial-scale=1\">\n<title>{title}</title>\n<style>{STYLE}</style></head>\
             <body>\n<h1>{title}</h1>\n<p>This calibration is <span class=\"verdict {word}\">{word}</span>.</p>\n"
        );
        for (heading, items) in [("Why", &self.reasons), ("Mind", &self.notes)] {
            if !items.is_empty() {
                let items: String = items.iter().map(|item| format!("<li>{}</li>", escape(item))).collect();
                // Writing to a String cannot fail.
                let _ = writeln!(page, "<h2>{heading}</h2>\n<ul>{items}</ul>");
            }
        }
        self.summary(&mut page);
        self.errors(&mut page);
        self.cross_talk(&mut page);
        self.places(&mut page);
        self.deviations(&mut page);
        if !self.excluded.is_empty() {
            page.push_str(
                "<h2>Samples left out</h2>\n<table class=\"text\"><thead><tr><th>sample</th><th>why</th></tr></thead>\n",
            );
            for excluded in &self.excluded {
                let (sample, reason) = (escape(&excluded.sample), escape(&excluded.reason));
                let _ = writeln!(page, "<tr><td>{sample}</td><td>{reason}</td></tr>");
            }
            page.push_str("</table>\n");
        }
        self.plots(&mut page);
        page.push_str("</body></html>\n");
        page
    }

    fn summary(&self, page: &mut String) {
        let number = self.condition_number.map_or("infinite (singular)".to_owned(), |n| format!("{n:.2}"));
        let _ = write!(
            page,
            "<p>Method: {}; {} samples in {} load cases",
            escape(&self.method),
            self.samples,
            self.cases
        );
        if self.coefficients > 0 {
            let _ = write!(page, ", {} coefficients each", self.coefficients);
        }
        let _ = writeln!(page, "; condition number N<sub>c</sub> = {number}.</p>");
    }

    fn errors(&self, page: &mut String) {
        page.push_str("<h2>Errors, % of full scale</h2>\n<div class=\"wide\"><table><thead><tr><th></th>");
        for axis in &self.axes {
            let _ = write!(page, "<th>{}</th>", axis.axis);
        }
        page.push_str("</tr></thead>\n<tr><td>full scale</td>");
        for axis in &self.axes {
            let _ = write!(page, "<td>{} {}</td>", short(axis.full_scale), axis.axis.unit());
        }
        page.push_str("</tr>\n");
        for (name, meaning, value) in ROWS {
            if self.axes.iter().any(|axis| value(axis).is_some()) {
                let first = if name == "RMS" { " class=\"first\"" } else { "" };
                let _ = write!(page, "<tr{first} title=\"{meaning}\"><td>{name}</td>");
                for axis in &self.axes {
                    let _ = write!(page, "<td>{}</td>", cell(value(axis)));
                }
                page.push_str("</tr>\n");
            }
        }
        page.push_str("</table></div>\n<p class=\"small\">");
        for (name, meaning, value) in ROWS {
            if self.axes.iter().any(|axis| value(axis).is_some()) {
                let _ = write!(page, "<b>{name}</b>: {meaning}. ");
            }
        }
        page.push_str("A dash: these loads do not tell.</p>\n");
    }

    fn cross_talk(&self, page: &mut String) {
        let all: Vec<f64> = self.cross_talk_percent.iter().flatten().flatten().copied().collect();
        let most = all.iter().copied().fold(0.0, f64::max);
        if all.is_empty() {
            return;
        }
        page.push_str(
            "<h2>Cross-talk, % of full scale</h2>\n<p class=\"small\">Greatest false reading of an axis (row) under \
             loads of another one alone (column).</p>\n<table><thead><tr><th></th>",
        );
        for axis in &self.axes {
            let _ = write!(page, "<th>{}</th>", axis.axis);
        }
        page.push_str("</tr></thead>\n");
        for (axis, row) in self.axes.iter().zip(&self.cross_talk_percent) {
            let _ = write!(page, "<tr><td>{}</td>", axis.axis);
            for value in row {
                let shade = value.map_or(0.0, |value| 0.35 * value / most.max(f64::MIN_POSITIVE));
                let _ =
                    write!(page, "<td style=\"background:rgba(207,34,46,{shade:.2})\">{}</td>", cell(*value));
            }
            page.push_str("</tr>\n");
        }
        page.push_str("</table>\n");
    }

    /// Lines of action and contact points.
    fn places(&self, page: &mut String) {
        if self.lines.is_some() || self.contacts.is_some() {
            page.push_str("<h2>Where touches are found</h2>\n");
        }
        if let Some(lines) = &self.lines {
            let expected = lines
                .expected_mm
                .map_or(String::new(), |mm| format!(" ({mm:.3} mm expected of the covariance)"));
            let _ = writeln!(
                page,
                "<p>Lines of action of the {} pure forces of these loads: off by <b>{:.3} mm</b> in the median{expected}, \
                 {:.3} mm at most.</p>",
                lines.lines, lines.median_mm, lines.greatest_mm
            );
        }
        if let Some(contacts) = &self.contacts {
            let _ = writeln!(
                page,
                "<p>Contact points on {} under {:.3} N, expected of the covariance ({} touches all over it): off by \
                 <b>{:.3} mm</b> (root mean square), {:.3} mm where it is worst. Of that, {:.3} mm come of the matrix, \
                 which no averaging mends, and {:.3} mm of the noise of one reading.</p>",
                escape(&contacts.surface),
                contacts.force,
                contacts.touches,
                contacts.together_mm,
                contacts.worst_mm,
                contacts.calibration_mm,
                contacts.reading_mm
            );
        }
    }

    fn deviations(&self, page: &mut String) {
        let (Some(matrix), Some(deviations)) = (&self.matrix, &self.matrix_deviations) else { return };
        page.push_str(
            "<h2>The matrix</h2>\n<p class=\"small\">Signal of each gauge (row) under the full scale of each axis \
             (column), and its standard deviation.</p>\n<div class=\"wide\"><table><thead><tr><th></th>",
        );
        for axis in &self.axes {
            let _ = write!(page, "<th>{}</th>", axis.axis);
        }
        page.push_str("</tr></thead>\n");
        for (gauge, (row, spread)) in matrix.iter().zip(deviations).enumerate() {
            let _ = write!(page, "<tr><td>gauge {}</td>", gauge + 1);
            for (value, deviation) in row.iter().zip(spread) {
                let digits = digits(*deviation, 2);
                let _ = write!(page, "<td>{value:.digits$} ± {deviation:.digits$}</td>");
            }
            page.push_str("</tr>\n");
        }
        page.push_str("</table></div>\n");
    }

    fn plots(&self, page: &mut String) {
        let colour = |c: plotters::style::RGBColor| format!("rgb({},{},{})", c.0, c.1, c.2);
        let _ = write!(
            page,
            "<h2>Plots</h2>\n<p class=\"legend\"><span style=\"background:{}\"></span>{}",
            colour(FITTED),
            if self.coefficients > 0 { "loads of the fit" } else { "these loads" }
        );
        if self.details.iter().any(|sample| sample.left_out.is_some()) {
            let _ = write!(
                page,
                "<span style=\"border:1.5px solid {}\"></span>the same loads, left out of the fit",
                colour(LEFT_OUT)
            );
        }
        page.push_str("</p>\n");
        for (index, axis) in self.axes.iter().enumerate() {
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
    }
}

fn cell(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.3}"))
}

/// Four significant digits.
fn short(value: f64) -> String {
    let digits = digits(value, 4);
    format!("{value:.digits$}")
}

/// How many digits behind the point a number of significant digits takes.
fn digits(value: f64, significant: u8) -> usize {
    let digits = f64::from(significant) - 1.0 - value.abs().max(1e-12).log10().floor();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let digits = digits.clamp(0.0, 12.0) as usize;
    digits
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
