//! The orthogonal factorisation of an extended sensor's matrix.

use nalgebra::{SMatrix, SVector, Vector6};

use crate::Real;

/// `C⁺` and the projection on what no load can cause, by Householder reflections with column
/// pivoting and rows sorted by size (Golub 1965; rows: Cox & Higham 1998, so that weights of very
/// different size do no harm). Normal equations are never formed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Orthogonal<T: Real, const N: usize> {
    /// `C⁺`, 6×N.
    pub(crate) pseudo_inverse: SMatrix<T, 6, N>,
    /// `I − C C⁺`, computed as `Z Zᵀ` from an orthonormal basis `Z` of the complement: no
    /// cancellation.
    pub(crate) complement: SMatrix<T, N, N>,
}

/// The column that depends on the columns before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DependentColumn(pub(crate) usize);

impl<T: Real, const N: usize> Orthogonal<T, N> {
    /// Factors an N×6 matrix with finite entries, N ≥ 6.
    ///
    /// Columns are equilibrated by powers of two. A column counts as dependent when what is left of
    /// it is below `8Nε` of its size.
    pub(crate) fn new(original: &SMatrix<T, N, 6>) -> Result<Self, DependentColumn> {
        let column_scale = Vector6::from_fn(|j, _| original.column(j).amax().normalising_factor());
        let scaled = SMatrix::<T, N, 6>::from_fn(|i, j| original[(i, j)] * column_scale[j]);
        let row_order = rows_by_size(&scaled);
        let mut a = SMatrix::<T, N, 6>::from_fn(|i, j| scaled[(row_order[i], j)]);
        let mut column_order = [0, 1, 2, 3, 4, 5_usize];
        // Qᵀ, one reflection after the other.
        let mut q_transposed = SMatrix::<T, N, N>::identity();
        let least = T::EPSILON * T::literal(8.0 * N as f64);
        for k in 0..6.min(N) {
            let left =
                |a: &SMatrix<T, N, 6>, j: usize| (k..N).fold(T::zero(), |sum, i| sum + a[(i, j)] * a[(i, j)]);
            let largest = (k..6).fold(k, |best, j| if left(&a, j) > left(&a, best) { j } else { best });
            a.swap_columns(k, largest);
            column_order.swap(k, largest);
            let norm = left(&a, k).root();
            // Columns are scaled to a largest entry in [1, 2).
            if !(norm > least) {
                return Err(DependentColumn(column_order[k]));
            }
            let mut v = SVector::<T, N>::zeros();
            for i in k..N {
                v[i] = a[(i, k)];
            }
            let head = v[k];
            v[k] = if head < T::zero() { head - norm } else { head + norm };
            let two_over = T::literal(2.0) / v.norm_squared();
            for j in k..6 {
                let along = a.column(j).dot(&v) * two_over;
                let mut column = a.column_mut(j);
                column -= v * along;
            }
            for j in 0..N {
                let along = q_transposed.column(j).dot(&v) * two_over;
                let mut column = q_transposed.column_mut(j);
                column -= v * along;
            }
        }
        let mut pseudo_inverse = SMatrix::<T, 6, N>::zeros();
        let mut complement = SMatrix::<T, N, N>::zeros();
        for gauge in 0..N {
            // R x = Qᵀ e, from the last unknown up.
            let mut x = Vector6::zeros();
            for k in (0..6.min(N)).rev() {
                let known = (k + 1..6).fold(q_transposed[(k, gauge)], |sum, j| sum - a[(k, j)] * x[j]);
                x[k] = known / a[(k, k)];
            }
            for k in 0..6 {
                let axis = column_order[k];
                pseudo_inverse[(axis, row_order[gauge])] = x[k] * column_scale[axis];
            }
            for other in 0..N {
                complement[(row_order[gauge], row_order[other])] = (6..N)
                    .fold(T::zero(), |sum, z| sum + q_transposed[(z, gauge)] * q_transposed[(z, other)]);
            }
        }
        Ok(Self { pseudo_inverse, complement })
    }
}

/// Row numbers, the row with the largest entry first.
fn rows_by_size<T: Real, const N: usize>(matrix: &SMatrix<T, N, 6>) -> [usize; N] {
    let mut order = core::array::from_fn(|i| i);
    for i in 1..N {
        let mut j = i;
        while j > 0 && matrix.row(order[j]).amax() > matrix.row(order[j - 1]).amax() {
            order.swap(j, j - 1);
            j -= 1;
        }
    }
    order
}
