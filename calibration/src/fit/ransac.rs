//! Least squares of the largest set of samples that agree.

use nalgebra::{DMatrix, DVector};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::regression::check;
use super::{Fit, FitError, least_squares};

/// What RANSAC needs to know.
///
/// ```
/// use fingertip_calibration::fit::{Ransac, ransac};
/// use fingertip_calibration::nalgebra::DMatrix;
///
/// // A gauge of 0.5 V and 0.1 V/N; every seventh reading is wrong by 2 V.
/// let design = DMatrix::from_fn(70, 2, |i, j| if j == 0 { 1.0 } else { (i % 10) as f64 });
/// let mut volts = &design * DMatrix::from_column_slice(2, 1, &[0.5, 0.1]);
/// volts.iter_mut().step_by(7).for_each(|volts| *volts += 2.0);
/// // Readings agree within 10 mV; a fifth may be wrong. Seven draws of two find two right ones in 999 of 1000 cases.
/// let options = Ransac::new(vec![0.01]);
/// assert_eq!(options.draws(2), 7);
/// let fit = ransac(&design, &volts, None, &options)?;
/// assert!((fit.coefficients[0] - 0.5).abs() < 1e-9 && (fit.coefficients[1] - 0.1).abs() < 1e-9);
/// assert_eq!(fit.trust[0], 0.0);
/// # Ok::<(), fingertip_calibration::fit::FitError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Ransac {
    /// Greatest residual of a good sample, per response (three to four standard deviations).
    pub thresholds: Vec<f64>,
    /// Share of bad samples that must still be survived; below one half.
    pub outliers: f64,
    /// Probability that at least one draw is free of bad samples.
    pub confidence: f64,
    /// Seed of the draws: the same seed gives the same answer.
    pub seed: u64,
}

impl Ransac {
    /// A fifth of the samples may be bad, confidence 99.9 %.
    #[must_use]
    pub fn new(thresholds: Vec<f64>) -> Self {
        Self { thresholds, outliers: 0.2, confidence: 0.999, seed: 1 }
    }

    /// How many draws of `size` samples it takes: `log(1−p) / log(1−(1−ε)^size)`
    /// (`docs/theory/calibration.md#robust-fits`; Fischler & Bolles 1981), at least 1 and at most 100 000.
    #[must_use]
    pub fn draws(&self, size: usize) -> usize {
        let clean = (1.0 - self.outliers.clamp(0.0, 0.9)).powi(i32::try_from(size).unwrap_or(i32::MAX));
        let failures = (-self.confidence.clamp(0.0, 1.0 - 1e-12)).ln_1p();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let draws = (failures / (-clean).ln_1p()).ceil().clamp(1.0, 1e5) as usize;
        draws
    }
}

/// Draws as many (linearly independent) samples as there are regressors, counts which others agree within the thresholds
/// in every response, and fits least squares to the largest set that agrees (Fischler & Bolles
/// 1981). Samples outside get trust 0. Samples of weight zero are none: they are not drawn, do not count, and keep
/// the trust 1.
///
/// # Errors
/// As [`least_squares`], and [`FitError::NoConsensus`] if fewer than `1 − outliers` of the samples
/// agree.
pub fn ransac(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    weights: Option<&[f64]>,
    options: &Ransac,
) -> Result<Fit, FitError> {
    check(design, responses, weights)?;
    let size = design.ncols();
    let counted: Vec<usize> =
        (0..design.nrows()).filter(|i| weights.is_none_or(|weights| weights[*i] > 0.0)).collect();
    let samples = counted.len();
    if options.thresholds.len() != responses.ncols() || options.thresholds.iter().any(|t| !(*t > 0.0)) {
        return Err(FitError::BadInput { what: "the list of thresholds" });
    }
    if samples <= size {
        return Err(FitError::TooFewSamples { samples, coefficients: size });
    }
    let agreeing = |coefficients: &DMatrix<f64>| -> Vec<usize> {
        let residuals = responses - design * coefficients;
        (counted.iter().copied())
            .filter(|i| residuals.row(*i).iter().zip(&options.thresholds).all(|(r, t)| r.abs() <= *t))
            .collect()
    };
    let mut random = Pcg64Mcg::seed_from_u64(options.seed);
    let mut equilibrated = design.clone();
    for mut column in equilibrated.column_iter_mut() {
        let norm = column.norm();
        if norm > 0.0 {
            column /= norm;
        }
    }
    let mut indices = counted.clone();
    let mut best: Vec<usize> = Vec::new();
    for _ in 0..options.draws(size) {
        let Some(drawn) = draw_independent(&equilibrated, &mut indices, &mut random) else { break };
        let Some(inverse) = design.select_rows(&drawn).full_piv_lu().try_inverse() else { continue };
        let set = agreeing(&(inverse * responses.select_rows(&drawn)));
        if set.len() > best.len() {
            best = set;
        }
    }
    // A draw of the least size is noisy; the set is settled by refitting to those who agree.
    for _ in 0..10 {
        if best.len() <= size {
            break;
        }
        let refit = fit_to(design, responses, weights, &best)?;
        let set = agreeing(&refit.coefficients);
        if set.len() <= best.len() {
            break;
        }
        best = set;
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let needed = (((1.0 - options.outliers) * samples as f64).ceil() as usize).max(size + 1);
    if best.len() < needed {
        return Err(FitError::NoConsensus { agreeing: best.len(), samples, needed });
    }
    let mut fit = fit_to(design, responses, weights, &best)?;
    fit.trust = DMatrix::from_element(design.nrows(), responses.ncols(), 1.0);
    for i in counted.into_iter().filter(|i| best.binary_search(i).is_err()) {
        fit.trust.row_mut(i).fill(0.0);
    }
    Ok(fit)
}

/// As many samples as regressors, drawn at random but linearly independent: loads of a rig come in few
/// directions, and most draws without this would be singular. `None` if there are not as many.
fn draw_independent(
    design: &DMatrix<f64>,
    indices: &mut [usize],
    random: &mut Pcg64Mcg,
) -> Option<Vec<usize>> {
    let size = design.ncols();
    let mut drawn = Vec::with_capacity(size);
    let mut basis: Vec<DVector<f64>> = Vec::with_capacity(size);
    // A Fisher-Yates shuffle, stopped when enough samples are drawn.
    for k in 0..indices.len() {
        let other = random.random_range(k..indices.len());
        indices.swap(k, other);
        let row: DVector<f64> = design.row(indices[k]).transpose();
        let length = row.norm();
        let mut rest = row;
        for direction in &basis {
            let along = rest.dot(direction);
            rest -= direction * along;
        }
        let left = rest.norm();
        if left > 1e-3 * length {
            basis.push(rest / left);
            drawn.push(indices[k]);
            if drawn.len() == size {
                return Some(drawn);
            }
        }
    }
    None
}

fn fit_to(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    weights: Option<&[f64]>,
    rows: &[usize],
) -> Result<Fit, FitError> {
    let weights: Option<Vec<f64>> = weights.map(|w| rows.iter().map(|i| w[*i]).collect());
    least_squares(&design.select_rows(rows), &responses.select_rows(rows), weights.as_deref())
}

#[cfg(test)]
mod tests {
    use super::{Ransac, ransac};
    use crate::fit::testing::{gaussian_matrix, sensor};
    use crate::fit::{FitError, least_squares};
    use crate::testing::Largest as _;
    use rand::SeedableRng as _;

    #[test]
    fn equals_the_fit_to_the_good_samples() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        for seed in 0..20 {
            let truth = sensor(&mut random, 6, 6);
            let design = gaussian_matrix(&mut random, 60, 6);
            let mut responses = &design * truth + gaussian_matrix(&mut random, 60, 6) * 0.01;
            let bad = |i: usize| i % 6 == 1;
            for i in (0..60).filter(|i| bad(*i)) {
                // All bad samples lie on one side, which no M-estimate likes.
                responses.row_mut(i).add_scalar_mut(5.0);
            }
            let options = Ransac { seed, ..Ransac::new(vec![0.05; 6]) };
            let fit = ransac(&design, &responses, None, &options).unwrap();
            let good: Vec<usize> = (0..60).filter(|i| !bad(*i)).collect();
            let clean =
                least_squares(&design.select_rows(&good), &responses.select_rows(&good), None).unwrap();
            assert!((fit.coefficients - clean.coefficients).largest() < 1e-12);
            assert!((0..60).all(|i| (fit.trust[(i, 0)] == 0.0) == bad(i)));
        }
    }

    #[test]
    fn draws_follow_the_formula_and_disagreement_is_an_error() {
        let options = Ransac { outliers: 0.5, confidence: 0.99, ..Ransac::new(vec![1e-6; 6]) };
        // ln(0.01) / ln(1 − 1/64) = 292.4.
        assert_eq!(options.draws(6), 293);
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        let (design, noise) = (gaussian_matrix(&mut random, 30, 6), gaussian_matrix(&mut random, 30, 6));
        assert!(matches!(ransac(&design, &noise, None, &options), Err(FitError::NoConsensus { .. })));
        // A draw agrees with itself; one more sample must, however many may be bad.
        let few = (design.view((0, 0), (4, 2)).into_owned(), noise.view((0, 0), (4, 1)).into_owned());
        let options = Ransac { outliers: 0.9, ..Ransac::new(vec![1e-9]) };
        let needs = FitError::NoConsensus { agreeing: 2, samples: 4, needed: 3 };
        assert_eq!(ransac(&few.0, &few.1, None, &options).unwrap_err(), needs);
    }
}
