//! From signals to wrench.

use nalgebra::{Matrix6, SMatrix, SVector};

use crate::{Real, SensorMatrix, Wrench};

/// Turns the signals of `N` gauges into the wrench on the fingertip.
///
/// # For users
/// Built fallibly, run infallibly: everything that can be wrong with a sensor matrix is an error
/// of the constructor. [`solve`](Self::solve) never panics; a signal that is NaN or infinite gives
/// a wrench that is not finite, which every contact model answers with its own reason.
///
/// # For implementers
/// `solve` shall be free of allocation, of loops that depend on the data and of branches that
/// depend on the data beyond the pivot order chosen at construction.
pub trait WrenchSolver<T: Real, const N: usize> {
    /// The wrench \[N, N·m\] about the origin of the sensor frame, from the signals after tare and
    /// thermal compensation (same unit as the sensor matrix).
    fn solve(&self, signals: &SVector<T, N>) -> Wrench<T>;
}

impl<T: Real, const N: usize, S: WrenchSolver<T, N> + ?Sized> WrenchSolver<T, N> for &S {
    #[inline]
    fn solve(&self, signals: &SVector<T, N>) -> Wrench<T> {
        (**self).solve(signals)
    }
}

/// A solver that is a linear map, and knows what map and how far it is from the truth.
///
/// These two say all that [`ErrorBound`](crate::ErrorBound) and
/// [`WrenchCovariance`](crate::WrenchCovariance) need. Neither is for the hot path: both may do
/// the work of a factorisation, for which they take the sensor that the solver was built for.
pub trait LinearSolver<T: Real, const N: usize>: WrenchSolver<T, N> {
    /// The 6×N matrix `S` of the map `wrench / nominal loads = S · signals`, but for rounding.
    fn gain(&self, sensor: &SensorMatrix<T, N>) -> SMatrix<T, 6, N>;

    /// How far [`solve`](WrenchSolver::solve) may be from the load, were the sensor exactly as
    /// given: couplings neglected, and all rounding.
    fn own_error(&self, sensor: &SensorMatrix<T, N>) -> OwnError<T, N>;
}

/// A bound on the error that a solver makes itself, component by component and in units of the
/// nominal loads.
///
/// For signals `V = C·P + d`, with `P` the load, the computed `P̂` obeys
/// `|P̂ − P| ≤ per_load·max(|P|, |P̂|) + per_signal·|V| + magnitude·|d|`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnError<T: Real, const N: usize> {
    /// The part that grows with the load.
    pub per_load: Matrix6<T>,
    /// The part that grows with the signals.
    pub per_signal: SMatrix<T, 6, N>,
    /// What becomes of an error of the signals: magnitudes of the entries of the map.
    pub magnitude: SMatrix<T, 6, N>,
}

impl<T: Real, const N: usize, S: LinearSolver<T, N> + ?Sized> LinearSolver<T, N> for &S {
    fn gain(&self, sensor: &SensorMatrix<T, N>) -> SMatrix<T, 6, N> {
        (**self).gain(sensor)
    }

    fn own_error(&self, sensor: &SensorMatrix<T, N>) -> OwnError<T, N> {
        (**self).own_error(sensor)
    }
}
