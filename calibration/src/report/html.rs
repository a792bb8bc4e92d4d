//! A report as a web page with tables and plots.

use maud::{Markup, html};

use super::{AxisReport, Report};
use crate::page::{Page, Table};

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
    /// As one HTML page without outside files, plots as SVG within, of which the points can be read under the pointer. `of` says of which sensor, files and
    /// date: names and what stands beside them; what is empty is left out.
    #[must_use]
    pub fn to_html(&self, title: &str, of: &[(&str, String)]) -> String {
        let mut page = Page::new(title);
        let word = self.verdict.name();
        page.push(&html! { p.lead { "This calibration is " b class=(word) { (word) } "." } });
        let of: Vec<Vec<String>> = of
            .iter()
            .filter(|(_, text)| !text.is_empty())
            .map(|(name, text)| vec![(*name).to_owned(), text.clone()])
            .collect();
        if !of.is_empty() {
            page.table(&Table { title: "", head: &[], rows: &of, words: true });
        }
        page.list("Why", &self.reasons);
        page.list("Mind", &self.notes);
        page.push(&self.summary());
        self.errors(&mut page);
        self.cross_talk(&mut page);
        self.places(&mut page);
        self.deviations(&mut page);
        if !self.excluded.is_empty() {
            page.heading("Samples left out");
            let rows: Vec<Vec<String>> =
                self.excluded.iter().map(|one| vec![one.sample.clone(), one.reason.clone()]).collect();
            let head = ["sample".to_owned(), "why".to_owned()];
            page.table(&Table { title: "", head: &head, rows: &rows, words: true });
        }
        self.plots(&mut page);
        page.finish("")
    }

    fn summary(&self) -> Markup {
        let number = self.condition_number.map_or("infinite (singular)".to_owned(), |n| format!("{n:.2}"));
        html! {
            p {
                "Method: " (self.method) "; " (self.samples) " samples in " (self.cases) " load cases"
                @if self.coefficients > 0 { ", " (self.coefficients) " coefficients each" }
                "; condition number N" sub { "c" } " = " (number) "."
            }
        }
    }

    /// An empty head, and one for each axis.
    fn head(&self) -> Vec<String> {
        core::iter::once(String::new()).chain(self.axes.iter().map(|axis| axis.axis.to_string())).collect()
    }

    fn errors(&self, page: &mut Page) {
        page.heading("Errors, % of full scale");
        let row = |name: &str, cell: &dyn Fn(&AxisReport) -> String| {
            core::iter::once(name.to_owned()).chain(self.axes.iter().map(cell)).collect::<Vec<_>>()
        };
        let told = || ROWS.iter().filter(|(.., value)| self.axes.iter().any(|axis| value(axis).is_some()));
        let mut rows =
            vec![row("full scale", &|axis| format!("{} {}", short(axis.full_scale), axis.axis.unit()))];
        rows.extend(told().map(|(name, _, value)| row(name, &|axis| cell(value(axis)))));
        page.table(&Table { title: "", head: &self.head(), rows: &rows, words: false });
        page.push(&html! {
            p.small {
                @for (name, meaning, _) in told() { b { (name) } ": " (meaning) ". " }
                "A dash: these loads do not tell."
            }
        });
    }

    fn cross_talk(&self, page: &mut Page) {
        let all: Vec<f64> = self.cross_talk_percent.iter().flatten().flatten().copied().collect();
        let most = all.iter().copied().fold(0.0, f64::max);
        if all.is_empty() {
            return;
        }
        let shade = |value: Option<f64>| {
            let shade = value.map_or(0.0, |value| 0.35 * value / most.max(f64::MIN_POSITIVE));
            format!("background:color-mix(in srgb, var(--alarm) {:.0}%, transparent)", 100.0 * shade)
        };
        page.heading("Cross-talk, % of full scale");
        page.small("Greatest false reading of an axis (row) under loads of another one alone (column).");
        page.push(&html! {
            section { table {
                thead { tr { @for head in self.head() { th scope="col" { (head) } } } }
                tbody { @for (axis, row) in self.axes.iter().zip(&self.cross_talk_percent) { tr {
                    th scope="row" { (axis.axis.to_string()) }
                    @for value in row { td style=(shade(*value)) { (cell(*value)) } }
                } } }
            } }
        });
    }

    /// Creep, what terms of higher order are worth, lines of action, and contact points.
    fn places(&self, page: &mut Page) {
        if let Some(creep) = &self.creep {
            page.heading("Creep");
            page.push(&html! { @for line in creep.to_string().lines() { p { (line) "." } } });
        }
        if let Some(curve) = &self.curve {
            page.heading("Curvature");
            page.push(&html! { p { (curve.to_string()) "." } });
        }
        if self.lines.is_some() || self.contacts.is_some() {
            page.heading("Where touches are found");
        }
        let mm = |value: f64| format!("{value:.3}\u{a0}mm");
        if let Some(lines) = &self.lines {
            page.push(&html! {
                p {
                    "Lines of action of the " (lines.lines) " pure forces of these loads: off by "
                    b { (mm(lines.median_mm)) } " in the median"
                    @if let Some(expected) = lines.expected_mm {
                        " (" (mm(expected)) " expected of the covariance)"
                    }
                    ", " (mm(lines.greatest_mm)) " at most."
                }
            });
        }
        if let Some(contacts) = &self.contacts {
            page.push(&html! {
                p {
                    "Contact points on " (contacts.surface) " under " (format!("{:.3}", contacts.force))
                    "\u{a0}N, expected of the covariance (" (contacts.touches) " touches all over it): off by "
                    b { (mm(contacts.together_mm)) } " (root mean square), " (mm(contacts.worst_mm))
                    " where it is worst. Of that, " (mm(contacts.calibration_mm))
                    " come of the matrix, which no averaging mends, and " (mm(contacts.reading_mm))
                    " of the noise of one reading."
                }
            });
        }
    }

    fn deviations(&self, page: &mut Page) {
        let (Some(matrix), Some(deviations)) = (&self.matrix, &self.matrix_deviations) else { return };
        page.heading("The matrix");
        page.small(
            "Signal of each gauge (row) under the full scale of each axis (column), and its standard deviation.",
        );
        let row = |(gauge, (row, spread)): (usize, (&Vec<f64>, &Vec<f64>))| {
            let cell = |(value, deviation): (&f64, &f64)| {
                let digits = digits(*deviation, 2);
                format!("{value:.digits$} ±\u{a0}{deviation:.digits$}")
            };
            let cells = row.iter().zip(spread).map(cell);
            core::iter::once(format!("gauge\u{a0}{}", gauge + 1)).chain(cells).collect::<Vec<_>>()
        };
        let rows: Vec<_> = matrix.iter().zip(deviations).enumerate().map(row).collect();
        page.table(&Table { title: "", head: &self.head(), rows: &rows, words: false });
    }

    fn plots(&self, page: &mut Page) {
        page.heading("Plots");
        page.figures(
            (0..self.axes.len())
                .flat_map(|axis| self.error_over_load(axis).into_iter().chain(self.error_over_samples(axis))),
        );
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
