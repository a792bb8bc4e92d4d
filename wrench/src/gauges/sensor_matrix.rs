//! The linear model of a force sensor.

use nalgebra::{SMatrix, SVector, Vector6};
use thiserror::Error;

use crate::stored;
use crate::{Real, Wrench};

/// The sensor matrix **C**: `signals = C · (wrench / nominal loads)` (equations (10), (11) of
/// Bicchi & Dario 1987).
///
/// `N` gauges, six columns Fx, Fy, Fz, Tx, Ty, Tz. An entry is the signal (volts or counts, after
/// tare) that gauge `row` gives under the nominal load of axis `column`. `N = 6` is a *minimal*
/// sensor, `N > 6` an *extended* one.
///
/// The wrench is the load on the fingertip about the origin of the sensor frame.
///
/// ```
/// use fingertip_wrench::{SensorMatrix, Wrench};
/// use nalgebra::{Matrix6, Vector3, Vector6};
///
/// // Each gauge gives 2 V at the nominal load of its axis: 10 N or 0.1 N·m.
/// let nominal = Vector6::new(10.0, 10.0, 10.0, 0.1, 0.1, 0.1);
/// let sensor = SensorMatrix::new(Matrix6::from_diagonal_element(2.0), nominal)?;
/// let load = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -5.0), Vector3::new(0.1, 0.0, 0.0));
/// assert_eq!(sensor.signals(&load), Vector6::new(0.0, 0.0, -1.0, 2.0, 0.0, 0.0));
/// # Ok::<(), fingertip_wrench::SensorMatrixError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorMatrix<T: Real, const N: usize> {
    normalised: SMatrix<T, N, 6>,
    nominal: Vector6<T>,
}

/// Why a matrix cannot be that of a sensor. Rows and columns count from 0.
///
/// ```
/// use fingertip_wrench::{SensorMatrix, SensorMatrixError};
/// use nalgebra::{Matrix6, Vector6};
///
/// let mut matrix = Matrix6::<f64>::identity();
/// matrix[(3, 3)] = 0.0; // the wire of gauge 3 came off
/// let refused = SensorMatrix::new(matrix, Vector6::repeat(1.0)).unwrap_err();
/// assert_eq!(refused, SensorMatrixError::DeadGauge { gauge: 3 });
/// assert_eq!(refused.to_string(), "gauge 3 answers to no load: its row is zero");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SensorMatrixError {
    /// Fewer than six gauges.
    #[error("a sensor of six components needs at least 6 gauges, not {gauges}")]
    TooFewGauges {
        /// How many gauges the matrix has.
        gauges: usize,
    },
    /// An entry is NaN or infinite.
    #[error("the entry of gauge {gauge}, axis {axis} is not a finite number")]
    NotFinite {
        /// Row of the entry.
        gauge: usize,
        /// Column of the entry.
        axis: usize,
    },
    /// A nominal load is zero, negative or not finite.
    #[error("the nominal load of axis {axis} is not a positive finite number")]
    BadNominalLoad {
        /// Which of Fx, Fy, Fz, Tx, Ty, Tz.
        axis: usize,
    },
    /// A gauge that answers to no load.
    #[error("gauge {gauge} answers to no load: its row is zero")]
    DeadGauge {
        /// Row that is zero.
        gauge: usize,
    },
    /// A load that no gauge answers to.
    #[error("no gauge answers to axis {axis}: its column is zero")]
    BlindAxis {
        /// Column that is zero.
        axis: usize,
    },
}

impl<T: Real, const N: usize> SensorMatrix<T, N> {
    /// From the normalised matrix (signal per nominal load) and the six nominal loads
    /// \[N, N, N, N·m, N·m, N·m\].
    ///
    /// # Errors
    /// [`SensorMatrixError`] for fewer than six gauges, an entry that is not finite, a nominal load
    /// that is not positive, a zero row or a zero column.
    pub fn new(normalised: SMatrix<T, N, 6>, nominal: Vector6<T>) -> Result<Self, SensorMatrixError> {
        if N < 6 {
            return Err(SensorMatrixError::TooFewGauges { gauges: N });
        }
        for (axis, column) in normalised.column_iter().enumerate() {
            if let Some(gauge) = column.iter().position(|x| !x.is_number()) {
                return Err(SensorMatrixError::NotFinite { gauge, axis });
            }
        }
        if let Some(axis) = nominal.iter().position(|x| !(*x > T::zero() && x.is_number())) {
            return Err(SensorMatrixError::BadNominalLoad { axis });
        }
        if let Some(gauge) = normalised.row_iter().position(|row| row.iter().all(|x| x.is_zero())) {
            return Err(SensorMatrixError::DeadGauge { gauge });
        }
        if let Some(axis) = normalised.column_iter().position(|column| column.iter().all(|x| x.is_zero())) {
            return Err(SensorMatrixError::BlindAxis { axis });
        }
        Ok(Self { normalised, nominal })
    }

    /// From a matrix in signal per newton and signal per newton metre, normalised here by the
    /// nominal loads.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_sensitivities(
        sensitivities: SMatrix<T, N, 6>,
        nominal: Vector6<T>,
    ) -> Result<Self, SensorMatrixError> {
        let mut normalised = sensitivities;
        for (mut column, load) in normalised.column_iter_mut().zip(nominal.iter()) {
            column *= *load;
        }
        Self::new(normalised, nominal)
    }

    /// The normalised matrix: signal per nominal load.
    #[inline]
    #[must_use]
    pub const fn normalised(&self) -> &SMatrix<T, N, 6> {
        &self.normalised
    }

    /// The nominal loads \[N, N, N, N·m, N·m, N·m\].
    #[inline]
    #[must_use]
    pub const fn nominal(&self) -> &Vector6<T> {
        &self.nominal
    }

    /// The signals that a wrench gives (the forward model).
    #[inline]
    #[must_use]
    pub fn signals(&self, wrench: &Wrench<T>) -> SVector<T, N> {
        self.normalised * wrench.components().component_div(&self.nominal)
    }
}

stored! {
    SensorMatrix<T, N>, [T: Real, const N: usize],
    |matrix| { normalised: SMatrix<T, N, 6> = matrix.normalised, nominal: Vector6<T> = matrix.nominal },
    Self::new(normalised, nominal)
}
