//! More gauges than loads.

use nalgebra::{Matrix6, SMatrix, SVector};
use thiserror::Error;

use crate::scalar::rounding::relative_rounding;
use crate::solve::compensated::matrix_residual;
use crate::solve::orthogonal::{DependentColumn, Orthogonal};
use crate::{LinearMap, OwnError, Real, SensorMatrix, Wrench, WrenchSolver};

/// The solver for extended sensors (N > 6 gauges; 6 work too): least squares, weighted or not.
///
/// A solve is one 6×N product with the pseudo-inverse, which an orthogonal factorisation gives
/// (never the normal equations). Redundant gauges watch each other:
/// [`residual`](Self::residual) is the part of the signals that no load explains,
/// [`predicted`](Self::predicted) what a gauge ought to read by the others,
/// [`solve_without`](Self::solve_without) the wrench without it. The factors of all of these are
/// prepared at construction; [`ConsistencyCheck`](crate::ConsistencyCheck) draws the conclusions.
///
/// ```
/// use fingertip_wrench::{LeastSquares, SensorMatrix, WrenchSolver};
/// use nalgebra::{SMatrix, SVector, Vector6};
///
/// // A gauge for each load, and a seventh that sees all of them.
/// let sees = |gauge, axis| gauge == axis || gauge == 6;
/// let matrix = SMatrix::<f64, 7, 6>::from_fn(|gauge, axis| if sees(gauge, axis) { 1.0 } else { 0.0 });
/// let solver = LeastSquares::new(&SensorMatrix::new(matrix, Vector6::repeat(1.0))?)?;
/// let load = Vector6::new(1.0, 2.0, -3.0, 0.1, 0.2, 0.3);
/// let mut signals: SVector<f64, 7> = matrix * load;
/// assert!((solver.solve(&signals).components() - load).amax() < 1e-14);
/// // The wire of gauge 2 comes off: the others tell what it would have read.
/// signals[2] = f64::NAN;
/// assert!((solver.predicted(&signals, 2).unwrap() + 3.0).abs() < 1e-14);
/// assert!((solver.solve_without(&signals, 2).unwrap().components() - load).amax() < 1e-14);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastSquares<T: Real, const N: usize> {
    /// Newtons and newton metres per signal.
    gain: SMatrix<T, 6, N>,
    /// Signal to residual, in signal units.
    residual: SMatrix<T, N, N>,
    /// Row `k` predicts signal `k` from the others: its diagonal is zero, and so is the row of a
    /// gauge that cannot be missed.
    prediction: SMatrix<T, N, N>,
    redundancy: SVector<T, N>,
}

/// Why least squares has no unique answer.
///
/// ```
/// use fingertip_wrench::{LeastSquares, LeastSquaresError, SensorMatrix};
/// use nalgebra::{SMatrix, Vector6};
///
/// // Eight gauges, to which a torque about z is what a force along z is.
/// let sees = |gauge, axis| gauge % 5 == if axis == 5 { 2 } else { axis };
/// let matrix = SMatrix::<f64, 8, 6>::from_fn(|gauge, axis| if sees(gauge, axis) { 1.0 } else { 0.0 });
/// let refused = LeastSquares::new(&SensorMatrix::new(matrix, Vector6::repeat(1.0))?).unwrap_err();
/// assert_eq!(refused, LeastSquaresError::DependentAxis { axis: 5 });
/// assert_eq!(refused.to_string(), "no combination of gauges tells axis 5 from the other axes");
/// # Ok::<(), fingertip_wrench::SensorMatrixError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum LeastSquaresError {
    /// The gauges cannot tell an axis from others.
    #[error("no combination of gauges tells axis {axis} from the other axes")]
    DependentAxis {
        /// Which of Fx, Fy, Fz, Tx, Ty, Tz.
        axis: usize,
    },
    /// A standard deviation is zero, negative, NaN or infinite.
    #[error("the standard deviation of gauge {gauge} is not a positive finite number")]
    BadDeviation {
        /// Which gauge, counted from 0.
        gauge: usize,
    },
    /// Entries leave the range of the scalar type.
    #[error("the sensor matrix, a weight or a nominal load is too large or too small for the scalar type")]
    OutOfRange,
}

impl<T: Real, const N: usize> LeastSquares<T, N> {
    /// Every gauge equally trusted.
    ///
    /// # Errors
    /// [`LeastSquaresError`]; a matrix is singular to working precision as for
    /// [`GaussianElimination`](crate::GaussianElimination).
    pub fn new(sensor: &SensorMatrix<T, N>) -> Result<Self, LeastSquaresError> {
        Self::weighted(sensor, &SVector::repeat(T::one()))
    }

    /// Every gauge trusted as its noise deserves: `deviations` are standard deviations of the
    /// signals; only their ratios matter. With the true ones the answer has the least
    /// variance that any unbiased one can have.
    ///
    /// # Errors
    /// [`LeastSquaresError`].
    pub fn weighted(
        sensor: &SensorMatrix<T, N>,
        deviations: &SVector<T, N>,
    ) -> Result<Self, LeastSquaresError> {
        if let Some(gauge) = deviations.iter().position(|x| !(*x > T::zero() && x.is_number())) {
            return Err(LeastSquaresError::BadDeviation { gauge });
        }
        let scale = deviations.amax().normalising_factor();
        let weights = deviations.map(|deviation| T::one() / (deviation * scale));
        let whitened = SMatrix::<T, N, 6>::from_fn(|i, j| sensor.normalised()[(i, j)] * weights[i]);
        if !whitened.iter().chain(weights.iter()).all(|x| x.is_number()) {
            return Err(LeastSquaresError::OutOfRange);
        }
        let factors = Orthogonal::new(&whitened)
            .map_err(|DependentColumn(axis)| LeastSquaresError::DependentAxis { axis })?;
        if let Some(axis) = indistinct_axis(&whitened, &factors.pseudo_inverse) {
            return Err(LeastSquaresError::DependentAxis { axis });
        }
        let gain = SMatrix::from_fn(|axis, gauge| {
            factors.pseudo_inverse[(axis, gauge)] * weights[gauge] * sensor.nominal()[axis]
        });
        let complement = &factors.complement;
        let residual = SMatrix::from_fn(|i, j| complement[(i, j)] * weights[j] / weights[i]);
        let redundancy = complement.diagonal();
        // Of an orthonormal basis computed to N·ε, this much is noise.
        let least = T::EPSILON * T::literal(8.0 * N as f64);
        let least = least * least;
        let prediction = SMatrix::from_fn(|i, j| {
            if i == j || redundancy[i] <= least { T::zero() } else { -residual[(i, j)] / redundancy[i] }
        });
        let redundancy = redundancy.map(|x| if x <= least { T::zero() } else { x });
        let solver = Self { gain, residual, prediction, redundancy };
        let entries = solver.gain.iter().chain(solver.residual.iter()).chain(solver.prediction.iter());
        if entries.copied().all(T::is_number) { Ok(solver) } else { Err(LeastSquaresError::OutOfRange) }
    }

    /// The matrix that takes signals to newtons and newton metres.
    #[inline]
    #[must_use]
    pub const fn matrix(&self) -> &SMatrix<T, 6, N> {
        &self.gain
    }

    /// The consistency residual `(I − C C⁺)·signals`: what no load explains, in signal units. Zero
    /// but for rounding with six gauges.
    #[inline]
    #[must_use]
    pub fn residual(&self, signals: &SVector<T, N>) -> SVector<T, N> {
        self.residual * signals
    }

    /// The matrix that takes signals to their residual.
    #[inline]
    #[must_use]
    pub const fn residual_matrix(&self) -> &SMatrix<T, N, N> {
        &self.residual
    }

    /// How much of an error of a gauge shows in its own residual, 0 to 1: 0 for a gauge that no
    /// other can stand in for, or that is not there.
    #[inline]
    #[must_use]
    pub fn redundancy(&self, gauge: usize) -> T {
        self.redundancy.get(gauge).copied().unwrap_or(T::zero())
    }

    /// What a gauge ought to read by the other gauges; its own signal is not looked at and may be
    /// NaN. `None` for a gauge that the others cannot replace.
    #[inline]
    #[must_use]
    pub fn predicted(&self, signals: &SVector<T, N>, gauge: usize) -> Option<T> {
        if self.redundancy(gauge) > T::zero() {
            let others = (0..N).filter(|other| *other != gauge);
            Some(others.fold(T::zero(), |sum, other| sum + self.prediction[(gauge, other)] * signals[other]))
        } else {
            None
        }
    }

    /// The signals with that of one gauge replaced by its prediction: to least squares, as if the
    /// gauge were not there. `None` for a gauge that the others cannot replace.
    #[inline]
    #[must_use]
    pub fn repaired(&self, signals: &SVector<T, N>, gauge: usize) -> Option<SVector<T, N>> {
        let predicted = self.predicted(signals, gauge)?;
        let mut repaired = *signals;
        repaired[gauge] = predicted;
        Some(repaired)
    }

    /// The least-squares wrench of all gauges but one. `None` for a gauge that the others cannot
    /// replace.
    #[inline]
    #[must_use]
    pub fn solve_without(&self, signals: &SVector<T, N>, gauge: usize) -> Option<Wrench<T>> {
        Some(self.solve(&self.repaired(signals, gauge)?))
    }
}

/// An axis whose answer would have no correct digit, if there is one: Skeel's condition number of the matrix
/// with its columns equilibrated exceeds `1/(8ε)` there. The remainder of a column in the factorisation would
/// bound this from one side only.
fn indistinct_axis<T: Real, const N: usize>(
    matrix: &SMatrix<T, N, 6>,
    inverse: &SMatrix<T, 6, N>,
) -> Option<usize> {
    let scale = SVector::<T, 6>::from_fn(|axis, _| matrix.column(axis).amax().normalising_factor());
    let scaled = SMatrix::<T, N, 6>::from_fn(|gauge, axis| matrix[(gauge, axis)].abs() * scale[axis]);
    let rows = SMatrix::<T, 6, N>::from_fn(|axis, gauge| inverse[(axis, gauge)].abs() / scale[axis]);
    let sums = (rows * scaled).column_sum();
    let worst = (1..6).fold(0, |worst, axis| if sums[axis] > sums[worst] { axis } else { worst });
    if sums[worst] * T::EPSILON * T::literal(8.0) < T::one() { None } else { Some(worst) }
}

impl<T: Real, const N: usize> WrenchSolver<T, N> for LeastSquares<T, N> {
    #[inline]
    fn solve(&self, signals: &SVector<T, N>) -> Wrench<T> {
        Wrench::from_components(&(self.gain * signals))
    }

    fn linear_map(&self, sensor: &SensorMatrix<T, N>) -> Option<LinearMap<T, N>> {
        let gain = self.gain(sensor);
        Some(LinearMap { gain, own_error: self.own_error(sensor, &gain) })
    }
}

impl<T: Real, const N: usize> LeastSquares<T, N> {
    fn gain(&self, sensor: &SensorMatrix<T, N>) -> SMatrix<T, 6, N> {
        SMatrix::from_fn(|axis, gauge| self.gain[(axis, gauge)] / sensor.nominal()[axis])
    }

    /// `N` roundings of a product of `N` terms, one of the division in [`gain`](Self::gain).
    fn own_error(&self, sensor: &SensorMatrix<T, N>, gain: &SMatrix<T, 6, N>) -> OwnError<T, N> {
        let per_load = matrix_residual(&Matrix6::identity(), gain, sensor.normalised()).abs();
        OwnError { per_load, per_signal: gain.abs() * relative_rounding::<T>(N + 1), magnitude: gain.abs() }
    }
}
