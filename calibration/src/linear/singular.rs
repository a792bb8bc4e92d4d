//! Singular values and vectors of matrices of any size.

use fingertip_wrench::Real;
use fingertip_wrench::numeric::jacobi::{column_norm, orthogonalise};
use nalgebra::{DMatrix, DVector};

/// `A = U diag(σ) Vᵀ`, thin, σ from the largest to the smallest.
///
/// By [one-sided Jacobi rotations](fingertip_wrench::numeric::jacobi), which find small singular values of
/// matrices with badly scaled columns to high relative accuracy. We do not use nalgebra's `svd`, which gives
/// wrong vectors for some matrices (its issue 1172).
///
/// ```
/// use fingertip_calibration::linear::Singular;
/// use fingertip_calibration::nalgebra::DMatrix;
///
/// let singular = Singular::new(&DMatrix::from_row_slice(2, 2, &[0.0, 2.0, 8.0, 0.0])).ok_or("not finite")?;
/// assert!((singular.values[0] - 8.0).abs() < 1e-12 && (singular.values[1] - 2.0).abs() < 1e-12);
/// assert!((singular.condition_number() - 4.0).abs() < 1e-12 && singular.rank() == 2);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Singular {
    /// Left singular vectors, m × k with k = min(m, n); those of zero singular values are zero.
    pub left: DMatrix<f64>,
    /// Singular values, k of them.
    pub values: DVector<f64>,
    /// Right singular vectors, n × k, orthonormal if n ≤ m.
    pub right: DMatrix<f64>,
}

impl Singular {
    /// Decomposes a matrix; `None` if it is empty or has an entry that is not finite.
    #[must_use]
    pub fn new(matrix: &DMatrix<f64>) -> Option<Self> {
        if matrix.is_empty() || matrix.iter().any(|x| !x.is_finite()) {
            return None;
        }
        if matrix.nrows() < matrix.ncols() {
            let Self { left, values, right } = Self::new(&matrix.transpose())?;
            return Some(Self { left: right, values, right: left });
        }
        let scale = matrix.amax().normalising_factor();
        let mut left = matrix * scale;
        let columns = left.ncols();
        let mut right = DMatrix::identity(columns, columns);
        orthogonalise(&mut left, |turn, p, q| turn.apply(&mut right, p, q));
        let norms: Vec<f64> = (0..columns).map(|j| column_norm(&left, j)).collect();
        let mut order: Vec<usize> = (0..columns).collect();
        order.sort_by(|a, b| norms[*b].total_cmp(&norms[*a]));
        let values = DVector::from_iterator(columns, order.iter().map(|i| norms[*i] / scale));
        let left = DMatrix::from_fn(left.nrows(), columns, |i, j| {
            let norm = norms[order[j]];
            if norm > 0.0 { left[(i, order[j])] / norm } else { 0.0 }
        });
        let right = DMatrix::from_fn(columns, columns, |i, j| right[(i, order[j])]);
        Some(Self { left, values, right })
    }

    /// How many singular values exceed `max(m, n)·ε` times the largest: the usual numerical rank.
    #[must_use]
    pub fn rank(&self) -> usize {
        let size = self.left.nrows().max(self.right.nrows()) as f64;
        let least = self.values.max() * size * f64::EPSILON;
        self.values.iter().filter(|value| **value > least).count()
    }

    /// Largest over smallest singular value; infinite for a matrix of deficient rank.
    #[must_use]
    pub fn condition_number(&self) -> f64 {
        if self.rank() < self.values.len() { f64::INFINITY } else { self.values.max() / self.values.min() }
    }
}

/// As [`pseudo_inverse`], but for rounding, in a tenth of the time where the matrix is well conditioned: `R⁻¹ Qᵀ`.
#[must_use]
pub(crate) fn quick_inverse(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    /// Of six columns of unit norm whose parts across the others are larger, no singular value is below a millionth.
    const APART: f64 = 1e-3;
    let norms = DVector::from_iterator(matrix.ncols(), matrix.column_iter().map(|column| column.norm()));
    if matrix.nrows() < matrix.ncols() || matrix.ncols() > 6 || !norms.iter().all(|norm| *norm > 0.0) {
        return pseudo_inverse(matrix);
    }
    let qr = matrix.clone().qr();
    let right = qr.r();
    if !right.diagonal().iter().zip(&norms).all(|(part, norm)| part.abs() > APART * norm) {
        return pseudo_inverse(matrix);
    }
    right.solve_upper_triangular(&qr.q().transpose())
}

/// The Moore-Penrose inverse of a matrix of full rank; `None` if its rank is deficient or it has
/// an entry that is not finite.
///
/// Columns are brought to unit norm first where there are at most as many as rows, so that the
/// rank does not depend on units.
#[must_use]
pub fn pseudo_inverse(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    if matrix.nrows() < matrix.ncols() {
        return Some(pseudo_inverse(&matrix.transpose())?.transpose());
    }
    if matrix.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let norms: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
    if norms.iter().any(|norm| !(*norm > 0.0)) {
        return None;
    }
    let mut equilibrated = matrix.clone();
    for (mut column, norm) in equilibrated.column_iter_mut().zip(&norms) {
        column /= *norm;
    }
    let singular = Singular::new(&equilibrated)?;
    if singular.rank() < singular.values.len() {
        return None;
    }
    let mut right = singular.right;
    for (mut column, value) in right.column_iter_mut().zip(singular.values.iter()) {
        column /= *value;
    }
    let mut inverse = right * singular.left.transpose();
    for (mut row, norm) in inverse.row_iter_mut().zip(&norms) {
        row /= *norm;
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    use super::{Singular, pseudo_inverse};
    use crate::testing::Largest as _;
    use nalgebra::DMatrix;
    use proptest::prelude::*;
    use rand::SeedableRng as _;

    fn check(matrix: &DMatrix<f64>) {
        let Singular { left, values, right } = Singular::new(matrix).unwrap();
        let scale = matrix.largest().max(f64::MIN_POSITIVE);
        let again = &left * DMatrix::from_diagonal(&values) * right.transpose();
        assert!((again - matrix).largest() <= 1e-14 * scale, "{matrix}");
        let small = if matrix.nrows() >= matrix.ncols() { &right } else { &left };
        let k = values.len();
        assert!((small.transpose() * small - DMatrix::identity(k, k)).largest() < 1e-14);
        // The sum of squares is an oracle that the rotations do not know of.
        let squares: f64 = matrix.iter().map(|x| (x / scale) * (x / scale)).sum();
        let sum: f64 = values.iter().map(|x| (x / scale) * (x / scale)).sum();
        assert!((squares - sum).abs() <= 1e-13 * squares);
        assert!(values.as_slice().is_sorted_by(|a, b| a >= b));
    }

    /// The matrices that nalgebra's `svd` gets wrong.
    #[test]
    fn structured_matrices() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        for _ in 0..5000 {
            check(&DMatrix::from_fn(6, 6, |_, _| f64::from(random.random_range(-1..=1))));
        }
    }

    proptest! {
        #[test]
        fn any_shape_and_scale(
            entries in proptest::collection::vec(-1.0..1.0_f64, 70),
            rows in 1..8_usize, columns in 1..9_usize, power in -290..290_i32,
        ) {
            let matrix = DMatrix::from_fn(rows, columns, |i, j| entries[i * columns + j] * 10_f64.powi(power));
            check(&matrix);
        }

        #[test]
        fn pseudo_inverse_satisfies_penrose(entries in proptest::collection::vec(-1.0..1.0_f64, 48)) {
            let matrix = DMatrix::from_column_slice(8, 6, &entries);
            if let Some(inverse) = pseudo_inverse(&matrix) {
                let tolerance = 1e-14 * Singular::new(&matrix).unwrap().condition_number();
                let product = &inverse * &matrix;
                prop_assert!((product - DMatrix::identity(6, 6)).largest() < tolerance);
                let projector = &matrix * &inverse;
                prop_assert!((&projector - projector.transpose()).largest() < tolerance);
                let wide = pseudo_inverse(&matrix.transpose()).unwrap();
                prop_assert!((wide - inverse.transpose()).largest() <= f64::EPSILON * inverse.largest());
            }
        }
    }

    #[test]
    fn a_zero_matrix_has_zero_values_and_no_rank() {
        for (rows, columns) in [(3, 2), (2, 3), (1, 1)] {
            let found = Singular::new(&DMatrix::zeros(rows, columns)).unwrap();
            assert!(found.values.iter().all(|value| *value == 0.0));
            assert_eq!((found.rank(), found.condition_number()), (0, f64::INFINITY));
        }
        let found = Singular::new(&DMatrix::from_row_slice(2, 2, &[3.0, 0.0, 0.0, -0.5])).unwrap();
        assert_eq!((found.rank(), found.condition_number()), (2, 6.0));
        assert_eq!(found.values.as_slice(), [3.0, 0.5]);
    }

    /// Of a thousand rows, rounding leaves so much of a column that the others make up.
    #[test]
    fn the_rank_allows_for_the_longer_side() {
        for (rows, columns, second, rank) in [
            (1000, 2, 990.0, 1),
            (1000, 2, 1010.0, 2),
            (2, 1000, 990.0, 1),
            (2, 1000, 1010.0, 2),
            (2, 2, 3.0, 2),
        ] {
            let entry = |i, j| match (i, j) {
                (0, 0) => 4.0,
                (1, 1) => 4.0 * second * f64::EPSILON,
                _ => 0.0,
            };
            let found = Singular::new(&DMatrix::from_fn(rows, columns, entry)).unwrap();
            assert_eq!(found.rank(), rank, "{rows} × {columns}");
        }
    }

    #[test]
    fn refuses_what_has_no_inverse() {
        assert!(pseudo_inverse(&DMatrix::from_element(6, 6, 1.0)).is_none());
        assert!(pseudo_inverse(&DMatrix::zeros(6, 6)).is_none());
        assert!(pseudo_inverse(&DMatrix::from_element(6, 6, f64::NAN)).is_none());
        assert!(Singular::new(&DMatrix::zeros(0, 0)).is_none());
        let ill = DMatrix::from_diagonal(&nalgebra::DVector::from_column_slice(&[1e-150, 1.0, 1e150]));
        let inverse = pseudo_inverse(&ill).unwrap();
        assert!((inverse[(0, 0)] * 1e-150 - 1.0).abs() < 1e-15);
    }
}
