//! A sensor whose signals are not quite proportional to the load: products of pairs of signals beside them.

use nalgebra::{SMatrix, SVector, Vector6};
use thiserror::Error;

use crate::{Real, Wrench, WrenchSolver};

/// The inverse regression of a sensor that is slightly curved: `wrench = L s + Σ_{i≤j} q_ij s_i s_j`
/// (`docs/theory/calibration.md#the-model`).
///
/// `L` is 6 × N in N and N·m per signal; `q_ij`, a vector of six, belongs to the product of signals i and j, in N
/// and N·m per signal². Its answer is as good as the fit where that was made, and means nothing far beyond:
/// polynomials run away. A wrench that overflows is not finite, and the contact then is
/// "no contact: not finite".
///
/// ```
/// use fingertip_wrench::{QuadraticInverse, WrenchSolver};
/// use nalgebra::{SMatrix, Vector6};
///
/// // 5 N/V along each axis, and a gauge that reads 2 % less than that at 1 V: 0.1 N/V² more.
/// let straight = SMatrix::<f64, 6, 6>::from_diagonal_element(5.0);
/// let sensor = QuadraticInverse::new(straight, |i, j| {
///     if (i, j) == (0, 0) { Vector6::x() * 0.1 } else { Vector6::zeros() }
/// })?;
/// let wrench = sensor.solve(&Vector6::new(1.0, 0.0, 2.0, 0.0, 0.0, 0.0));
/// assert_eq!(wrench.force().x, 5.1);
/// assert_eq!(wrench.force().z, 10.0);
/// # Ok::<(), fingertip_wrench::BadQuadratic>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraticInverse<T: Real, const N: usize> {
    linear: SMatrix<T, 6, N>,
    /// Of signal `i`, the columns of the signals `j ≥ i`; those before are zero.
    pairs: [SMatrix<T, 6, N>; N],
}

/// A coefficient that is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadQuadratic {
    /// A coefficient is NaN or infinite.
    #[error("a coefficient of the quadratic sensor model is not a finite number")]
    NotFinite,
}

impl<T: Real, const N: usize> QuadraticInverse<T, N> {
    /// From its coefficients; `quadratic` is asked for each pair of signals `i ≤ j` once.
    ///
    /// # Errors
    /// [`BadQuadratic`].
    pub fn new(
        linear: SMatrix<T, 6, N>,
        mut quadratic: impl FnMut(usize, usize) -> Vector6<T>,
    ) -> Result<Self, BadQuadratic> {
        let pairs: [SMatrix<T, 6, N>; N] = core::array::from_fn(|i| {
            let mut of = SMatrix::<T, 6, N>::zeros();
            for j in i..N {
                of.set_column(j, &quadratic(i, j));
            }
            of
        });
        let coefficients = linear.iter().chain(pairs.iter().flatten());
        if coefficients.into_iter().all(|x| x.is_number()) {
            Ok(Self { linear, pairs })
        } else {
            Err(BadQuadratic::NotFinite)
        }
    }

    /// The linear part, in N and N·m per signal.
    #[must_use]
    pub const fn linear(&self) -> &SMatrix<T, 6, N> {
        &self.linear
    }
}

impl<T: Real, const N: usize> WrenchSolver<T, N> for QuadraticInverse<T, N> {
    /// N(N+3)/2 products for each component.
    #[inline]
    fn solve(&self, signals: &SVector<T, N>) -> Wrench<T> {
        let mut wrench = Vector6::zeros();
        for (i, (signal, pairs)) in signals.iter().zip(&self.pairs).enumerate() {
            let mut per_signal: Vector6<T> = self.linear.column(i).into_owned();
            for (other, pair) in signals.iter().zip(pairs.column_iter()).skip(i) {
                per_signal += pair * *other;
            }
            wrench += per_signal * *signal;
        }
        Wrench::from_components(&wrench)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{SMatrix, SVector, Vector6};
    use proptest::prelude::*;

    use super::{BadQuadratic, QuadraticInverse};
    use crate::{Real, WrenchSolver as _};

    /// Different in every coefficient.
    fn coefficient<T: Real>(axis: usize, i: usize, j: usize) -> T {
        T::literal(((1 + axis) as f64 * 1.3 + (3 + i) as f64 * 0.7 + (5 + j) as f64 * 2.9).sin())
    }

    fn linear<T: Real, const N: usize>() -> SMatrix<T, 6, N> {
        SMatrix::from_fn(|axis, gauge| coefficient::<T>(axis, 17, gauge) * T::literal(10.0))
    }

    fn sensor<T: Real, const N: usize>() -> QuadraticInverse<T, N> {
        QuadraticInverse::new(linear(), |i, j| Vector6::from_fn(|axis, _| coefficient(axis, i, j))).unwrap()
    }

    proptest! {
        /// Against the sum as the formula has it, component by component.
        #[test]
        fn every_pair_counts_once(signals in proptest::array::uniform8(-3.0..3.0_f64)) {
            let found = sensor::<f64, 8>().solve(&SVector::from(signals)).components();
            let narrow = sensor::<f32, 8>().solve(&SVector::from(signals.map(|x| x as f32))).components();
            for axis in 0..6 {
                let mut expected = 0.0;
                for i in 0..8 {
                    expected += linear::<f64, 8>()[(axis, i)] * signals[i];
                    for j in i..8 {
                        expected += coefficient::<f64>(axis, i, j) * signals[i] * signals[j];
                    }
                }
                prop_assert!((found[axis] - expected).abs() < 1e-11, "{} for {expected}", found[axis]);
                prop_assert!((f64::from(narrow[axis]) - expected).abs() < 1e-3);
            }
        }
    }

    #[test]
    fn without_products_it_is_the_matrix_and_bad_numbers_are_refused() {
        let straight = QuadraticInverse::<f64, 7>::new(linear(), |_, _| Vector6::zeros()).unwrap();
        let signals = SVector::from_fn(|i, _| 0.1 * i as f64 - 0.3);
        let difference = straight.solve(&signals).components() - linear::<f64, 7>() * signals;
        assert!(difference.amax() < 1e-13);
        for bad in [f64::NAN, f64::INFINITY] {
            let at = |place: (usize, usize)| {
                QuadraticInverse::<f64, 6>::new(linear(), |i, j| {
                    Vector6::repeat(if (i, j) == place { bad } else { 1.0 })
                })
            };
            assert_eq!(at((2, 5)), Err(BadQuadratic::NotFinite));
            assert!(at((5, 2)).is_ok(), "asked for a pair twice");
            let crooked = SMatrix::<f64, 6, 6>::repeat(bad);
            assert!(QuadraticInverse::new(crooked, |_, _| Vector6::zeros()).is_err());
        }
    }

    #[test]
    fn extremes_overflow_and_do_not_panic() {
        for size in [0.0, 1e-320, 1e200, f64::MAX, f64::INFINITY, f64::NAN] {
            let wrench = sensor::<f64, 6>().solve(&SVector::repeat(size));
            assert_eq!(wrench.is_finite(), size < 1e150, "{size}: {wrench:?}");
        }
    }
}
