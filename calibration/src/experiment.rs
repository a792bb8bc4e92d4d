//! Which load to apply next, and how many are enough.

use nalgebra::{DMatrix, DVector};

use crate::fit::FitError;
use crate::linear::Triangular;

/// How much a fit knows: `(Σ x xᵀ)` of the loads so far, with and without bias, kept as its inverse.
///
/// Loads are in nominal loads. The D-optimal next load maximises `det(M + x xᵀ) = det M (1 + xᵀM⁻¹x)`
/// (Wald 1943; Fedorov 1972): it is the one about whose signals the fit knows least. A small
/// multiple of the identity (10⁻⁶) makes the beginning well defined, where loads that add a new direction
/// come first.
///
/// ```
/// use fingertip_calibration::experiment::Information;
///
/// // Two axes, in nominal loads, zeros known; each was loaded, the first twice as strongly.
/// let mut information = Information::new(2, false);
/// assert!(information.add(&[1.0, 0.0]) && information.add(&[0.0, 0.5]));
/// // The variance of a signal: that of one reading on the first axis, four times as much on the second.
/// let variance = |load| information.variance(load).ok_or("wrong length");
/// assert!((variance(&[1.0, 0.0])? - 1.0).abs() < 1e-4 && (variance(&[0.0, 1.0])? - 4.0).abs() < 1e-3);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Information {
    inverse: DMatrix<f64>,
    bias: bool,
}

/// What one more load would bring.
///
/// ```
/// use fingertip_calibration::experiment::{Gain, Information};
/// use fingertip_calibration::nalgebra::DMatrix;
///
/// let mut information = Information::new(2, false);
/// information.add(&[1.0, 0.0]);
/// // Again along the first axis, or along the second, which was never loaded?
/// let candidates = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 1.0]);
/// let ranked: Vec<Gain> = information.rank(&candidates);
/// assert_eq!([ranked[0].candidate, ranked[1].candidate], [1, 0]);
/// // The same load again doubles what is known along it.
/// assert!((ranked[1].log_determinant - 2.0_f64.ln()).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gain {
    /// Which of the candidates.
    pub candidate: usize,
    /// By how much the logarithm of the determinant of the information would grow: above about 10 the
    /// load opens a new direction.
    pub log_determinant: f64,
}

const BEGINNING: f64 = 1e-6;

impl Information {
    /// Of no loads yet.
    #[must_use]
    pub fn new(axes: usize, bias: bool) -> Self {
        let size = axes + usize::from(bias);
        Self { inverse: DMatrix::from_diagonal_element(size, size, 1.0 / BEGINNING), bias }
    }

    fn regressors(&self, load: &[f64]) -> Option<DVector<f64>> {
        let size = self.inverse.nrows();
        if load.len() + usize::from(self.bias) != size || load.iter().any(|x| !x.is_finite()) {
            return None;
        }
        Some(DVector::from_fn(size, |i, _| load.get(i).copied().unwrap_or(1.0)))
    }

    /// Adds a load (in nominal loads); `false` if it has the wrong length or is not finite.
    pub fn add(&mut self, load: &[f64]) -> bool {
        let Some(x) = self.regressors(load) else { return false };
        // Sherman & Morrison 1950; symmetric by construction.
        let y = &self.inverse * &x;
        let factor = 1.0 / (1.0 + x.dot(&y));
        self.inverse -= &y * y.transpose() * factor;
        true
    }

    /// All candidates (rows, in nominal loads) by what they would bring, the best first.
    #[must_use]
    pub fn rank(&self, candidates: &DMatrix<f64>) -> Vec<Gain> {
        let mut gains: Vec<Gain> = candidates
            .row_iter()
            .enumerate()
            .filter_map(|(candidate, row)| {
                let x = self.regressors(&row.iter().copied().collect::<Vec<_>>())?;
                Some(Gain { candidate, log_determinant: x.dot(&(&self.inverse * &x)).ln_1p() })
            })
            .collect();
        gains.sort_by(|a, b| b.log_determinant.total_cmp(&a.log_determinant));
        gains
    }

    /// Variance of the predicted signal at a load, in units of the variance of one reading: `xᵀM⁻¹x`.
    #[must_use]
    pub fn variance(&self, load: &[f64]) -> Option<f64> {
        let x = self.regressors(load)?;
        Some(x.dot(&(&self.inverse * &x)))
    }
}

/// A plan of loads that is good enough.
///
/// ```
/// use fingertip_calibration::experiment::{Plan, plan};
/// use fingertip_calibration::nalgebra::DMatrix;
///
/// // Weights along two axes, in nominal loads, zeros known.
/// let candidates = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 1.0]);
/// // The calibration shall add half the error of one reading at most: four loads on each axis.
/// let plan: Plan = plan(&candidates, false, 0.5, 100)?;
/// assert_eq!(plan.order.len(), 8);
/// assert_eq!(plan.order.iter().filter(|candidate| **candidate == 0).count(), 4);
/// # Ok::<(), fingertip_calibration::fit::FitError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Candidates in the order in which to apply them; one may stand several times.
    pub order: Vec<usize>,
    /// Standard deviation of the calibration's part of the error at the worst candidate, relative to the
    /// deviation of one reading, after each load; infinite while directions are open.
    pub deviation: Vec<f64>,
}

/// How many loads it takes until the calibration adds at most `accuracy` times the error of one reading
/// anywhere among the candidates (rows, in nominal loads): 0.5 makes the whole error 12 % larger than that of the
/// reading alone. Loads are chosen one by one, D-optimally.
///
/// To turn an accuracy in newtons into this ratio, divide by the standard deviation of one reading, in newtons,
/// which a rest recording gives.
///
/// # Errors
/// [`FitError::BadInput`] for an accuracy that is not positive or candidates that are not finite,
/// [`FitError::Unobserved`] if the candidates leave a direction open, [`FitError::TooFewSamples`] if
/// `most` loads are not enough.
pub fn plan(candidates: &DMatrix<f64>, bias: bool, accuracy: f64, most: usize) -> Result<Plan, FitError> {
    plan_after(&DMatrix::zeros(0, candidates.ncols()), candidates, bias, accuracy, most)
}

/// As [`plan`], with loads that were applied already (rows, in nominal loads).
///
/// # Errors
/// The same; also [`FitError::BadInput`] for loads of another number of axes.
pub fn plan_after(
    done: &DMatrix<f64>,
    candidates: &DMatrix<f64>,
    bias: bool,
    accuracy: f64,
    most: usize,
) -> Result<Plan, FitError> {
    if !(accuracy > 0.0) || candidates.is_empty() || candidates.iter().any(|x| !x.is_finite()) {
        return Err(FitError::BadInput { what: "the accuracy or the list of candidates" });
    }
    let rows: Vec<Vec<f64>> = candidates.row_iter().map(|row| row.iter().copied().collect()).collect();
    if done.ncols() != candidates.ncols() || done.iter().any(|x| !x.is_finite()) {
        return Err(FitError::BadInput { what: "the list of loads that were applied" });
    }
    let mut all = Triangular::new(candidates.ncols() + usize::from(bias), 0);
    for load in done.row_iter().chain(candidates.row_iter()) {
        let mut regressors: Vec<f64> = load.iter().copied().collect();
        regressors.extend(bias.then_some(1.0));
        all.push(&regressors, &[]);
    }
    all.factors().coefficients()?;
    let mut information = Information::new(candidates.ncols(), bias);
    for load in done.row_iter() {
        information.add(&load.iter().copied().collect::<Vec<_>>());
    }
    let mut result = Plan { order: Vec::new(), deviation: Vec::new() };
    while result.order.len() < most {
        let Some(best) = information.rank(candidates).first().copied() else { break };
        information.add(&rows[best.candidate]);
        result.order.push(best.candidate);
        let worst = rows.iter().filter_map(|row| information.variance(row)).fold(0.0, f64::max);
        // While a direction is open, its variance is that of the beginning.
        let determined = done.nrows() + result.order.len() >= candidates.ncols() + usize::from(bias)
            && worst < 1e-3 / BEGINNING;
        result.deviation.push(if determined { worst.sqrt() } else { f64::INFINITY });
        if determined && worst.sqrt() <= accuracy {
            return Ok(result);
        }
    }
    Err(FitError::TooFewSamples { samples: most, coefficients: candidates.ncols() + usize::from(bias) })
}

#[cfg(test)]
mod tests {
    use super::{Information, plan, plan_after};
    use crate::fit::FitError;
    use crate::fit::testing::gaussian_matrix;
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    #[test]
    fn gain_is_that_of_the_determinant() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        let loads = gaussian_matrix(&mut random, 12, 3);
        let candidates = gaussian_matrix(&mut random, 5, 3);
        let mut information = Information::new(3, true);
        let mut gram = DMatrix::identity(4, 4) * 1e-6;
        for row in loads.row_iter() {
            assert!(information.add(row.transpose().as_slice()));
            let x = row.transpose().insert_row(3, 1.0);
            gram += &x * x.transpose();
        }
        for gain in information.rank(&candidates) {
            let x = candidates.row(gain.candidate).transpose().insert_row(3, 1.0);
            let grown = (&gram + &x * x.transpose()).determinant() / gram.determinant();
            assert!((gain.log_determinant - grown.ln()).abs() < 1e-8);
        }
        assert!(!information.add(&[1.0]) && !information.add(&[f64::NAN, 0.0, 0.0]));
    }

    #[test]
    fn plan_covers_all_axes_first_and_reaches_its_accuracy() {
        // Pure loads of each axis, up and down, and a weak one that is never worth it.
        let mut candidates = DMatrix::zeros(13, 6);
        for j in 0..6 {
            candidates[(2 * j, j)] = 1.0;
            candidates[(2 * j + 1, j)] = -1.0;
        }
        candidates[(12, 0)] = 0.1;
        let plan = plan(&candidates, false, 0.5, 200).unwrap();
        // Each axis needs 1/0.25 = 4 loads.
        assert_eq!(plan.order.len(), 24);
        assert!(!plan.order.contains(&12));
        let mut first: Vec<usize> = plan.order[..6].iter().map(|candidate| candidate / 2).collect();
        first.sort_unstable();
        assert_eq!(first, [0, 1, 2, 3, 4, 5]);
        assert!(plan.deviation[4].is_infinite() && (plan.deviation[5] - 1.0).abs() < 1e-5);
        let never = candidates.columns(0, 5).into_owned().insert_column(5, 0.0);
        assert!(matches!(super::plan(&never, true, 0.5, 200), Err(FitError::Unobserved(_))));
        // What was done need not be done again.
        let done = candidates.select_rows(&plan.order[..20]);
        assert_eq!(plan_after(&done, &candidates, false, 0.5, 200).unwrap().order.len(), 4);
        assert!(plan_after(&done.columns(0, 5).into_owned(), &candidates, false, 0.5, 200).is_err());
        let blind = candidates.rows(0, 4).into_owned();
        assert!(super::plan(&blind, true, 1e-9, 50).is_err());
    }
}
