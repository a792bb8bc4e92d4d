//! Gaussian elimination, done once.

use nalgebra::{Matrix6, Vector6};
use thiserror::Error;

use crate::{Real, SensorMatrix, Wrench, WrenchSolver};

/// The general solver for minimal sensors: LU factors of the sensor matrix with row equilibration
/// and partial pivoting, computed once (Bicchi & Dario 1987 recommend it; Wilkinson 1965).
///
/// A solve is 36 multiplications and no division.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianElimination<T: Real> {
    /// Row `i` of `U` and, left of the diagonal, of `L`. `L` is scaled so that it takes unscaled
    /// signals; the diagonal holds reciprocals.
    factors: Matrix6<T>,
    /// `order[i]` is the gauge that became row `i`.
    order: [u8; 6],
    /// Row scale in pivot order: exact powers of two for binary types.
    scale: Vector6<T>,
    nominal: Vector6<T>,
}

/// The sensor matrix cannot be inverted.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SingularMatrix {
    /// The gauges do not span six directions.
    #[error(
        "the sensor matrix is singular to working precision: gauge {gauge} adds nothing to the gauges before it \
         (pivot {pivot:e} of a row scaled to 1)"
    )]
    DependentGauge {
        /// The gauge whose row was left without a pivot (counts from 0).
        gauge: usize,
        /// What was left of its row, relative to the row's largest entry.
        pivot: f64,
    },
}

impl<T: Real> GaussianElimination<T> {
    /// Factors the matrix.
    ///
    /// # Errors
    /// [`SingularMatrix`] when a pivot is not larger than the rounding error of the elimination
    /// (`8ε` of a row whose largest entry is 1): the answer would be noise.
    pub fn new(sensor: &SensorMatrix<T, 6>) -> Result<Self, SingularMatrix> {
        // Equilibrate columns as well as rows by powers of two: neither changes a digit of the
        // answer, and pivots become comparable with 1.
        let mut a = *sensor.normalised();
        let mut nominal = *sensor.nominal();
        for (mut column, load) in a.column_iter_mut().zip(nominal.iter_mut()) {
            let factor = column.amax().normalising_factor();
            column *= factor;
            *load *= factor;
        }
        let mut scale = Vector6::zeros();
        for (mut row, row_scale) in a.row_iter_mut().zip(scale.iter_mut()) {
            *row_scale = row.amax().normalising_factor();
            row *= *row_scale;
        }
        let mut order = [0, 1, 2, 3, 4, 5_u8];
        let least_pivot = T::EPSILON * T::literal(8.0);
        for k in 0..6 {
            let pivot_row =
                (k..6).fold(k, |best, row| if a[(row, k)].abs() > a[(best, k)].abs() { row } else { best });
            let pivot = a[(pivot_row, k)];
            if pivot.abs() <= least_pivot {
                return Err(SingularMatrix::DependentGauge {
                    gauge: usize::from(order[pivot_row]),
                    pivot: pivot.to_f64(),
                });
            }
            a.swap_rows(k, pivot_row);
            order.swap(k, pivot_row);
            scale.swap_rows(k, pivot_row);
            let reciprocal = T::one() / pivot;
            for row in k + 1..6 {
                let factor = a[(row, k)] * reciprocal;
                a[(row, k)] = factor;
                for column in k + 1..6 {
                    let change = factor * a[(k, column)];
                    a[(row, column)] -= change;
                }
            }
            a[(k, k)] = reciprocal;
        }
        Ok(Self { factors: a, order, scale, nominal })
    }
}

impl<T: Real> WrenchSolver<T, 6> for GaussianElimination<T> {
    #[inline]
    fn solve(&self, signals: &Vector6<T>) -> Wrench<T> {
        let a = &self.factors;
        let mut x = Vector6::zeros();
        for i in 0..6 {
            // `order` is a permutation of 0..6: the mask says so to the compiler.
            let gauge = usize::from(self.order[i] & 7).min(5);
            let mut value = signals[gauge] * self.scale[i];
            for j in 0..i {
                value -= a[(i, j)] * x[j];
            }
            x[i] = value;
        }
        for i in (0..6).rev() {
            let mut value = x[i];
            for j in i + 1..6 {
                value -= a[(i, j)] * x[j];
            }
            x[i] = value * a[(i, i)];
        }
        Wrench::from_components(&x.component_mul(&self.nominal))
    }
}
