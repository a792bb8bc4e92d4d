//! Sums of products as if in twice the precision.

use nalgebra::SMatrix;

use crate::Real;

/// `start − Σ aᵢ bᵢ` as if computed in twice the working precision and rounded once (Dot2 of
/// Ogita, Rump & Oishi 2005).
///
/// Error at most `ε/2·|result| + n²ε²·(|start| + Σ|aᵢ bᵢ|)` if no product is near the ends of the
/// range.
#[inline]
pub(crate) fn residual<T: Real>(start: T, products: impl Iterator<Item = (T, T)>) -> T {
    let (mut high, mut low) = (start, T::zero());
    for (a, b) in products {
        let (product, product_error) = a.two_product(b);
        let (sum, sum_error) = high.two_sum(-product);
        high = sum;
        low += sum_error - product_error;
    }
    high + low
}

/// `start − a·b` of matrices, each entry by [`residual`].
pub(crate) fn matrix_residual<T: Real, const R: usize, const K: usize, const C: usize>(
    start: &SMatrix<T, R, C>,
    a: &SMatrix<T, R, K>,
    b: &SMatrix<T, K, C>,
) -> SMatrix<T, R, C> {
    SMatrix::from_fn(|i, j| residual(start[(i, j)], (0..K).map(|k| (a[(i, k)], b[(k, j)]))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cancels<T: Real>() {
        // (1 + ε)(1 − ε) = 1 − ε²: the plain product rounds to 1.
        let (a, b) = (T::one() + T::EPSILON, T::one() - T::EPSILON);
        let plain = T::one() - a * b;
        assert!(plain.is_zero());
        assert_eq!(residual(T::one(), [(a, b)].into_iter()), T::EPSILON * T::EPSILON);
    }

    #[test]
    fn what_cancels_survives() {
        cancels::<f32>();
        cancels::<f64>();
    }
}
