//! How far a wrench that was found is from what its signals say.

use nalgebra::{Matrix6, SMatrix, SVector, Vector6};

use crate::solve::compensated::residual;
use crate::solve::nonnegative::neumann;
use crate::{Real, SensorMatrix, Uncertainty, Wrench};

/// A bound on the error of a wrench by its residual `P̂ − S·signals`, `S` being a left inverse of the sensor matrix to
/// twice the digits of the type (`docs/theory/wrench.md#error-bound-of-a-solve`): whatever the solver did,
/// `P̂ − P = (P̂ − S·signals) + (S C − I) P + S (dC P + dV)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Closely<T: Real, const N: usize> {
    /// `S` in newtons and newton metres per signal, and what rounding took from it.
    map: SMatrix<T, 6, N>,
    rest: SMatrix<T, 6, N>,
    per_residual: Matrix6<T>,
    per_load: Matrix6<T>,
    per_signal: SMatrix<T, 6, N>,
    constant: Vector6<T>,
}

impl<T: Real, const N: usize> Closely<T, N> {
    /// What a sum of products in twice the precision is off by, as a share of its terms' magnitudes: `n²ε²` of
    /// [`residual`], for a start and twice as many products as there are gauges or axes.
    fn share() -> T {
        let terms = T::literal(2.0 * N.max(6) as f64 + 1.0) * T::EPSILON;
        terms * terms
    }

    /// For a sensor and a gain that is a left inverse of it, more or less; `margin` is for what computing the bound
    /// rounds. Not finite where there is no such bound.
    pub(super) fn new(
        sensor: &SensorMatrix<T, N>,
        gain: &SMatrix<T, 6, N>,
        uncertainty: &Uncertainty<T, N>,
        margin: T,
    ) -> Self {
        let (nominal, matrix) = (sensor.nominal(), sensor.normalised());
        let map = SMatrix::<T, 6, N>::from_fn(|i, k| gain[(i, k)] * nominal[i]);
        let unit = |i: usize, j: usize| if i == j { nominal[i] } else { T::zero() };
        let products = |i: usize, j: usize, map: &SMatrix<T, 6, N>| {
            let row = map.row(i).into_owned();
            (0..N).map(move |k| (row[k], matrix[(k, j)]))
        };
        // A step of Newton's method for the inverse: `S + (I − S C) S`.
        let defect = Matrix6::from_fn(|i, j| residual(unit(i, j), products(i, j, &map)));
        let rest = SMatrix::<T, 6, N>::from_fn(|i, k| {
            (0..6).fold(T::zero(), |sum, j| sum + defect[(i, j)] * gain[(j, k)])
        });
        let magnitude = map.abs() + rest.abs();
        let share = Self::share();
        let left = Matrix6::from_fn(|i, j| {
            let both = products(i, j, &map).chain(products(i, j, &rest));
            let terms = (0..N).fold(unit(i, j), |sum, k| sum + magnitude[(i, k)] * matrix[(k, j)].abs());
            residual(unit(i, j), both).abs() + terms * share
        });
        // Per newton and newton metre.
        let relative = (left + magnitude * uncertainty.matrix).map_with_location(|_, j, x| x / nominal[j]);
        let amplified = neumann(&relative).unwrap_or_else(|| Matrix6::repeat(T::GREATEST)) * margin;
        Self {
            map,
            rest,
            per_residual: amplified,
            per_load: amplified * (relative + Matrix6::identity() * share),
            per_signal: amplified * magnitude * share,
            constant: amplified * (magnitude * uncertainty.signals),
        }
    }

    /// The bound for each component of a wrench \[N, N, N, N·m, N·m, N·m\].
    #[inline]
    pub(super) fn at(&self, signals: &SVector<T, N>, wrench: &Wrench<T>) -> Vector6<T> {
        // Near 1, so that the errors of products are no smaller than numbers can be.
        let scale = signals.amax().normalising_factor();
        let reading = signals * scale;
        let found = wrench.components();
        let off = Vector6::from_fn(|i, _| {
            let products = (0..N)
                .map(|k| (self.map[(i, k)], reading[k]))
                .chain((0..N).map(|k| (self.rest[(i, k)], reading[k])));
            residual(found[i] * scale, products).abs() / scale
        });
        self.per_residual * off
            + self.per_load * found.abs()
            + self.per_signal * signals.abs()
            + self.constant
    }
}
