//! The worst error of a solve.

use nalgebra::{Matrix6, SMatrix, SVector, Vector6};
use thiserror::Error;

use crate::solve::closely::Closely;
use crate::solve::nonnegative::neumann;
use crate::{LinearMap, Real, SensorMatrix, Wrench, WrenchSolver};

/// What is not known of a sensor, as worst cases. Plain data; all zero means that only the solver's
/// own error counts.
///
/// ```
/// use fingertip_wrench::{SensorMatrix, Uncertainty};
/// use nalgebra::{Matrix6, Vector6};
///
/// // Signals within 2 mV; a calibration that is good to 1 % of the 2 V that a gauge gives at most.
/// let sensor = SensorMatrix::new(Matrix6::from_diagonal_element(2.0), Vector6::repeat(10.0))?;
/// let signals = Vector6::repeat(2e-3);
/// let uncertainty = Uncertainty::of_signals(signals).with_relative_matrix_error(&sensor, 0.01);
/// assert_eq!(uncertainty.signals[0], 2e-3);
/// assert_eq!(uncertainty.matrix[(4, 0)], 0.02); // crosstalk that is not in the matrix may be there
/// # Ok::<(), fingertip_wrench::SensorMatrixError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Uncertainty<T: Real, const N: usize> {
    /// Per gauge: the most that a signal may be off, in the unit of the signals.
    pub signals: SVector<T, N>,
    /// Per entry: the most that the normalised sensor matrix may be off.
    pub matrix: SMatrix<T, N, 6>,
}

impl<T: Real, const N: usize> Uncertainty<T, N> {
    /// Nothing unknown.
    #[must_use]
    pub fn none() -> Self {
        Self { signals: SVector::zeros(), matrix: SMatrix::zeros() }
    }

    /// Signals off by at most this much each; the matrix exact.
    #[must_use]
    pub fn of_signals(signals: SVector<T, N>) -> Self {
        Self { signals, matrix: SMatrix::zeros() }
    }

    /// The same, and every entry of the matrix off by at most a fraction of the largest entry of its
    /// column: what a calibration that is good to, say, 1 % of full scale promises.
    #[must_use]
    pub fn with_relative_matrix_error(self, sensor: &SensorMatrix<T, N>, fraction: T) -> Self {
        let c = sensor.normalised();
        Self { matrix: SMatrix::from_fn(|_, axis| c.column(axis).amax() * fraction), ..self }
    }
}

/// Bounds the error of each component of a wrench, sample by sample.
///
/// If the true sensor obeys `signals = (C + dC)·P + dV` with `|dC|` and `|dV|` within the
/// [`Uncertainty`], then the wrench that the solver gives is off by at most what
/// [`at`](Self::at) says: neglected couplings of a [`Decoupled`](crate::Decoupled) solver, the
/// uncertainty of the matrix, the noise of the signals and all rounding included.
///
/// With `S` the solver's map, the true load `P` and its estimate `P̂` differ by
/// `e ≤ |SC − I||P| + |S||dC||P| + |S||dV| + rounding`, and `|P| ≤ |P̂| + e`; so, with
/// `G = |SC − I| + |S||dC| + …`, `e ≤ (I − G)⁻¹ (G|P̂| + |S||dV| + …)` as long as the powers of
/// `G` vanish. What rounding does is counted beforehand ([`OwnError`](crate::OwnError) has the terms), and, since a
/// count of the worst signs is a hundred times what happens, also found of the very sample: `P̂ − S·signals` in twice
/// the precision (`docs/theory/wrench.md#error-bound-of-a-solve`). The smaller of both bounds is told. All else is
/// multiplied out at construction; a sample costs some products of six by as many numbers as there are gauges, two of
/// them in twice the precision.
///
/// ```
/// use fingertip_wrench::{ErrorBound, Inverse, SensorMatrix, Uncertainty, WrenchSolver};
/// use nalgebra::{Matrix6, Vector6};
///
/// let sensor = SensorMatrix::new(Matrix6::from_diagonal_element(2.0), Vector6::repeat(10.0))?;
/// let solver = Inverse::new(&sensor)?;
/// // 2 V at 10 N, signals within 2 mV: 10 mN.
/// let bound = ErrorBound::new(&sensor, &solver, &Uncertainty::of_signals(Vector6::repeat(0.002)))?;
/// let signals = Vector6::new(0.5_f64, 0.0, 0.0, 0.0, 0.0, 0.0);
/// let error = bound.at(&signals, &solver.solve(&signals));
/// assert!((error[0] - 0.01_f64).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorBound<T: Real, const N: usize> {
    per_load: Matrix6<T>,
    per_signal: SMatrix<T, 6, N>,
    constant: Vector6<T>,
    closely: Closely<T, N>,
    floor: Vector6<T>,
}

/// Why a solver's error has no bound.
///
/// ```
/// use fingertip_wrench::{ErrorBound, Inverse, NoErrorBound, SensorMatrix, Uncertainty};
/// use nalgebra::{Matrix6, Vector6};
///
/// let sensor = SensorMatrix::new(Matrix6::identity(), Vector6::repeat(1.0_f64))?;
/// let solver = Inverse::new(&sensor)?;
/// // Every entry may be off by half of the largest in its column: such a matrix may be singular.
/// let uncertainty = Uncertainty::none().with_relative_matrix_error(&sensor, 0.5);
/// let refused = ErrorBound::new(&sensor, &solver, &uncertainty).unwrap_err();
/// assert_eq!(refused, NoErrorBound::Unbounded);
/// let told = "no bound: within the uncertainty of its matrix the sensor may be singular";
/// assert!(refused.to_string().starts_with(told));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum NoErrorBound {
    /// An uncertainty is negative, NaN or infinite.
    #[error("the uncertainty of gauge {gauge} is negative or not a finite number")]
    BadUncertainty {
        /// Which gauge, counted from 0.
        gauge: usize,
    },
    /// Within its uncertainty the matrix may be singular, or the solver was built for another
    /// sensor, or neglects as much as it keeps.
    #[error(
        "no bound: within the uncertainty of its matrix the sensor may be singular, or the solver is not one \
         of this sensor"
    )]
    Unbounded,
    /// The solver does not say what [linear map](WrenchSolver::linear_map) it is.
    #[error("no bound: the solver does not say what linear map it is")]
    NotLinear,
}

impl<T: Real, const N: usize> ErrorBound<T, N> {
    /// Multiplies out the bound.
    ///
    /// # Errors
    /// [`NoErrorBound`].
    pub fn new(
        sensor: &SensorMatrix<T, N>,
        solver: &impl WrenchSolver<T, N>,
        uncertainty: &Uncertainty<T, N>,
    ) -> Result<Self, NoErrorBound> {
        let valid = |x: &T| *x >= T::zero() && x.is_number();
        if let Some(gauge) = (0..N).position(|gauge| {
            !(valid(&uncertainty.signals[gauge]) && uncertainty.matrix.row(gauge).iter().all(valid))
        }) {
            return Err(NoErrorBound::BadUncertainty { gauge });
        }
        let LinearMap { gain, own_error: own } = solver.linear_map(sensor).ok_or(NoErrorBound::NotLinear)?;
        let relative = own.per_load + own.magnitude * uncertainty.matrix;
        let amplified = neumann(&relative).ok_or(NoErrorBound::Unbounded)?;
        // The bound itself is computed with rounding: some sixty operations on positive numbers.
        let margin = T::one() + T::EPSILON * T::literal(64.0 + 4.0 * N as f64);
        let nominal = Matrix6::from_diagonal(sensor.nominal()) * margin;
        let per_load_normalised = nominal * amplified * relative;
        let bound = Self {
            per_load: Matrix6::from_fn(|i, j| per_load_normalised[(i, j)] / sensor.nominal()[j]),
            per_signal: nominal * amplified * own.per_signal,
            constant: nominal * amplified * (own.magnitude * uncertainty.signals),
            closely: Closely::new(sensor, &gain, uncertainty, margin),
            floor: Vector6::zeros(),
        };
        let bound = Self { floor: bound.at(&SVector::zeros(), &Wrench::zero()), ..bound };
        let finite = bound.per_load.iter().chain(bound.per_signal.iter()).chain(bound.constant.iter());
        if finite.copied().all(T::is_number) { Ok(bound) } else { Err(NoErrorBound::Unbounded) }
    }

    /// Bound on the error of each component \[N, N, N, N·m, N·m, N·m\] of the wrench that the solver
    /// gave for these signals; not finite for a wrench or signals that are not.
    #[inline]
    #[must_use]
    pub fn at(&self, signals: &SVector<T, N>, wrench: &Wrench<T>) -> Vector6<T> {
        let (load, reading) = (wrench.components().abs(), signals.abs());
        let counted = self.per_load * load + self.per_signal * reading + self.constant;
        // False for a NaN, which a residual beyond the range of the type is.
        self.closely
            .at(signals, wrench)
            .zip_map(&counted, |found, counted| if found < counted { found } else { counted })
    }

    /// The part that is there without load: the floor that noise sets \[N, N, N, N·m, N·m, N·m\].
    #[inline]
    #[must_use]
    pub const fn floor(&self) -> &Vector6<T> {
        &self.floor
    }
}
