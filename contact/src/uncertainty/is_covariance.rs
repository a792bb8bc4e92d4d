//! Can a matrix be a covariance?

use fingertip_wrench::Real;
use nalgebra::SMatrix;

/// Finite, symmetric, and no direction has a negative variance, but for rounding.
///
/// The matrix of the correlations is factored (Cholesky), its diagonal raised by what rounding makes of
/// `N` products of `N` numbers: so a covariance of less than full rank passes.
pub(crate) fn is_covariance<T: Real, const N: usize>(matrix: &SMatrix<T, N, N>) -> bool {
    if !matrix.iter().all(|x| x.is_number()) {
        return false;
    }
    let rounding = T::EPSILON * T::literal((4 * N * N) as f64);
    // Of zero variance: nothing correlates with what is certain.
    let deviations = matrix.diagonal().map(|variance| variance.max(T::zero()).root());
    let correlation = SMatrix::<T, N, N>::from_fn(|i, j| {
        let scale = deviations[i] * deviations[j];
        if scale > T::zero() { matrix[(i, j)] / scale } else { matrix[(i, j)] }
    });
    let certain = |i: usize| !(deviations[i] > T::zero());
    for i in 0..N {
        for j in 0..N {
            let apart = (correlation[(i, j)] - correlation[(j, i)]).abs();
            let good = if certain(i) || certain(j) { matrix[(i, j)].is_zero() } else { apart <= rounding };
            if !good {
                return false;
            }
        }
    }
    (correlation + SMatrix::<T, N, N>::from_diagonal_element(rounding)).cholesky().is_some()
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::Real;
    use nalgebra::{Matrix3, Matrix6, Vector6};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::is_covariance;

    /// Products `A Aᵀ` are covariances, of whatever rank and scale; with one eigenvalue turned negative they
    /// are not.
    fn products_are_and_others_are_not<T: Real>() {
        let mut random = Pcg64Mcg::seed_from_u64(3);
        for k in 0..1000 {
            let rank = 1 + k % 6;
            let scale = Vector6::from_fn(|_, _| 10_f64.powf(random.random_range(-6.0..3.0)));
            let root = Matrix6::from_fn(|_, j| {
                if j < rank { T::literal(random.random_range(-1.0..1.0)) } else { T::zero() }
            });
            let root = Matrix6::from_diagonal(&scale.map(T::literal)) * root;
            assert!(is_covariance(&(root * root.transpose())), "{root}");
            // A variance of 1 in all directions but one, where it is −0.01.
            let odd = Vector6::from_fn(|_, _| T::literal(random.random_range(-1.0..1.0))).normalize();
            let indefinite = Matrix6::identity() - odd * odd.transpose() * T::literal(1.01);
            assert!(!is_covariance(&indefinite), "{indefinite}");
        }
    }

    #[test]
    fn semidefinite_matrices_pass_and_no_others() {
        products_are_and_others_are_not::<f32>();
        products_are_and_others_are_not::<f64>();
    }

    #[test]
    fn what_is_certain_does_not_vary() {
        assert!(is_covariance(&Matrix3::<f64>::zeros()));
        let some = Matrix3::new(1.0, 0.5, 0.0, 0.5, 2.0, 0.0, 0.0, 0.0, 0.0);
        assert!(is_covariance(&some));
        for bad in [
            Matrix3::new(1.0, 0.5, 1e-9, 0.5, 2.0, 0.0, 1e-9, 0.0, 0.0),
            Matrix3::new(1.0, 0.5, 0.0, 0.4, 2.0, 0.0, 0.0, 0.0, 0.0),
            Matrix3::new(1.0, 0.5, 0.0, 0.5, 2.0, 0.0, 0.0, 0.0, -1e-9),
            Matrix3::new(1.0, 1.5, 0.0, 1.5, 2.0, 0.0, 0.0, 0.0, 0.0),
            Matrix3::new(1.0, 0.5, 0.0, 0.5, f64::INFINITY, 0.0, 0.0, 0.0, 0.0),
            Matrix3::new(1.0, f64::NAN, 0.0, f64::NAN, 2.0, 0.0, 0.0, 0.0, 0.0),
        ] {
            assert!(!is_covariance(&bad), "{bad}");
        }
    }
}
