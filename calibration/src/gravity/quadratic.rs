//! Forms of what a fit to poses leaves.

use nalgebra::{DMatrix, DVector, Matrix6};

use super::products::Derivatives;

/// Symmetric 6×6 matrices as vectors whose scalar product is that of the matrices, the trace of their product.
pub(super) struct Symmetric;

impl Symmetric {
    const PLACES: usize = 21;

    fn places() -> impl Iterator<Item = (usize, usize)> {
        (0..6).flat_map(|a| (0..=a).map(move |b| (a, b)))
    }

    fn factor(a: usize, b: usize) -> f64 {
        if a == b { 1.0 } else { core::f64::consts::SQRT_2 }
    }

    fn vector(of: &Matrix6<f64>) -> DVector<f64> {
        DVector::from_iterator(Self::PLACES, Self::places().map(|(a, b)| of[(a, b)] * Self::factor(a, b)))
    }

    fn whole(vector: &DVector<f64>) -> Matrix6<f64> {
        let mut of = Matrix6::zeros();
        for ((a, b), value) in Self::places().zip(vector.iter()) {
            (of[(a, b)], of[(b, a)]) = (value / Self::factor(a, b), value / Self::factor(a, b));
        }
        of
    }

    /// The matrix of a linear map among them.
    pub(super) fn matrix_of(map: impl Fn(&Matrix6<f64>) -> Matrix6<f64>) -> DMatrix<f64> {
        let columns: Vec<_> = (0..Self::PLACES)
            .map(|i| {
                let mut unit = DVector::zeros(Self::PLACES);
                unit[i] = 1.0;
                Self::vector(&map(&Self::whole(&unit)))
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    /// What the map with this matrix makes of one.
    pub(super) fn applied(map: &DMatrix<f64>, to: &Matrix6<f64>) -> Matrix6<f64> {
        Self::whole(&(map * Self::vector(to)))
    }
}

/// Variance of `Σ_i r_iᵀ B r_i` of what is left, `r_i = e_i − D_i Σ_j P_jᵀ e_j`, of normal errors with the covariance Σ:
/// `2 tr((W Σ)²)` (Searle 1971), where `W = B + U N Uᵀ` over all poses, `U_i = (P_i, B D_i)`,
/// `N = ((Σ D_iᵀ B D_i, −1), (−1, 0))`, so that nothing larger than twice the parameters is multiplied.
pub(super) fn variance_of_form(form: &Matrix6<f64>, covariance: &Matrix6<f64>, of: &Derivatives) -> f64 {
    let size = of.moves.parameters();
    let mut inner = DMatrix::zeros(2 * size, 2 * size);
    inner.view_mut((0, 0), (size, size)).copy_from(&of.slopes.around(form));
    inner.view_mut((0, size), (size, size)).fill_diagonal(-1.0);
    inner.view_mut((size, 0), (size, size)).fill_diagonal(-1.0);
    // `Σ_i U_iᵀ F U_i`.
    let around = |middle: &Matrix6<f64>| {
        let across = of.across.around(&(middle * form));
        let mut both = DMatrix::zeros(2 * size, 2 * size);
        both.view_mut((0, 0), (size, size)).copy_from(&of.moves.around(middle));
        both.view_mut((0, size), (size, size)).copy_from(&across);
        both.view_mut((size, 0), (size, size)).copy_from(&across.transpose());
        both.view_mut((size, size), (size, size)).copy_from(&of.slopes.around(&(form * middle * form)));
        both
    };
    let of_form = form * covariance;
    let carried = &inner * around(covariance);
    let twice = &inner * around(&(covariance * of_form));
    let alone = of.poses * (of_form * of_form).trace();
    2.0 * (alone + 2.0 * twice.trace() + (&carried * &carried).trace())
}
