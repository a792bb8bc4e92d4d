//! From signals to wrench.

use nalgebra::SVector;

use crate::{Real, Wrench};

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
