//! Singular values without vectors.

use nalgebra::{SMatrix, Vector6};

use super::jacobi::{column_norm, orthogonalise};
use crate::Real;

/// The six singular values of an N×6 matrix, largest first, by [one-sided Jacobi rotations](orthogonalise).
///
/// Each is right to a few rounding errors of the *largest*, and of itself where only the sizes of
/// the columns make the matrix ill-conditioned (Demmel & Veselić 1992). Vectors are not computed.
/// The number of sweeps is bounded; entries that are not finite give values that are not finite.
///
/// ```
/// use fingertip_wrench::singular_values;
/// use nalgebra::SMatrix;
///
/// let mut matrix = SMatrix::<f64, 8, 6>::zeros();
/// for (i, size) in [3.0, 1e-9, 5.0, 1.0, 2.0, 4.0].into_iter().enumerate() {
///     matrix[(i, i)] = size;
/// }
/// assert_eq!(singular_values(&matrix).as_slice(), [5.0, 4.0, 3.0, 2.0, 1.0, 1e-9]);
/// ```
#[must_use]
pub fn singular_values<T: Real, const N: usize>(matrix: &SMatrix<T, N, 6>) -> Vector6<T> {
    let scale = matrix.amax().normalising_factor();
    let mut a = matrix * scale;
    orthogonalise(&mut a, |_, _, _| {});
    let mut values = Vector6::from_fn(|j, _| column_norm(&a, j) / scale);
    for i in 1..6 {
        let mut j = i;
        while j > 0 && values[j] > values[j - 1] {
            values.swap_rows(j, j - 1);
            j -= 1;
        }
    }
    values
}
