//! Samples that do not belong.

use core::fmt;

use nalgebra::DMatrix;
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
    let (samples, k) = design.shape();
    let mut left: Vec<usize> = (0..samples).filter(|i| weights.is_none_or(|w| w[*i] > 0.0)).collect();
    let most = (left.len() / 5).min(MOST);
    let mut found = Vec::new();
    let mut significant = 0;
    for _ in 0..most {
        let (x, y) = (design.select_rows(&left), responses.select_rows(&left));
        let kept: Option<Vec<f64>> = weights.map(|w| left.iter().map(|i| w[*i]).collect());
        let Some((row, response, t)) = most_extreme(&x, &y, kept.as_deref()) else { break };
        let freedom = left.len() - k - 1;
        let Ok(student) = StudentsT::new(0.0, 1.0, freedom as f64) else { break };
        let trials = (left.len() * responses.ncols()) as f64;
        let chance = (2.0 * student.sf(t.abs()) * trials).min(1.0);
        let index = left.remove(row);
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
    }
    found.truncate(significant);
    found
}

/// Row, response and externally studentised residual of the sample that stands out most.
fn most_extreme(x: &DMatrix<f64>, y: &DMatrix<f64>, weights: Option<&[f64]>) -> Option<(usize, usize, f64)> {
    let (samples, k) = x.shape();
    if samples < k + 3 {
        return None;
    }
    let fit = least_squares(x, y, weights).ok()?;
    let residuals = y - x * &fit.coefficients;
    let freedom = (samples - k) as f64;
    // What rounding leaves of an exact fit is no deviation.
    let floors: Vec<f64> =
        y.column_iter().map(|column| f64::EPSILON * samples as f64 * column.amax()).collect();
    let mut best: Option<(usize, usize, f64)> = None;
    for i in 0..samples {
        let weight = weights.map_or(1.0, |w| w[i]);
        let leverage = weight * (x.row(i) * &fit.inverse_gram * x.row(i).transpose())[(0, 0)];
        let free = 1.0 - leverage;
        if !(free > 1e-9) {
            continue;
        }
        for j in 0..y.ncols() {
            let variance = fit.residual_covariance[(j, j)];
            if !(variance.sqrt() > floors[j]) {
                continue;
            }
            let internal = residuals[(i, j)] * weight.sqrt() / (variance * free).sqrt();
            let rest = (freedom - internal * internal).max(f64::MIN_POSITIVE);
            let external = internal * ((freedom - 1.0) / rest).sqrt();
            if best.is_none_or(|(_, _, t)| external.abs() > t.abs()) {
                best = Some((i, j, external));
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::outliers;
    use crate::fit::testing::{gaussian_matrix, sensor};
    use rand::SeedableRng as _;

    fn names(count: usize) -> Vec<String> {
        (0..count).map(|i| format!("row {i}")).collect()
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
