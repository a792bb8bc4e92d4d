//! Square-root least squares, row by row.

use fingertip_wrench::Real;
use nalgebra::{RowSVector, SMatrix};

/// Turns a row into an upper triangle by Givens rotations (Golub & Van Loan, *Matrix Computations*, 5.1.8), and tells
/// each rotation, of which row by which cosine and sine, to whoever carries more along with the row. What is scaled
/// first neither overflows nor vanishes.
pub(crate) fn add_row<T: Real, const N: usize>(
    triangle: &mut SMatrix<T, N, N>,
    mut row: RowSVector<T, N>,
    mut rotated: impl FnMut(usize, T, T),
) {
    for j in 0..N {
        let (a, b) = (triangle[(j, j)], row[j]);
        if b == T::zero() {
            continue;
        }
        let scale = a.abs().max(b.abs()).normalising_factor();
        let length = ((a * scale) * (a * scale) + (b * scale) * (b * scale)).root() / scale;
        if !(length > T::zero()) {
            continue;
        }
        let (cos, sin) = (a / length, b / length);
        for k in j..N {
            let (x, y) = (triangle[(j, k)], row[k]);
            triangle[(j, k)] = cos * x + sin * y;
            row[k] = cos * y - sin * x;
        }
        rotated(j, cos, sin);
    }
}
