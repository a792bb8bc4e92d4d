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
///
/// ```
/// use fingertip_wrench::{Wrench, WrenchSolver};
/// use nalgebra::{Vector3, Vector6};
///
/// /// A sensor that has solved already, and gives newtons and newton millimetres.
/// struct Solved;
/// impl WrenchSolver<f64, 6> for Solved {
///     fn solve(&self, signals: &Vector6<f64>) -> Wrench<f64> {
///         let [fx, fy, fz, tx, ty, tz] = signals.data.0[0];
///         Wrench::on_fingertip(Vector3::new(fx, fy, fz), Vector3::new(tx, ty, tz) / 1000.0)
///     }
/// }
/// let wrench = Solved.solve(&Vector6::new(0.0, 0.0, -2.0, 5.0, 0.0, 0.0));
/// assert_eq!(wrench.torque(), Vector3::new(0.005, 0.0, 0.0));
/// ```
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
///
/// ```
/// use fingertip_wrench::{Inverse, SensorMatrix, WrenchSolver};
/// use nalgebra::{Matrix6, Vector6};
///
/// // 2 V at nominal load: half a nominal load per volt.
/// let sensor = SensorMatrix::new(Matrix6::from_diagonal_element(2.0), Vector6::repeat(10.0_f64))?;
/// let map = Inverse::new(&sensor)?.linear_map(&sensor).unwrap();
/// assert_eq!(map.gain, Matrix6::from_diagonal_element(0.5));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
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
///
/// ```
/// use fingertip_wrench::{Inverse, SensorMatrix, WrenchSolver};
/// use nalgebra::{Matrix6, Vector6};
///
/// let sensor = SensorMatrix::new(Matrix6::from_diagonal_element(2.0), Vector6::repeat(10.0_f64))?;
/// let own_error = Inverse::new(&sensor)?.linear_map(&sensor).unwrap().own_error;
/// // It neglects nothing and rounds a few times; an error of a signal becomes half as many nominal loads.
/// assert!(own_error.per_load.amax() < 1e-14 && own_error.per_signal.amax() < 1e-14);
/// assert!((own_error.magnitude[(0, 0)] - 0.5).abs() < 1e-14);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnError<T: Real, const N: usize> {
    /// The part that grows with the load.
    pub per_load: Matrix6<T>,
    /// The part that grows with the signals.
    pub per_signal: SMatrix<T, 6, N>,
    /// What becomes of an error of the signals: magnitudes of the entries of the map.
    pub magnitude: SMatrix<T, 6, N>,
}
