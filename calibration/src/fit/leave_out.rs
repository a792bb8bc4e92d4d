//! What a fit says of loads that it has not seen.

use nalgebra::DMatrix;

use super::regression::{accumulate, check};
use super::{Fit, FitError};

/// The coefficients with one load case left out of the fit after another.
///
/// By the matrix inversion lemma on the factors of the whole fit: with `Q = X_c R⁻¹` of the case,
/// `Θ₋c = Θ − R⁻¹ (I − QᵀQ)⁻¹ Qᵀ r_c` (the deletion formula of Cook & Weisberg 1982 for blocks), so that all
/// cases together cost about as much as one more fit. For a robust fit the weights are kept.
///
/// `visit` gets, for each case that occurs in `cases`, its number, the samples that belong to it,
/// and the coefficients without it: `None` if the other cases do not determine them.
///
/// # Errors
/// As [`super::least_squares`].
pub fn leave_out(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    weights: Option<&[f64]>,
    fit: &Fit,
    cases: &[usize],
    visit: impl FnMut(usize, &[usize], Option<&DMatrix<f64>>),
) -> Result<(), FitError> {
    leave_out_changes(design, responses, weights, fit, cases, |_, _| false, visit)
}

/// What leaving out one sample takes off the coefficients Θ of the whole fit: `pull · stepᵀ`.
pub(crate) struct Change<'a> {
    /// One for each regressor.
    pub(crate) pull: &'a [f64],
    /// One for each response.
    pub(crate) step: &'a [f64],
}

/// As [`leave_out`]; `one` is asked first for each case of one sample, with the change that it makes: `true` if that is enough,
/// so that the coefficients need not be made.
pub(crate) fn leave_out_changes(
    design: &DMatrix<f64>,
    responses: &DMatrix<f64>,
    weights: Option<&[f64]>,
    fit: &Fit,
    cases: &[usize],
    mut one: impl FnMut(usize, &Change<'_>) -> bool,
    mut visit: impl FnMut(usize, &[usize], Option<&DMatrix<f64>>),
) -> Result<(), FitError> {
    check(design, responses, weights)?;
    if cases.len() != design.nrows() || fit.trust.shape() != responses.shape() {
        return Err(FitError::BadInput { what: "the list of cases" });
    }
    let mut members: Vec<(usize, usize)> = cases.iter().copied().zip(0..).collect();
    members.sort_unstable();
    let alike = fit.trust.column_iter().all(|column| column == fit.trust.column(0));
    let responses_together: Vec<core::ops::Range<usize>> = if alike {
        core::iter::once(0..responses.ncols()).collect()
    } else {
        (0..responses.ncols()).map(|j| j..j + 1).collect()
    };
    // One factorisation where all responses trust the same samples, one each where they differ.
    let mut roots = Vec::new();
    for range in &responses_together {
        let weight = |i: usize| weights.map_or(1.0, |w| w[i]) * fit.trust[(i, range.start)];
        let root = accumulate(design, responses, weight).factors().inverse_root()?;
        roots.push(root);
    }
    let mut samples = Vec::new();
    let mut is_alone = vec![false; cases.len()];
    for group in members.chunk_by(|a, b| a.0 == b.0) {
        if let ([(_, sample)], [_]) = (group, roots.as_slice()) {
            is_alone[*sample] = true;
            continue;
        }
        samples.clear();
        samples.extend(group.iter().map(|(_, sample)| *sample));
        let mut without = fit.coefficients.clone();
        let mut determined = true;
        for (range, root) in responses_together.iter().zip(&roots) {
            let mut x = design.select_rows(&samples);
            let mut y = responses.select_rows(&samples).columns(range.start, range.len()).into_owned();
            for (row, i) in samples.iter().enumerate() {
                let factor = (weights.map_or(1.0, |w| w[*i]) * fit.trust[(*i, range.start)]).sqrt();
                x.row_mut(row).scale_mut(factor);
                y.row_mut(row).scale_mut(factor);
            }
            let theta = fit.coefficients.columns(range.start, range.len());
            let residual = y - &x * theta;
            let q = x * root;
            let Some(right) = solve(&q, &residual) else {
                determined = false;
                break;
            };
            let step = root * right;
            let mut target = without.columns_mut(range.start, range.len());
            target -= step;
        }
        visit(group[0].0, &samples, determined.then_some(&without));
    }
    // In their own order, so that a million of them are read as they lie in memory.
    let mut single = Single::new(fit);
    for sample in (0..cases.len()).filter(|sample| is_alone[*sample]) {
        let Some(root) = roots.first() else { break };
        let weight = weights.map_or(1.0, |w| w[sample]) * fit.trust[(sample, 0)];
        let change = single.change(design, responses, root, sample, weight.sqrt());
        if change.as_ref().is_none_or(|change| !one(sample, change)) {
            let is_determined = change.is_some();
            visit(cases[sample], &[sample], is_determined.then(|| single.without()));
        }
    }
    Ok(())
}

/// The coefficients without one sample, as most cases of a recording are: the same formula, in memory that is taken once.
struct Single<'a> {
    fit: &'a Fit,
    /// Of the sample: its row of the design, and `R⁻¹Qᵀ`.
    x: Vec<f64>,
    pull: Vec<f64>,
    /// `(I − QᵀQ)⁻¹ r`, one for each response.
    step: Vec<f64>,
    without: DMatrix<f64>,
}

impl<'a> Single<'a> {
    fn new(fit: &'a Fit) -> Self {
        let none = vec![0.0; fit.coefficients.nrows()];
        let step = vec![0.0; fit.coefficients.ncols()];
        Self { fit, x: none.clone(), pull: none, step, without: fit.coefficients.clone() }
    }

    /// With `root` = R⁻¹, which is upper triangular; `factor` is the root of the sample's weight. `None` if the other samples
    /// do not determine the fit.
    fn change(
        &mut self,
        design: &DMatrix<f64>,
        responses: &DMatrix<f64>,
        root: &DMatrix<f64>,
        sample: usize,
        factor: f64,
    ) -> Option<Change<'_>> {
        let Self { fit, x, pull, step, .. } = self;
        let k = x.len();
        x.iter_mut().zip(design.row(sample).iter()).for_each(|(slot, value)| *slot = value * factor);
        // Below the diagonal the root has zeros.
        let mut free = 1.0;
        pull.fill(0.0);
        for (rows, column) in (1..).zip(root.as_slice().chunks_exact(k)) {
            let q: f64 = x.iter().zip(column).take(rows).map(|(x, root)| x * root).sum();
            free -= q * q;
            pull.iter_mut().zip(column).take(rows).for_each(|(pull, root)| *pull += root * q);
        }
        if !(free > least_free(k)) {
            return None;
        }
        let known = fit.coefficients.as_slice().chunks_exact(k);
        for ((slot, theta), read) in step.iter_mut().zip(known).zip(responses.row(sample).iter()) {
            let said: f64 = x.iter().zip(theta).map(|(x, theta)| x * theta).sum();
            *slot = (read * factor - said) / free;
        }
        Some(Change { pull, step })
    }

    /// The coefficients without the sample whose change was asked for last.
    fn without(&mut self) -> &DMatrix<f64> {
        let Self { fit, pull, step, without, .. } = self;
        let k = pull.len().max(1);
        let known = fit.coefficients.as_slice().chunks_exact(k);
        let columns = without.as_mut_slice().chunks_exact_mut(k).zip(known);
        for ((column, theta), step) in columns.zip(step.iter()) {
            for ((slot, theta), pull) in column.iter_mut().zip(theta).zip(pull.iter()) {
                *slot = theta - pull * step;
            }
        }
        without
    }
}

/// The eigenvalues of I − QᵀQ lie in [0, 1]; one of rounding size means that nothing else observed a direction.
fn least_free(regressors: usize) -> f64 {
    1e3 * regressors as f64 * f64::EPSILON
}

/// `(I − QᵀQ)⁻¹ Qᵀ r`; `None` if the case was the only one to observe some direction.
fn solve(q: &DMatrix<f64>, residual: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let k = q.ncols();
    let least = least_free(k);
    if q.nrows() == 1 {
        let free = 1.0 - q.norm_squared();
        return (free > least).then(|| q.transpose() * residual / free);
    }
    let eigen = (DMatrix::identity(k, k) - q.transpose() * q).symmetric_eigen();
    if !(eigen.eigenvalues.min() > least) {
        return None;
    }
    let mut right = eigen.eigenvectors.transpose() * (q.transpose() * residual);
    for (mut row, value) in right.row_iter_mut().zip(eigen.eigenvalues.iter()) {
        row /= *value;
    }
    Some(eigen.eigenvectors * right)
}

#[cfg(test)]
mod tests {
    use super::leave_out;
    use crate::fit::least_squares;
    use crate::fit::testing::{gaussian_matrix, sensor};
    use crate::testing::Largest as _;
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    #[test]
    fn equals_fitting_anew() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(4);
        let design = gaussian_matrix(&mut random, 40, 6);
        let responses = &design * sensor(&mut random, 6, 5) + gaussian_matrix(&mut random, 40, 5);
        let weights: Vec<f64> = (0..40).map(|i| 0.5 + f64::from(i % 3)).collect();
        // Cases of 1 to 9 samples, more than there are regressors; and each sample for itself.
        let by_root: Vec<usize> = (0..40_usize).map(|i| i.isqrt()).collect();
        let fit = least_squares(&design, &responses, Some(&weights)).unwrap();
        let mut seen = 0;
        for cases in [by_root, (0..40).collect()] {
            leave_out(&design, &responses, Some(&weights), &fit, &cases, |case, samples, without| {
                let rest: Vec<usize> = (0..40).filter(|i| cases[*i] != case).collect();
                let weights: Vec<f64> = rest.iter().map(|i| weights[*i]).collect();
                let anew =
                    least_squares(&design.select_rows(&rest), &responses.select_rows(&rest), Some(&weights))
                        .unwrap();
                assert!((anew.coefficients - without.unwrap()).largest() < 1e-12);
                seen += samples.len();
            })
            .unwrap();
        }
        assert_eq!(seen, 80);
    }

    #[test]
    fn case_that_alone_observes_a_direction_is_found() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(4);
        let mut design = gaussian_matrix(&mut random, 20, 3);
        design.view_mut((1, 2), (19, 1)).fill(0.0);
        let responses = DMatrix::from_fn(20, 1, |i, _| i as f64);
        let fit = least_squares(&design, &responses, None).unwrap();
        let cases: Vec<usize> = (0..20).collect();
        leave_out(&design, &responses, None, &fit, &cases, |case, _, without| {
            assert_eq!(without.is_none(), case == 0);
        })
        .unwrap();
    }
}
