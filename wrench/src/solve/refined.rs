//! Gaussian elimination, and then the digits that it lost.

use nalgebra::{Matrix6, Vector6};

use crate::scalar::rounding::relative_rounding;
use crate::solve::compensated;
use crate::solve::equilibration::Equilibrated;
use crate::{
    GaussianElimination, LinearMap, OwnError, Real, SensorMatrix, SensorMatrixError, SingularMatrix, Wrench,
    WrenchSolver,
};

/// [`GaussianElimination`] with iterative refinement: the answer is the true one to the last digit
/// or two, for any matrix that can be solved at all (Wilkinson 1965; Skeel 1980).
///
/// Each step computes the residual as if in twice the precision (Dekker's two-product, no fused
/// multiply-add) and solves for the correction. How many steps are needed follows from Skeel's
/// condition number and is settled at construction, never more than
/// [`MAX_STEPS`](Self::MAX_STEPS); a step costs about seven plain solves.
///
/// The refined answer is exact *for the matrix given*. A calibration is seldom known to better
/// than 10⁻⁴, against which plain elimination loses nothing unless the condition number is above
/// 10⁸ in `f64`; in `f32` refinement is worth its price from about 10² on.
///
/// ```
/// use fingertip_wrench::{GaussianElimination, Refined, SensorMatrix, WrenchSolver};
/// use nalgebra::{Matrix6, Vector6};
///
/// // Hilbert's matrix, condition number 10⁷, times 27720, which makes its entries whole.
/// let matrix = Matrix6::from_fn(|i, j| 27_720.0 / (i + j + 1) as f64);
/// let sensor = SensorMatrix::new(matrix, Vector6::repeat(1.0))?;
/// let signals = matrix * Vector6::repeat(1.0); // exactly
/// let error = |solver: &dyn Fn(&Vector6<f64>) -> fingertip_wrench::Wrench<f64>| {
///     (solver(&signals).components() - Vector6::repeat(1.0)).amax()
/// };
/// let (plain, refined) = (GaussianElimination::new(&sensor)?, Refined::new(&sensor)?);
/// assert!(error(&|signals| refined.solve(signals)) <= f64::EPSILON);
/// assert!(error(&|signals| plain.solve(signals)) > 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined<T: Real> {
    /// The equilibrated matrix: column scales moved into the nominal loads.
    equilibrated: SensorMatrix<T, 6>,
    solver: GaussianElimination<T>,
    row: Vector6<T>,
    steps: u8,
}

impl<T: Real> Refined<T> {
    /// The most steps that any matrix gets.
    pub const MAX_STEPS: u8 = 8;

    /// Factors the matrix and settles the number of steps.
    ///
    /// # Errors
    /// As [`GaussianElimination::new`].
    pub fn new(sensor: &SensorMatrix<T, 6>) -> Result<Self, SingularMatrix> {
        let scaled = Equilibrated::new(sensor.normalised());
        // The columns of the scaled matrix are fractions of larger or smaller nominal loads.
        let nominal = sensor.nominal().component_mul(&scaled.column);
        let equilibrated = SensorMatrix::new(scaled.matrix, nominal).map_err(out_of_range)?;
        let solver = GaussianElimination::new(&equilibrated)?;
        // Each solve is off by at most this factor, so each step leaves that much of the error.
        let contraction =
            solver.own_error(&equilibrated, &solver.gain(&equilibrated)).per_load.column_sum().amax();
        let mut error = contraction;
        let mut steps = 1;
        while error > T::EPSILON * T::literal(0.125) && steps < Self::MAX_STEPS {
            error *= contraction;
            steps += 1;
        }
        Ok(Self { equilibrated, solver, row: scaled.row, steps })
    }

    /// How many steps each solve takes.
    #[inline]
    #[must_use]
    pub const fn steps(&self) -> u8 {
        self.steps
    }
}

/// What was a sensor matrix before scaling can only have left the range.
fn out_of_range(_: SensorMatrixError) -> SingularMatrix {
    SingularMatrix::OutOfRange
}

impl<T: Real> WrenchSolver<T, 6> for Refined<T> {
    fn solve(&self, signals: &Vector6<T>) -> Wrench<T> {
        // Near 1, so that the errors of products neither over- nor underflow.
        let in_rows = signals.component_mul(&self.row);
        let scale = in_rows.amax().normalising_factor();
        let right_side = in_rows * scale;
        let matrix = self.equilibrated.normalised();
        let mut loads = self.solver.solve_normalised(&right_side);
        for _ in 0..self.steps {
            let residual = Vector6::from_fn(|gauge, _| {
                let products = (0..6).map(|axis| (matrix[(gauge, axis)], loads[axis]));
                compensated::residual(right_side[gauge], products)
            });
            loads += self.solver.solve_normalised(&residual);
        }
        Wrench::from_components(&(loads / scale).component_mul(self.equilibrated.nominal()))
    }

    fn linear_map(&self, sensor: &SensorMatrix<T, 6>) -> Option<LinearMap<T, 6>> {
        let of_one_solve = self.solver.gain(&self.equilibrated);
        let one_solve = self.solver.own_error(&self.equilibrated, &of_one_solve);
        Some(LinearMap {
            gain: self.gain(sensor, &of_one_solve),
            own_error: self.own_error(sensor, &one_solve),
        })
    }
}

impl<T: Real> Refined<T> {
    fn gain(&self, sensor: &SensorMatrix<T, 6>, of_one_solve: &Matrix6<T>) -> Matrix6<T> {
        of_one_solve.map_with_location(|axis, gauge, gain| {
            // The ratio of nominal loads is the column scale, a power of two.
            gain * self.row[gauge] * (self.equilibrated.nominal()[axis] / sensor.nominal()[axis])
        })
    }

    /// By recurrence over the steps: what a step leaves of the error before it, plus the error of
    /// the residual and the rounding of the sum.
    fn own_error(&self, sensor: &SensorMatrix<T, 6>, one_solve: &OwnError<T, 6>) -> OwnError<T, 6> {
        let identity = Matrix6::<T>::identity();
        // Dot2 of 7 terms: 49ε² of the sum of magnitudes.
        let of_residual = one_solve.magnitude
            * self.equilibrated.normalised().abs()
            * (T::EPSILON * T::EPSILON * T::literal(98.0));
        let of_sum = identity * relative_rounding::<T>(1);
        let mut error = one_solve.per_load;
        for _ in 0..self.steps {
            error = of_sum
                + of_residual
                + (one_solve.per_load + of_sum) * (identity + one_solve.per_load) * error;
        }
        let ratio = self.equilibrated.nominal().component_div(sensor.nominal());
        let per_load = Matrix6::from_fn(|i, j| error[(i, j)] * ratio[i] / ratio[j])
            + identity * relative_rounding::<T>(1);
        let magnitude = Matrix6::from_fn(|axis, gauge| {
            one_solve.magnitude[(axis, gauge)] * self.row[gauge] * ratio[axis]
        });
        OwnError { per_load, per_signal: Matrix6::zeros(), magnitude }
    }
}
