//! Random sensors and noise for the tests.

use nalgebra::DMatrix;
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64Mcg;

pub(crate) fn gaussian(random: &mut Pcg64Mcg) -> f64 {
    StandardNormal.sample(random)
}

pub(crate) fn gaussian_matrix(random: &mut Pcg64Mcg, rows: usize, columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(rows, columns, |_, _| gaussian(random))
}

/// Well-conditioned coefficients: the identity with some cross-talk.
pub(crate) fn sensor(random: &mut Pcg64Mcg, regressors: usize, responses: usize) -> DMatrix<f64> {
    DMatrix::from_fn(regressors, responses, |i, j| {
        (if i == j { 2.0 } else { 0.0 }) + 0.2 * gaussian(random).clamp(-2.0, 2.0)
    })
}
