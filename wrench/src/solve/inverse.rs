//! One matrix product.

use nalgebra::{Matrix6, Vector6};
use thiserror::Error;

use crate::scalar::rounding::relative_rounding;
use crate::solve::compensated::matrix_residual;
use crate::{
    GaussianElimination, LinearMap, OwnError, Real, SensorMatrix, SensorMatrixError, SingularMatrix, Wrench,
    WrenchSolver,
};

/// The inverse of the sensor matrix, multiplied with each reading: the fastest general solver.
///
/// The inverse itself is refined at construction until its entries are right to the last digit or
/// two, so what is lost is lost in the product alone. Still the answer satisfies the equations less
/// well than that of [`GaussianElimination`]: where elimination leaves a residual of a few rounding
/// errors *whatever the matrix*, the product leaves up to
/// [`residual_growth`](Self::residual_growth) times as much. [`ErrorBound`](crate::ErrorBound) says
/// what that means for the wrench.
///
/// ```
/// use fingertip_wrench::{Inverse, SensorMatrix, WrenchSolver};
/// use nalgebra::{Matrix6, Vector6};
///
/// let sensor = SensorMatrix::new(Matrix6::from_diagonal_element(2.0), Vector6::repeat(10.0))?;
/// let solver = Inverse::new(&sensor)?;
/// assert_eq!(solver.matrix()[(0, 0)], 5.0); // newtons per volt
/// assert_eq!(solver.solve(&Vector6::new(0.0, 0.0, -1.0, 0.0, 0.0, 0.0)).force().z, -5.0);
/// assert_eq!(solver.residual_growth(), 1.0); // a diagonal matrix loses nothing
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inverse<T: Real> {
    /// Newtons and newton metres per signal.
    matrix: Matrix6<T>,
    residual_growth: T,
}

impl<T: Real> Inverse<T> {
    /// Inverts the matrix.
    ///
    /// # Errors
    /// As [`GaussianElimination::new`].
    pub fn new(sensor: &SensorMatrix<T, 6>) -> Result<Self, SingularMatrix> {
        let inverse = GaussianElimination::new(sensor)?.gain(sensor);
        let matrix = Matrix6::from_fn(|axis, gauge| inverse[(axis, gauge)] * sensor.nominal()[axis]);
        let residual_growth = (sensor.normalised().abs() * inverse.abs()).column_sum().amax();
        if matrix.iter().all(|x| x.is_number()) && residual_growth.is_number() {
            Ok(Self { matrix, residual_growth })
        } else {
            Err(SingularMatrix::OutOfRange)
        }
    }

    /// The matrix that takes signals to newtons and newton metres.
    #[inline]
    #[must_use]
    pub const fn matrix(&self) -> &Matrix6<T> {
        &self.matrix
    }

    /// By what factor the residual `signals − C·answer` may exceed a rounding error of the largest
    /// signal: `‖|C||C⁻¹|‖∞`, at least 1.
    #[inline]
    #[must_use]
    pub const fn residual_growth(&self) -> T {
        self.residual_growth
    }
}

impl<T: Real> WrenchSolver<T, 6> for Inverse<T> {
    #[inline]
    fn solve(&self, signals: &Vector6<T>) -> Wrench<T> {
        Wrench::from_components(&(self.matrix * signals))
    }

    fn linear_map(&self, sensor: &SensorMatrix<T, 6>) -> Option<LinearMap<T, 6>> {
        let gain = self.gain(sensor);
        Some(LinearMap { gain, own_error: self.own_error(sensor, &gain) })
    }
}

impl<T: Real> Inverse<T> {
    fn gain(&self, sensor: &SensorMatrix<T, 6>) -> Matrix6<T> {
        Matrix6::from_fn(|axis, gauge| self.matrix[(axis, gauge)] / sensor.nominal()[axis])
    }

    /// How far the matrix itself is from the inverse, and the roundings of its product with the signals, counted:
    /// that adds column after column, so that a term is rounded once, and once with each sum from its own on.
    fn own_error(&self, sensor: &SensorMatrix<T, 6>, gain: &Matrix6<T>) -> OwnError<T, 6> {
        let nominal = sensor.nominal();
        let defect = matrix_residual(&Matrix6::from_diagonal(nominal), &self.matrix, sensor.normalised());
        // Of the divisions, which no solve does.
        let margin = T::one() + relative_rounding::<T>(2);
        let per_load = Matrix6::from_fn(|i, j| defect[(i, j)].abs() / nominal[i] * margin);
        let magnitude = gain.abs() * margin;
        let roundings = |gauge: usize| relative_rounding::<T>(1 + 5_usize.min(6 - gauge));
        let per_signal = Matrix6::from_fn(|i, gauge| magnitude[(i, gauge)] * roundings(gauge));
        OwnError { per_load, per_signal, magnitude }
    }
}

/// A published matrix that is not the inverse of a sensor matrix.
///
/// ```
/// use fingertip_wrench::{BadInverse, SensorMatrix};
/// use nalgebra::{Matrix6, Vector6};
///
/// // All loads from the sum of the signals: they cannot be told apart.
/// let published = Matrix6::<f64>::repeat(1.0);
/// let refused = SensorMatrix::from_inverse(&published, Vector6::repeat(1.0)).unwrap_err();
/// assert!(matches!(refused, BadInverse::Singular(_)));
/// assert!(refused.to_string().starts_with("the matrix from signals to wrench is singular: "));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BadInverse {
    /// An entry, a row, a column or a nominal load is unusable. Its "gauge" is the row of the matrix
    /// given, an axis; its "axis" the column, a gauge.
    #[error("the matrix from signals to wrench: {0}")]
    Matrix(SensorMatrixError),
    /// The matrix cannot be inverted.
    #[error("the matrix from signals to wrench is singular: {0}")]
    Singular(SingularMatrix),
}

impl<T: Real> SensorMatrix<T, 6> {
    /// From the matrix that takes signals to newtons and newton metres, as sensor makers publish it
    /// (an ATI `.cal` file has it as `UserAxis`), and the nominal loads.
    ///
    /// ```
    /// use fingertip_wrench::SensorMatrix;
    /// use nalgebra::{Matrix6, Vector6};
    ///
    /// // 5 N per volt: a nominal load of 10 N gives 2 V.
    /// let published = Matrix6::from_diagonal_element(5.0);
    /// let sensor = SensorMatrix::from_inverse(&published, Vector6::repeat(10.0))?;
    /// assert_eq!(sensor.normalised()[(0, 0)], 2.0);
    /// # Ok::<(), fingertip_wrench::BadInverse>(())
    /// ```
    ///
    /// # Errors
    /// [`BadInverse`].
    pub fn from_inverse(wrench_per_signal: &Matrix6<T>, nominal: Vector6<T>) -> Result<Self, BadInverse> {
        let unit =
            SensorMatrix::new(*wrench_per_signal, Vector6::repeat(T::one())).map_err(BadInverse::Matrix)?;
        let sensitivities = GaussianElimination::new(&unit).map_err(BadInverse::Singular)?.gain(&unit);
        Self::from_sensitivities(sensitivities, nominal).map_err(BadInverse::Matrix)
    }
}
