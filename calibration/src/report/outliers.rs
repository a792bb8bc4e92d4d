//! Samples that do not belong.

use core::fmt;

use nalgebra::{DMatrix, DVector};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF as _, StudentsT};

use crate::fit::least_squares;

/// A sample that does not fit the others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outlier {
    /// Position in the table that was fitted.
    pub index: usize,
    /// What the sample is called.
    pub sample: String,
    /// In which gauge or axis it stands out most.
    pub response: String,
    /// Its residual over the standard deviation of the others (externally studentised).
    pub deviations: f64,
    /// How many samples and responses of pure Gaussian noise would show one as large: 0.01 or less, or more
    /// for one that stands out only once those after it in the list are out of the way.
    pub chance: f64,
}

impl fmt::Display for Outlier {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "outlier: {} is off by {:.1} standard deviations of the others",
            self.response, self.deviations
        )?;
        if self.chance < LEVEL { write!(formatter, " (chance {:.0e})", self.chance) } else { Ok(()) }
    }
}

/// Chance of naming any sample of a table of pure Gaussian noise.
const LEVEL: f64 = 0.01;

/// The most outliers that are looked for, within a fifth of the samples.
const MOST: usize = 30;

/// Rosner's generalised test (1983) with externally studentised residuals of a least-squares fit:
/// the most extreme sample is taken out, then the next, and the last one that is still
/// extreme (Bonferroni, 1 % over the whole table) decides how many are named, so that two of them
/// cannot hide each other.
#[must_use]
pub fn outliers(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    weights: Option<&[f64]>,
    names: &[String],
    labels: &[String],
) -> Vec<Outlier> {
    let counts = |i: &usize| weights.is_none_or(|w| w[*i] > 0.0);
    let left: Vec<usize> = (0..design.nrows()).filter(counts).collect();
    let most = (left.len() / 5).min(MOST);
    let Some(mut residuals) = Residuals::of(design, responses, weights, left) else { return Vec::new() };
    let mut found = Vec::new();
    let mut significant = 0;
    while found.len() < most {
        let Some((row, response, t)) = residuals.most_extreme() else { break };
        let Ok(student) = StudentsT::new(0.0, 1.0, residuals.freedom() - 1.0) else { break };
        let trials = (residuals.left() * responses.ncols()) as f64;
        let chance = (2.0 * student.sf(t.abs()) * trials).min(1.0);
        let index = residuals.rows[row];
        found.push(Outlier {
            index,
            sample: names.get(index).cloned().unwrap_or_else(|| format!("sample {}", index + 1)),
            response: labels.get(response).cloned().unwrap_or_else(|| format!("response {response}")),
            deviations: t.abs(),
            chance,
        });
        if chance < LEVEL {
            significant = found.len();
        }
        if !residuals.remove(row) {
            // What is left of the numbers is rounding: from the start, without those that are out.
            let left = residuals.remaining();
            let Some(anew) = Residuals::of(design, responses, weights, left) else { break };
            residuals = anew;
        }
    }
    found.truncate(significant);
    found
}

/// Removing a sample whose residual is so many deviations of the others leaves rounding in theirs.
const OUTSHINES: f64 = 1e8;
/// Nor can a sample be taken out of a fit that so little but itself determines.
const LEAST_FREE: f64 = 1e-6;

/// The residuals of a least-squares fit, of which samples can be taken out one after the other: as fitting anew does, by
/// the deletion formulas of Cook & Weisberg 1982.
struct Residuals {
    /// Which samples of the table these are.
    rows: Vec<usize>,
    is_out: Vec<bool>,
    out: usize,
    /// Rows of the design and residuals, each times the root of its weight.
    design: DMatrix<f64>,
    residuals: DMatrix<f64>,
    /// How much a sample determines its own prediction, from 0 to 1.
    leverage: DVector<f64>,
    inverse_gram: DMatrix<f64>,
    /// What rounding leaves of an exact fit, for each response.
    floors: Vec<f64>,
}

impl Residuals {
    fn of(
        design: &DMatrix<f64>,
        responses: &DMatrix<f64>,
        weights: Option<&[f64]>,
        rows: Vec<usize>,
    ) -> Option<Self> {
        if rows.len() < design.ncols() + 3 {
            return None;
        }
        let (mut x, y) = (design.select_rows(&rows), responses.select_rows(&rows));
        let kept: Option<Vec<f64>> = weights.map(|w| rows.iter().map(|i| w[*i]).collect());
        let fit = least_squares(&x, &y, kept.as_deref()).ok()?;
        let mut residuals = &y - &x * &fit.coefficients;
        for (row, weight) in kept.iter().flatten().enumerate() {
            x.row_mut(row).scale_mut(weight.sqrt());
            residuals.row_mut(row).scale_mut(weight.sqrt());
        }
        let leverage = (&x * &fit.inverse_gram).component_mul(&x).column_sum();
        let floors = y.column_iter().map(|column| f64::EPSILON * rows.len() as f64 * column.amax()).collect();
        let is_out = vec![false; rows.len()];
        let inverse_gram = fit.inverse_gram;
        Some(Self { rows, is_out, out: 0, design: x, residuals, leverage, inverse_gram, floors })
    }

    fn left(&self) -> usize {
        self.rows.len() - self.out
    }

    fn remaining(&self) -> Vec<usize> {
        self.rows.iter().zip(&self.is_out).filter(|(_, out)| !**out).map(|(row, _)| *row).collect()
    }

    fn freedom(&self) -> f64 {
        self.left() as f64 - self.design.ncols() as f64
    }

    /// Of a response, the variance of what is left.
    fn variance(&self, response: usize) -> f64 {
        let residuals = self.residuals.column(response);
        let squares = residuals.iter().zip(&self.is_out);
        squares.map(|(x, out)| if *out { 0.0 } else { x * x }).sum::<f64>() / self.freedom()
    }

    /// Row, response and externally studentised residual of the sample that stands out most.
    fn most_extreme(&self) -> Option<(usize, usize, f64)> {
        if self.left() < self.design.ncols() + 3 {
            return None;
        }
        let freedom = self.freedom();
        let mut best: Option<(usize, usize, f64)> = None;
        for (j, floor) in self.floors.iter().enumerate() {
            let variance = self.variance(j);
            if !(variance.sqrt() > *floor) {
                continue;
            }
            for (i, residual) in self.residuals.column(j).iter().enumerate() {
                let free = 1.0 - self.leverage[i];
                if self.is_out[i] || !(free > 1e-9) {
                    continue;
                }
                let internal = residual / (variance * free).sqrt();
                let rest = (freedom - internal * internal).max(f64::MIN_POSITIVE);
                let external = internal * ((freedom - 1.0) / rest).sqrt();
                if best.is_none_or(|(_, _, t)| external.abs() > t.abs()) {
                    best = Some((i, j, external));
                }
            }
        }
        best
    }

    /// Takes a sample out; `false` if the others would be left with rounding and must be fitted anew.
    fn remove(&mut self, row: usize) -> bool {
        let free = 1.0 - self.leverage[row];
        let direction = &self.inverse_gram * self.design.row(row).transpose();
        let shared = &self.design * &direction / free;
        self.leverage += shared.component_mul(&shared) * free;
        self.inverse_gram += &direction * direction.transpose() / free;
        let own = self.residuals.row(row).into_owned();
        self.residuals.ger(1.0, &shared, &own.transpose(), 1.0);
        self.is_out[row] = true;
        self.out += 1;
        free > LEAST_FREE
            && (0..own.len())
                .all(|j| own[j].abs() <= OUTSHINES * (self.variance(j) * free).sqrt().max(self.floors[j]))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::{MOST, Residuals, outliers};
    use crate::fit::least_squares;
    use crate::fit::testing::{gaussian_matrix, sensor};
    use rand::SeedableRng as _;

    fn names(count: usize) -> Vec<String> {
        (0..count).map(|i| format!("row {i}")).collect()
    }

    /// As said: by fitting anew without those that are out.
    fn by_fitting_anew(x: &DMatrix<f64>, y: &DMatrix<f64>, weights: &[f64]) -> Vec<(usize, usize, f64)> {
        let mut left: Vec<usize> = (0..x.nrows()).collect();
        let mut order = Vec::new();
        for _ in 0..(x.nrows() / 5).min(MOST) {
            let of = |matrix: &DMatrix<f64>| matrix.select_rows(&left);
            let kept: Vec<f64> = left.iter().map(|i| weights[*i]).collect();
            let fit = least_squares(&of(x), &of(y), Some(&kept)).unwrap();
            let residuals = of(y) - of(x) * &fit.coefficients;
            let freedom = (left.len() - x.ncols()) as f64;
            let mut best = (0, 0, 0.0_f64);
            for (place, i) in left.iter().enumerate() {
                let leverage = weights[*i] * (x.row(*i) * &fit.inverse_gram * x.row(*i).transpose())[(0, 0)];
                for j in 0..y.ncols() {
                    let scale = (fit.residual_covariance[(j, j)] * (1.0 - leverage)).sqrt();
                    let internal = residuals[(place, j)] * weights[*i].sqrt() / scale;
                    let rest = (freedom - internal * internal).max(f64::MIN_POSITIVE);
                    let external = internal * ((freedom - 1.0) / rest).sqrt();
                    if external.abs() > best.2 {
                        best = (*i, j, external.abs());
                    }
                }
            }
            left.retain(|i| *i != best.0);
            order.push(best);
        }
        order
    }

    #[test]
    fn taking_out_is_fitting_anew() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(6);
        // Ever larger outliers, up to those that outshine the others.
        for size in [0.0, 10.0, 1e4, 1e9, 1e13] {
            let mut design = gaussian_matrix(&mut random, 60, 4);
            // One that its own prediction depends on, nearly.
            design.row_mut(7).scale_mut(1e3);
            let mut responses = &design * sensor(&mut random, 4, 3) + gaussian_matrix(&mut random, 60, 3);
            responses[(20, 1)] += size;
            responses[(31, 1)] -= 0.5 * size;
            let weights: Vec<f64> = (0..60).map(|i| 0.5 + f64::from(i % 3)).collect();
            let expected = by_fitting_anew(&design, &responses, &weights);
            let mut residuals =
                Residuals::of(&design, &responses, Some(&weights), (0..60).collect()).unwrap();
            for (index, response, t) in expected {
                let (row, found_response, found) = residuals.most_extreme().unwrap();
                assert_eq!((residuals.rows[row], found_response), (index, response), "{size}");
                // One that is the whole deviation has a residual of rounding beside it.
                let alike = (found.abs() / t - 1.0).abs() < 1e-6 || (found.abs() > 1e6 && t > 1e6);
                assert!(alike, "{size}: {found} for {t}");
                if !residuals.remove(row) {
                    let left = residuals.remaining();
                    residuals = Residuals::of(&design, &responses, Some(&weights), left).unwrap();
                }
            }
        }
    }

    #[test]
    fn pure_noise_is_rarely_accused() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        let mut accused = 0;
        for _ in 0..400 {
            let design = gaussian_matrix(&mut random, 40, 6);
            let responses = &design * sensor(&mut random, 6, 6) + gaussian_matrix(&mut random, 40, 6);
            accused += usize::from(!outliers(&design, &responses, None, &names(40), &names(6)).is_empty());
        }
        // 4 expected; 12 would be four standard deviations off.
        assert!(accused <= 12, "{accused}");
    }

    #[test]
    fn twins_do_not_hide_each_other() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(2);
        for _ in 0..50 {
            let design = gaussian_matrix(&mut random, 40, 6);
            let mut responses =
                &design * sensor(&mut random, 6, 6) + gaussian_matrix(&mut random, 40, 6) * 0.01;
            for i in [3, 17, 29] {
                responses[(i, 4)] += 1.0;
            }
            let found = outliers(&design, &responses, None, &names(40), &names(6));
            let mut rows: Vec<usize> = found.iter().map(|outlier| outlier.index).collect();
            rows.sort_unstable();
            assert_eq!(rows, [3, 17, 29]);
            assert_eq!((found[0].response.as_str(), &found[0].sample[..4]), ("row 4", "row "));
        }
    }

    /// Five readings on a line through zero and a constant: the least that can tell one of them apart.
    #[test]
    fn five_samples_can_tell_an_outlier_of_a_line() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(4);
        let mut loads = gaussian_matrix(&mut random, 5, 3);
        loads.column_mut(1).fill(1.0);
        let mut signals =
            loads.columns(0, 2) * sensor(&mut random, 2, 1) + gaussian_matrix(&mut random, 5, 1) * 1e-6;
        signals[(3, 0)] += 1.0;
        let found =
            |columns| outliers(&loads.columns(0, columns).into_owned(), &signals, None, &names(5), &names(1));
        let line = found(2);
        assert_eq!(line.iter().map(|outlier| outlier.index).collect::<Vec<_>>(), [3]);
        // Two degrees of freedom less one, of the other four: Student's tail is 1/(2 t²) there, of either side, and
        // five readings were tried.
        let expected = 5.0 / line[0].deviations.powi(2);
        assert!(line[0].deviations > 1e3 && line[0].chance < 3.0 * expected, "{:?}", line[0]);
        assert!(found(3).is_empty());
    }

    #[test]
    fn exact_data_have_none() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
        let design = gaussian_matrix(&mut random, 40, 6);
        let responses = &design * sensor(&mut random, 6, 6);
        assert!(outliers(&design, &responses, None, &names(40), &names(6)).is_empty());
    }
}
