//! What the property tests share: random matrices of a given condition, and an oracle in twice the
//! precision of `f64`.
#![allow(dead_code, unreachable_pub, missing_docs)]
#![allow(clippy::expect_used, clippy::needless_range_loop)]

use fingertip_wrench::{Real, SensorMatrix};
use nalgebra::{SMatrix, SVector, Vector6};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

pub mod double_double;

pub fn generator(seed: u128) -> Pcg64Mcg {
    Pcg64Mcg::new(0xcafe_f00d_d15e_a5e5 ^ (seed << 64))
}

pub fn normal(random: &mut Pcg64Mcg) -> f64 {
    StandardNormal.sample(random)
}

/// Uniform in (−1, 1).
pub fn symmetric(random: &mut Pcg64Mcg) -> f64 {
    random.random_range(-1.0..1.0)
}

/// Orthonormal columns, uniformly distributed.
pub fn orthonormal<const N: usize>(random: &mut Pcg64Mcg) -> SMatrix<f64, N, 6> {
    loop {
        let mut q = SMatrix::<f64, N, 6>::from_fn(|_, _| normal(random));
        let mut independent = true;
        for j in 0..6 {
            // Gram and Schmidt, twice.
            for _ in 0..2 {
                for k in 0..j {
                    let along = q.column(k).dot(&q.column(j));
                    let other = q.column(k).into_owned();
                    let mut column = q.column_mut(j);
                    column -= other * along;
                }
            }
            let norm = q.column(j).norm();
            independent &= norm > 1e-3;
            let mut column = q.column_mut(j);
            column /= norm;
        }
        if independent {
            return q;
        }
    }
}

/// An N×6 matrix with singular values from 1 down to `1/condition`, spread at random.
pub fn of_condition<const N: usize>(random: &mut Pcg64Mcg, condition: f64) -> SMatrix<f64, N, 6> {
    let left = orthonormal::<N>(random);
    let right = orthonormal::<6>(random);
    let mut values = Vector6::from_fn(|_, _| condition.powf(-random.random_range(0.0..1.0)));
    values[0] = 1.0;
    values[5] = 1.0 / condition;
    left * SMatrix::<f64, 6, 6>::from_diagonal(&values) * right.transpose()
}

/// The same numbers, rounded to another type.
pub fn cast<T: Real, const R: usize, const C: usize>(matrix: &SMatrix<f64, R, C>) -> SMatrix<T, R, C> {
    matrix.map(T::literal)
}

/// The same numbers, which an `f64` holds exactly.
pub fn wide<T: Real, const R: usize, const C: usize>(matrix: &SMatrix<T, R, C>) -> SMatrix<f64, R, C> {
    matrix.map(T::to_f64)
}

/// A sensor with nominal loads that are powers of two, so that normalising costs no digit.
pub fn sensor<T: Real, const N: usize>(matrix: &SMatrix<f64, N, 6>) -> SensorMatrix<T, N> {
    let nominal = Vector6::new(32.0, 16.0, 8.0, 0.25, 0.5, 0.125).map(T::literal);
    SensorMatrix::new(cast(matrix), nominal).expect("a proper sensor")
}

pub fn random_vector<const N: usize>(random: &mut Pcg64Mcg) -> SVector<f64, N> {
    SVector::from_fn(|_, _| normal(random))
}

/// The largest magnitude of an entry; unlike `amax`, which passes over a NaN.
#[track_caller]
pub fn greatest<T: Real, const R: usize, const C: usize>(matrix: &SMatrix<T, R, C>) -> f64 {
    matrix.iter().fold(0.0, |worst: f64, x| {
        let error = x.to_f64().abs();
        assert!(!error.is_nan(), "an entry is NaN");
        worst.max(error)
    })
}

/// The middle one.
pub fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
