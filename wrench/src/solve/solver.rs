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
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not turn {N} signals of `{T}` into a wrench",
    note = "give a solver for as many signals to `.solver(…)`, or take wrenches by `sense_wrench`"
)]
pub trait WrenchSolver<T: Real, const N: usize> {
    /// The wrench \[N, N·m\] about the origin of the sensor frame, from the signals after tare and
    /// thermal compensation (same unit as the sensor matrix).
    fn solve(&self, signals: &SVector<T, N>) -> Wrench<T>;

    /// What linear map this is, for the sensor that the solver was built for. `None`, as the default answers, if it
    /// is none, or is not known: then its error has no bound. Not for the hot path: it may do the work of a
    /// factorisation.
    fn linear_map(&self, sensor: &SensorMatrix<T, N>) -> Option<LinearMap<T, N>> {
        let _ = sensor;
        None
    }
}

impl<T: Real, const N: usize, S: WrenchSolver<T, N> + ?Sized> WrenchSolver<T, N> for &S {
    #[inline]
    fn solve(&self, signals: &SVector<T, N>) -> Wrench<T> {
        (**self).solve(signals)
    }

    fn linear_map(&self, sensor: &SensorMatrix<T, N>) -> Option<LinearMap<T, N>> {
        (**self).linear_map(sensor)
    }
}

/// What linear map a solver is, and how far it is from the truth: all that [`ErrorBound`](crate::ErrorBound) and
/// [`WrenchCovariance`](crate::WrenchCovariance) need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearMap<T: Real, const N: usize> {
    /// The matrix `S` of the map `wrench / nominal loads = S · signals`, but for rounding.
    pub gain: SMatrix<T, 6, N>,
    /// How far [`solve`](WrenchSolver::solve) may be from the load, were the sensor exactly as
    /// given: couplings neglected, and all rounding.
    pub own_error: OwnError<T, N>,
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
