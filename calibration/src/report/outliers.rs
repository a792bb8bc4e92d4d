//! Samples that do not belong.

use core::fmt;

use nalgebra::DMatrix;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF as _, StudentsT};

use super::residuals::Residuals;
use crate::fit::Fit;
use crate::loads::Names;

/// A sample that does not fit the others.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// # let mut table = table;
/// use fingertip_calibration::report::Outlier;
/// use fingertip_calibration::{calibrate, model::Options};
///
/// // A reading that is off by 20 mV among others that scatter by 1 mV.
/// table.signals[(30, 0)] += 0.02;
/// let outliers: Vec<Outlier> = calibrate(&table, &Options::default())?.report.outliers;
/// let [outlier] = &outliers[..] else { return Err("not one".into()) };
/// assert!(outlier.index == 30 && outlier.deviations.abs() > 10.0 && outlier.chance < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
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
    names: &Names,
    labels: &[String],
) -> Vec<Outlier> {
    outliers_of_fit(design, responses, weights, None, names, labels)
}

/// As [`outliers`], with the least-squares fit of all samples where that is known.
pub(crate) fn outliers_of_fit(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    weights: Option<&[f64]>,
    fit: Option<&Fit>,
    names: &Names,
    labels: &[String],
) -> Vec<Outlier> {
    let counts = |i: &usize| weights.is_none_or(|w| w[*i] > 0.0);
    let left: Vec<usize> = (0..design.nrows()).filter(counts).collect();
    let most = (left.len() / 5).min(MOST);
    // Samples that do not count are not among those that are fitted here.
    let first = match fit.filter(|_| left.len() == design.nrows()) {
        Some(fit) => Residuals::of_fit(design, responses, weights, fit),
        None => Residuals::of(design, responses, weights, left),
    };
    let Some(mut residuals) = first else { return Vec::new() };
    let mut found = Vec::new();
    let mut significant = 0;
    while found.len() < most {
        let Some((row, response, t)) = residuals.most_extreme() else { break };
        if !residuals.is_sure_of(t) {
            let left = residuals.remaining();
            let Some(anew) = Residuals::of(design, responses, weights, left) else { break };
            residuals = anew;
            continue;
        }
        let Ok(student) = StudentsT::new(0.0, 1.0, residuals.freedom() - 1.0) else { break };
        let trials = (residuals.left() * responses.ncols()) as f64;
        let chance = (2.0 * student.sf(t.abs()) * trials).min(1.0);
        let index = residuals.sample(row);
        found.push(Outlier {
            index,
            sample: names.get(index).into_owned(),
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

#[cfg(test)]
mod tests {
    use alloc::borrow::Cow;

    use super::outliers;
    use crate::fit::testing::{gaussian_matrix, sensor};
    use crate::loads::Names;
    use rand::SeedableRng as _;

    fn names(count: usize) -> Names {
        Names::numbered("row", 0..count as u64)
    }

    fn labels(count: usize) -> Vec<String> {
        names(count).iter().map(Cow::into_owned).collect()
    }

    #[test]
    fn pure_noise_is_rarely_accused() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        let mut accused = 0;
        for _ in 0..400 {
            let design = gaussian_matrix(&mut random, 40, 6);
            let responses = &design * sensor(&mut random, 6, 6) + gaussian_matrix(&mut random, 40, 6);
            accused += usize::from(!outliers(&design, &responses, None, &names(40), &labels(6)).is_empty());
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
            let found = outliers(&design, &responses, None, &names(40), &labels(6));
            let mut rows: Vec<usize> = found.iter().map(|outlier| outlier.index).collect();
            rows.sort_unstable();
            assert_eq!(rows, [3, 17, 29]);
            assert_eq!((found[0].response.as_str(), &found[0].sample[..4]), ("row 4", "row "));
        }
    }

    /// Of many samples, too, the outliers are those that fitting anew finds, and are found in the same order.
    #[test]
    fn outliers_among_many_are_those_among_all() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(9);
        let design = gaussian_matrix(&mut random, 20_000, 4);
        let mut responses = &design * sensor(&mut random, 4, 3) + gaussian_matrix(&mut random, 20_000, 3);
        let put = [(5, 0, 20.0), (777, 1, 300.0), (19_999, 2, -9.0), (12_345, 1, 11.0)];
        for (row, column, size) in put {
            responses[(row, column)] += size;
        }
        let found = outliers(&design, &responses, None, &names(20_000), &labels(3));
        let rows: Vec<usize> = found.iter().map(|outlier| outlier.index).collect();
        assert_eq!(rows, [777, 5, 12_345, 19_999]);
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
        let found = |columns| {
            outliers(&loads.columns(0, columns).into_owned(), &signals, None, &names(5), &labels(1))
        };
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
        assert!(outliers(&design, &responses, None, &names(40), &labels(6)).is_empty());
    }

    /// Samples of weight zero are no samples: what is said of the others is as if they were not there.
    #[test]
    fn samples_that_do_not_count_change_nothing() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(5);
        let design = gaussian_matrix(&mut random, 26, 3);
        let mut responses = &design * sensor(&mut random, 3, 2) + gaussian_matrix(&mut random, 26, 2) * 0.01;
        for (i, size) in [(2, 1.0), (5, -0.8), (7, 0.5)] {
            responses[(i, 1)] += size;
        }
        // Three in eleven stand out, of which two are looked for.
        let weights: Vec<f64> = (0..26).map(|i| if i < 11 { 1.0 } else { 0.0 }).collect();
        let found = outliers(&design, &responses, Some(&weights), &names(26), &labels(2));
        let alone =
            outliers(&design.rows(0, 11).into(), &responses.rows(0, 11).into(), None, &names(11), &labels(2));
        assert!(alone.len() <= 2);
        assert_eq!(found.len(), alone.len());
        for (found, alone) in found.iter().zip(&alone) {
            assert_eq!((found.index, &found.sample), (alone.index, &alone.sample));
            assert!((found.deviations / alone.deviations - 1.0).abs() < 1e-9, "{found:?} {alone:?}");
        }
        // One that stands out in so few is found so, too.
        responses[(5, 1)] += 0.8;
        responses[(7, 1)] -= 0.5;
        let found = outliers(&design, &responses, Some(&weights), &names(26), &labels(2));
        assert_eq!(found.iter().map(|outlier| outlier.index).collect::<Vec<_>>(), [2]);
        let alone =
            outliers(&design.rows(0, 11).into(), &responses.rows(0, 11).into(), None, &names(11), &labels(2));
        assert!((found[0].deviations / alone[0].deviations - 1.0).abs() < 1e-9, "{found:?} {alone:?}");
        assert!((found[0].chance / alone[0].chance - 1.0).abs() < 1e-6, "{found:?} {alone:?}");
    }
}
