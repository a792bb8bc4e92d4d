//! The likely error of a solve.

use nalgebra::{Matrix6, SMatrix, SVector};
use thiserror::Error;

use crate::{Real, SensorMatrix, Wrench, WrenchSolver};

/// The covariance of the wrench, to first order.
///
/// From the noise of the signals it is the same for every sample, `S Σ Sᵀ` with `S` the solver's
/// map; the uncertainty of the matrix adds a part that grows with the load: gauge `i` is uncertain
/// by `Σⱼ var(Cᵢⱼ) Pⱼ²`. Independent errors of the entries are assumed. Bias (neglected couplings
/// of a [`Decoupled`](crate::Decoupled) solver) has no covariance: see
/// [`ErrorBound`](crate::ErrorBound).
///
/// ```
/// use fingertip_wrench::{Inverse, SensorMatrix, WrenchCovariance};
/// use nalgebra::{Matrix6, Vector6};
///
/// // 2 V at 10 N, with 2 mV of noise: 10 mN.
/// let sensor = SensorMatrix::new(Matrix6::from_diagonal_element(2.0), Vector6::repeat(10.0))?;
/// let solver = Inverse::new(&sensor)?;
/// let covariance = WrenchCovariance::from_noise(&sensor, &solver, &Vector6::repeat(2e-3))?;
/// let variance: f64 = covariance.floor()[(0, 0)];
/// assert!((variance.sqrt() - 0.01).abs() < 1e-15);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchCovariance<T: Real, const N: usize> {
    constant: Matrix6<T>,
    /// Newtons and newton metres per signal.
    gain: SMatrix<T, 6, N>,
    /// Variance of a signal per square newton or newton metre.
    per_squared_load: SMatrix<T, N, 6>,
}

/// Why there is no covariance.
///
/// ```
/// use fingertip_wrench::{BadCovariance, Inverse, SensorMatrix, WrenchCovariance};
/// use nalgebra::{Matrix6, Vector6};
///
/// let sensor = SensorMatrix::new(Matrix6::identity(), Vector6::repeat(1.0_f64))?;
/// let noise = Vector6::new(1e-3, 1e-3, -1e-3, 1e-3, 1e-3, 1e-3);
/// let refused = WrenchCovariance::from_noise(&sensor, &Inverse::new(&sensor)?, &noise).unwrap_err();
/// assert_eq!(refused, BadCovariance::BadNoise { gauge: 2 });
/// assert_eq!(refused.to_string(), "the noise of gauge 2 is not a standard deviation or variance");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadCovariance {
    /// A standard deviation is negative, NaN or infinite, or a covariance matrix is not symmetric
    /// or has a negative diagonal.
    #[error("the noise of gauge {gauge} is not a standard deviation or variance")]
    BadNoise {
        /// Which gauge, counted from 0.
        gauge: usize,
    },
    /// The result leaves the range of the scalar type.
    #[error("the covariance of the wrench is too large or too small for the scalar type")]
    OutOfRange,
    /// The solver does not say what [linear map](WrenchSolver::linear_map) it is.
    #[error("the solver does not say what linear map it is")]
    NotLinear,
}

impl<T: Real, const N: usize> WrenchCovariance<T, N> {
    /// From the standard deviation of each signal (a tare gives it), independent of each other.
    ///
    /// # Errors
    /// [`BadCovariance`].
    pub fn from_noise(
        sensor: &SensorMatrix<T, N>,
        solver: &impl WrenchSolver<T, N>,
        deviations: &SVector<T, N>,
    ) -> Result<Self, BadCovariance> {
        if let Some(gauge) = deviations.iter().position(|x| !(*x >= T::zero() && x.is_number())) {
            return Err(BadCovariance::BadNoise { gauge });
        }
        Self::new(sensor, solver, &SMatrix::from_diagonal(&deviations.component_mul(deviations)))
    }

    /// From the covariance matrix of the signals.
    ///
    /// # Errors
    /// [`BadCovariance`].
    pub fn new(
        sensor: &SensorMatrix<T, N>,
        solver: &impl WrenchSolver<T, N>,
        signals: &SMatrix<T, N, N>,
    ) -> Result<Self, BadCovariance> {
        let valid = |gauge: usize| {
            signals[(gauge, gauge)] >= T::zero()
                && (0..N).all(|other| {
                    let (a, b) = (signals[(gauge, other)], signals[(other, gauge)]);
                    a.is_number() && (a - b).abs() <= (a.abs() + b.abs()) * T::EPSILON * T::literal(8.0)
                })
        };
        if let Some(gauge) = (0..N).position(|gauge| !valid(gauge)) {
            return Err(BadCovariance::BadNoise { gauge });
        }
        let normalised = solver.linear_map(sensor).ok_or(BadCovariance::NotLinear)?.gain;
        let gain = SMatrix::from_fn(|axis, gauge| normalised[(axis, gauge)] * sensor.nominal()[axis]);
        let constant = symmetric(&(gain * signals * gain.transpose()));
        if !constant.iter().all(|x| x.is_number()) {
            return Err(BadCovariance::OutOfRange);
        }
        Ok(Self { constant, gain, per_squared_load: SMatrix::zeros() })
    }

    /// Adds the uncertainty of the matrix: the standard deviation of each entry of the normalised
    /// matrix, as a calibration reports it.
    ///
    /// # Errors
    /// [`BadCovariance`].
    pub fn with_matrix_deviations(
        self,
        sensor: &SensorMatrix<T, N>,
        deviations: &SMatrix<T, N, 6>,
    ) -> Result<Self, BadCovariance> {
        let valid = |x: &T| *x >= T::zero() && x.is_number();
        if let Some(gauge) = (0..N).position(|gauge| !deviations.row(gauge).iter().all(valid)) {
            return Err(BadCovariance::BadNoise { gauge });
        }
        let per_squared_load = SMatrix::<T, N, 6>::from_fn(|gauge, axis| {
            let per_load = deviations[(gauge, axis)] / sensor.nominal()[axis];
            per_load * per_load
        });
        if !per_squared_load.iter().all(|x| x.is_number()) {
            return Err(BadCovariance::OutOfRange);
        }
        Ok(Self { per_squared_load, ..self })
    }

    /// The part from the noise of the signals: the covariance of an unloaded sensor
    /// \[N², N·N·m, N²·m²\].
    #[inline]
    #[must_use]
    pub const fn floor(&self) -> &Matrix6<T> {
        &self.constant
    }

    /// The covariance of this wrench \[N², N·N·m, N²·m²\]: symmetric.
    #[must_use]
    pub fn at(&self, wrench: &Wrench<T>) -> Matrix6<T> {
        let loads = wrench.components();
        let variances = self.per_squared_load * loads.component_mul(&loads);
        let weighted = SMatrix::<T, 6, N>::from_fn(|axis, gauge| self.gain[(axis, gauge)] * variances[gauge]);
        symmetric(&(self.constant + weighted * self.gain.transpose()))
    }
}

/// Takes the last digits' asymmetry out.
fn symmetric<T: Real>(matrix: &Matrix6<T>) -> Matrix6<T> {
    (matrix + matrix.transpose()) * T::literal(0.5)
}
