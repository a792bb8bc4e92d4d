//! The one linear system of a step: six by six, symmetric.

use fingertip_wrench::Real;
use nalgebra::{Matrix6, Vector6};

/// `L Lᵀ = S + δ`, with δ a few rounding errors of the trace: so that directions in which no contact can push
/// are kept, and carry a certificate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cholesky<T: Real> {
    /// By columns; above the diagonal is what was there.
    lower: [[T; 6]; 6],
    /// Reciprocals of the diagonal.
    inverse: [T; 6],
}

impl<T: Real> Cholesky<T> {
    /// Of a matrix of which the lower half is read.
    #[inline(never)]
    pub(crate) fn new(matrix: &Matrix6<T>) -> Self {
        let shift = matrix.trace() * T::EPSILON * T::literal(4.0) + T::LEAST_NORMAL;
        let mut new = Self { lower: matrix.data.0, inverse: [T::zero(); 6] };
        // Each with its number known to the compiler: as a loop it would take three times as long.
        new.eliminate::<0>(shift);
        new.eliminate::<1>(shift);
        new.eliminate::<2>(shift);
        new.eliminate::<3>(shift);
        new.eliminate::<4>(shift);
        new.eliminate::<5>(shift);
        new
    }

    /// Finishes a column, and takes what it explains off those behind it.
    #[inline(always)]
    #[allow(
        clippy::needless_range_loop,
        reason = "triangles, of which iterators would check each bound anew"
    )]
    fn eliminate<const J: usize>(&mut self, shift: T) {
        let Self { lower, inverse } = self;
        let mut column = lower[J];
        // Rounding may take a pivot below what was added.
        let reciprocal = T::one() / (column[J] + shift).max(shift).root();
        for i in J + 1..6 {
            column[i] *= reciprocal;
        }
        for k in J + 1..6 {
            for i in k..6 {
                lower[k][i] -= column[i] * column[k];
            }
        }
        (lower[J], inverse[J]) = (column, reciprocal);
    }

    #[inline(never)]
    #[allow(
        clippy::needless_range_loop,
        reason = "triangles, of which iterators would check each bound anew"
    )]
    pub(crate) fn solve(&self, right: &Vector6<T>) -> Vector6<T> {
        let [mut x] = right.data.0;
        for j in 0..6 {
            x[j] *= self.inverse[j];
            for i in j + 1..6 {
                x[i] -= self.lower[j][i] * x[j];
            }
        }
        for i in (0..6).rev() {
            let mut sum = x[i];
            for k in i + 1..6 {
                sum -= self.lower[i][k] * x[k];
            }
            x[i] = sum * self.inverse[i];
        }
        x.into()
    }
}

#[cfg(test)]
mod tests {
    use super::Cholesky;
    use nalgebra::{Matrix6, Vector6};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// Against nalgebra's, to the few rounding errors of the trace that are added; and where directions are missing, what
    /// lies in the others.
    #[test]
    fn what_is_solved_is_solved() {
        let mut rng = Pcg64Mcg::seed_from_u64(4);
        for _ in 0..200 {
            let root = Matrix6::<f64>::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let matrix = root * root.transpose() + Matrix6::identity() * 0.01;
            let right = Vector6::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let exact = matrix.cholesky().unwrap().solve(&right);
            let found = Cholesky::new(&matrix).solve(&right);
            assert!((found - exact).norm() < 1e-10 * exact.norm(), "{found} {exact}");
            // A shift of a few rounding errors and no more.
            let cholesky = Cholesky::new(&matrix);
            let mut lower = Matrix6::from_fn(|i, j| cholesky.lower[j][i]);
            lower.fill_upper_triangle(0.0, 1);
            cholesky.inverse.iter().enumerate().for_each(|(i, x)| lower[(i, i)] = x.recip());
            let off = lower * lower.transpose() - matrix;
            assert!(
                off.amax() < 8.0 * f64::EPSILON * matrix.trace()
                    && off.trace() > 12.0 * f64::EPSILON * matrix.trace(),
                "{off}"
            );
        }
        for missing in 0..6 {
            let mut matrix = Matrix6::<f64>::identity() * 3.0;
            matrix[(missing, missing)] = 0.0;
            let right = Vector6::from_element(6.0);
            let found = Cholesky::new(&matrix).solve(&right);
            assert!((0..6).all(|i| (i == missing) == (found[i] > 1e12)), "{found}");
            assert!((0..6).all(|i| i == missing || (found[i] - 2.0).abs() < 1e-12), "{found}");
        }
        assert!(Cholesky::new(&Matrix6::<f64>::zeros()).solve(&Vector6::zeros()).iter().all(|x| *x == 0.0));
    }
}
