//! The one linear system of a step: six by six, symmetric.

use fingertip_wrench::Real;
use nalgebra::{Matrix6, Vector6};

/// `L Lᵀ = S + δ`, with δ a few rounding errors of the trace: so that directions in which no contact can push
/// are kept, and carry a certificate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cholesky<T: Real> {
    lower: Matrix6<T>,
    /// Reciprocals of the diagonal.
    inverse: Vector6<T>,
}

impl<T: Real> Cholesky<T> {
    #[inline]
    pub(crate) fn new(matrix: &Matrix6<T>) -> Self {
        let shift = matrix.trace() * T::EPSILON * T::literal(4.0) + T::LEAST_NORMAL;
        let mut lower = *matrix;
        let mut inverse = Vector6::zeros();
        for j in 0..6 {
            let mut pivot = lower[(j, j)] + shift;
            for k in 0..j {
                pivot -= lower[(j, k)] * lower[(j, k)];
            }
            // Rounding may take a pivot below what was added.
            let root = pivot.max(shift).root();
            let reciprocal = T::one() / root;
            inverse[j] = reciprocal;
            for i in j + 1..6 {
                let mut sum = lower[(i, j)];
                for k in 0..j {
                    sum -= lower[(i, k)] * lower[(j, k)];
                }
                lower[(i, j)] = sum * reciprocal;
            }
        }
        Self { lower, inverse }
    }

    #[inline]
    pub(crate) fn solve(&self, right: &Vector6<T>) -> Vector6<T> {
        let mut x = *right;
        for i in 0..6 {
            let mut sum = x[i];
            for k in 0..i {
                sum -= self.lower[(i, k)] * x[k];
            }
            x[i] = sum * self.inverse[i];
        }
        for i in (0..6).rev() {
            let mut sum = x[i];
            for k in i + 1..6 {
                sum -= self.lower[(k, i)] * x[k];
            }
            x[i] = sum * self.inverse[i];
        }
        x
    }
}
