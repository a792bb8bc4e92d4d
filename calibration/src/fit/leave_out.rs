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
    for group in members.chunk_by(|a, b| a.0 == b.0) {
        let samples: Vec<usize> = group.iter().map(|(_, sample)| *sample).collect();
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
    Ok(())
}

/// `(I − QᵀQ)⁻¹ Qᵀ r`; `None` if the case was the only one to observe some direction.
fn solve(q: &DMatrix<f64>, residual: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let k = q.ncols();
    // The eigenvalues of I − QᵀQ lie in [0, 1]; one of rounding size means that nothing else observed a direction.
    let least = 1e3 * k as f64 * f64::EPSILON;
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
        // Cases of 1 to 9 samples, more than there are regressors.
        let cases: Vec<usize> = (0..40_usize).map(|i| i.isqrt()).collect();
        let fit = least_squares(&design, &responses, Some(&weights)).unwrap();
        let mut seen = 0;
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
        assert_eq!(seen, 40);
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
