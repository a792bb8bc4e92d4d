//! The plots of a report, as drawings of a page.

use nalgebra::DMatrix;

use super::{LeftOut, Report};
use crate::page::{Axis, Chart, Figure};

/// Longer names of samples are cut.
const LONGEST_NAME: usize = 24;
/// Of the points in a square of so many units of the drawing one is drawn: a dot covers more.
const CELL: f64 = 2.0;
/// So many of them across and down are more than a drawing has.
const SIDE: usize = 256;

/// Classes of the style sheet: points of the fit, and those of loads that were left out of it.
const FITTED: &str = "a";
const LEFT_OUT: &str = "d";

impl Report {
    /// Error, % of full scale, over the applied load: points of the fit, and of the loads left out. `None` if there is no
    /// such axis, no sample, or a number that is not finite.
    #[must_use]
    pub fn error_over_load(&self, axis: usize) -> Option<Figure> {
        let report = self.axes.get(axis)?;
        let label = format!("{} / {}", report.axis, report.axis.unit());
        let applied = &self.details.applied;
        self.plot(axis, "error over load", &label, |sample| applied.get((sample, axis)).copied())
    }

    /// Error, % of full scale, in the order of the samples; `None` as of [`error_over_load`](Self::error_over_load).
    #[must_use]
    pub fn error_over_samples(&self, axis: usize) -> Option<Figure> {
        self.plot(axis, "error, sample after sample", "sample", |sample| Some(sample as f64 + 1.0))
    }

    fn plot(
        &self,
        axis: usize,
        what: &str,
        label: &str,
        position: impl Fn(usize) -> Option<f64>,
    ) -> Option<Figure> {
        let report = self.axes.get(axis)?;
        let samples = &self.details;
        let error = |said: f64, sample: usize| {
            Some(100.0 * (said - samples.applied.get((sample, axis))?) / report.full_scale)
        };
        let point = |sample: usize, said: &DMatrix<f64>| {
            Some((position(sample)?, error(*said.get((sample, axis))?, sample)?))
        };
        let fitted = (0..samples.len()).map(|sample| point(sample, &samples.measured));
        let fitted: Vec<(f64, f64)> = fitted.collect::<Option<_>>()?;
        let of_left_out = |left_out: &LeftOut| -> Vec<(f64, f64)> {
            let told = (0..samples.len()).filter(|sample| left_out.tells(*sample));
            told.filter_map(|sample| point(sample, left_out.loads())).collect()
        };
        let left_out = samples.left_out.as_ref().map_or_else(Vec::new, of_left_out);
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
        let title = format!("{}: {what}", report.axis);
        let x = Axis::linear(label, least - margin, most + margin);
        let mut chart = Chart::new(&title, x, Axis::linear("error / % of full scale", -error, error));
        chart.level("axis", 0.0);
        let (thin, thin_left_out) = (thinned(&chart, &fitted), thinned(&chart, &left_out));
        chart.squares(LEFT_OUT, &thin_left_out);
        chart.dots(FITTED, &thin);
        let others: Vec<(f64, f64)> = thin.iter().chain(&thin_left_out).copied().collect();
        chart.names(&self.outliers_of(&fitted), &others);
        let of_fit = if self.coefficients > 0 { "loads of the fit" } else { "these loads" };
        let mut keys = vec![("a spot", of_fit.to_owned())];
        if !left_out.is_empty() {
            keys.push(("d square", "the same loads, left out of the fit".to_owned()));
        }
        Some(Figure { title, svg: chart.finish(), keys, ..Figure::default() })
    }

    /// Name and place of the samples that do not fit the others, which plots label.
    fn outliers_of(&self, fitted: &[(f64, f64)]) -> Vec<(String, (f64, f64))> {
        let place = |outlier: &super::Outlier| {
            Some((shortened(&self.details.names.get(outlier.index)), *fitted.get(outlier.index)?))
        };
        self.outliers.iter().filter_map(place).collect()
    }
}

/// The points that are seen: of those that would lie over each other the one with the largest error. They come column by
/// column.
fn thinned(chart: &Chart, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within the side, and a NaN is 0"
    )]
    let cell = |place: f64| (place / CELL).clamp(0.0, SIDE as f64 - 1.0) as usize;
    // Number of the point that is kept in each, from 1 on.
    let mut kept = vec![0; SIDE * SIDE];
    for (number, point) in (1_usize..).zip(points) {
        let (across, down) = chart.place(*point);
        let Some(last) = kept.get_mut(cell(across) * SIDE + cell(down)) else { continue };
        let error_of = |number: usize| points.get(number.wrapping_sub(1)).map(|(_, error)| error.abs());
        if error_of(*last).is_none_or(|error| point.1.abs() > error) {
            *last = number;
        }
    }
    kept.into_iter().filter_map(|number| points.get(number.wrapping_sub(1)).copied()).collect()
}

/// A name that leaves room for others.
fn shortened(name: &str) -> String {
    match name.char_indices().nth(LONGEST_NAME) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use alloc::collections::BTreeMap;

    use rand::{RngExt, SeedableRng};

    use super::{CELL, thinned};
    use crate::page::{Axis, Chart};

    /// Against a map from cells to what is kept there, in the order of the cells; of equal errors the first stays.
    #[test]
    fn in_each_cell_stays_the_first_of_the_largest_errors() {
        let chart = Chart::new("", Axis::linear("", -1.0, 1.0), Axis::linear("", -1.0, 1.0));
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(7);
        for count in [0, 1, 2, 30, 5000, 60_000] {
            let mut number = || f64::from(random.random_range(-500..=500)) / 500.0;
            let points: Vec<(f64, f64)> = (0..count).map(|_| (number(), number())).collect();
            let mut expected: BTreeMap<(i64, i64), (f64, f64)> = BTreeMap::new();
            for (point, (across, down)) in points.iter().zip(chart.places(&points)) {
                let cell = ((across / CELL).floor() as i64, (down / CELL).floor() as i64);
                let kept = expected.entry(cell).or_insert(*point);
                if point.1.abs() > kept.1.abs() {
                    *kept = *point;
                }
            }
            assert_eq!(thinned(&chart, &points), Vec::from_iter(expected.into_values()), "{count}");
        }
    }

    /// A million points are as many as can be seen, the largest errors among them.
    #[test]
    fn points_are_thinned_to_those_that_are_seen() {
        let chart = Chart::new("", Axis::linear("", 0.0, 1e6), Axis::linear("", -1.0, 1.0));
        let mut points: Vec<(f64, f64)> =
            (0..1_000_000).map(|i| (f64::from(i), 0.1 * (f64::from(i) * 0.7).sin())).collect();
        points[123_456].1 = 0.9;
        points[654_321].1 = -0.8;
        let thin = thinned(&chart, &points);
        assert!((500..5000).contains(&thin.len()), "{}", thin.len());
        assert!(thin.contains(&points[123_456]) && thin.contains(&points[654_321]));
        // Nothing is seen where no point is, and every point has one within a cell.
        let cells: Vec<(f64, f64)> =
            chart.places(&thin).iter().map(|(x, y)| ((x / CELL).floor(), (y / CELL).floor())).collect();
        for (x, y) in chart.places(&points).iter().step_by(997) {
            assert!(cells.contains(&((x / CELL).floor(), (y / CELL).floor())));
        }
        let few = [(1.0, 0.5), (5e5, -0.5), (9e5, 0.0)];
        let mut thin = thinned(&chart, &few);
        thin.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(thin, few);
    }
}
