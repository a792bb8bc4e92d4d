//! Gaussian elimination, done once.

use nalgebra::{Matrix6, Vector6};

use crate::scalar::rounding::relative_rounding;
use crate::solve::compensated::{matrix_residual, residual};
use crate::solve::equilibration::Equilibrated;
use crate::solve::nonnegative::neumann;
use crate::solve::singular::{SingularMatrix, dependent_gauge};
use crate::{LinearMap, OwnError, Real, SensorMatrix, Wrench, WrenchSolver};

/// The general solver for minimal sensors: triangular factors of the sensor matrix with row
/// equilibration and partial pivoting, computed once (Bicchi & Dario 1987 recommend it; Wilkinson
/// 1965).
///
/// A solve is 42 multiplications, 30 subtractions and no division. Its relative residual is a few
/// rounding errors whatever the matrix; its error grows with the condition number, and
/// [`ErrorBound`](crate::ErrorBound) says to how much.
///
/// ```
/// use fingertip_wrench::{GaussianElimination, SensorMatrix, Wrench, WrenchSolver};
/// use nalgebra::{Matrix6, Vector6};
///
/// // Gauge 1 also feels a tenth of the first axis; 2 V at 10 N and at 0.1 N·m.
/// let mut matrix = Matrix6::from_diagonal_element(2.0);
/// matrix[(1, 0)] = 0.2;
/// let sensor = SensorMatrix::new(matrix, Vector6::new(10.0, 10.0, 10.0, 0.1, 0.1, 0.1))?;
/// let solver = GaussianElimination::new(&sensor)?;
/// let load = Wrench::from_components(&Vector6::new(1.0, 0.0, -5.0, 0.0, 0.02, 0.0));
/// let found = solver.solve(&sensor.signals(&load));
/// assert!((found - load).components().amax() < 1e-15);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussianElimination<T: Real> {
    /// Row `i` holds, left of the diagonal, row `i` of the lower factor divided by its pivot; right
    /// of it, row `i` of the upper factor divided by its pivot; on it, row scale over pivot. So no
    /// multiplication stands between one unknown and the next but the one by a factor.
    rows: [[T; 6]; 6],
    /// `order[i]` is the gauge that became row `i`.
    order: [u8; 6],
    /// Column scale: a power of two for binary types.
    column: Vector6<T>,
    /// Nominal load times column scale.
    nominal: Vector6<T>,
}

impl<T: Real> GaussianElimination<T> {
    /// Factors the matrix.
    ///
    /// # Errors
    /// [`SingularMatrix`] when the matrix is singular to working precision: when Skeel's condition
    /// number of the equilibrated matrix exceeds `1/(8ε)`, so that a change of four rounding errors
    /// in its entries could make it singular and no digit of an answer would mean anything.
    pub fn new(sensor: &SensorMatrix<T, 6>) -> Result<Self, SingularMatrix> {
        let scaled = Equilibrated::new(sensor.normalised());
        let nominal = sensor.nominal().component_mul(&scaled.column);
        let mut a = scaled.matrix;
        let mut row_scale = scaled.row;
        let mut order = [0, 1, 2, 3, 4, 5_u8];
        for k in 0..6 {
            let pivot_row =
                (k..6).fold(k, |best, row| if a[(row, k)].abs() > a[(best, k)].abs() { row } else { best });
            if a[(pivot_row, k)].is_zero() {
                return Err(dependent_gauge(&scaled.matrix));
            }
            a.swap_rows(k, pivot_row);
            order.swap(k, pivot_row);
            row_scale.swap_rows(k, pivot_row);
            for row in k + 1..6 {
                let factor = a[(row, k)] / a[(k, k)];
                for column in k + 1..6 {
                    let change = factor * a[(k, column)];
                    a[(row, column)] -= change;
                }
            }
        }
        let mut rows = [[T::zero(); 6]; 6];
        for (i, row) in rows.iter_mut().enumerate() {
            let pivot = a[(i, i)];
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = if i == j { row_scale[i] / pivot } else { a[(i, j)] / pivot };
            }
        }
        let solver = Self { rows, order, column: scaled.column, nominal };
        // The inverse of the equilibrated matrix, by the factors.
        let mut inverse = Matrix6::zeros();
        for gauge in 0..6 {
            let mut unit = Vector6::zeros();
            unit[gauge] = T::one() / scaled.row[gauge];
            inverse.set_column(gauge, &solver.substitute(&unit));
        }
        let skeel = (inverse.abs() * scaled.matrix.abs()).column_sum().amax();
        if !(skeel * T::EPSILON * T::literal(8.0) < T::one()) {
            return Err(dependent_gauge(&scaled.matrix));
        }
        let in_range = |x: &T| x.is_number() && x.abs() >= T::LEAST_NORMAL;
        let diagonal_in_range = solver.rows.iter().enumerate().all(|(i, row)| in_range(&row[i]));
        if !(solver.nominal.iter().all(in_range) && diagonal_in_range) {
            return Err(SingularMatrix::OutOfRange);
        }
        Ok(solver)
    }

    /// Loads as fractions of nominal loads times column scales.
    #[inline(always)]
    fn substitute(&self, signals: &Vector6<T>) -> Vector6<T> {
        let rows = &self.rows;
        let signals: &[T; 6] = &signals.data.0[0];
        let mut x = [T::zero(); 6];
        for i in 0..6 {
            // `order` is a permutation of 0..6; the minimum says so to the compiler.
            let gauge = usize::from(self.order[i]).min(5);
            let mut value = signals[gauge] * rows[i][i];
            for j in 0..i {
                value -= rows[i][j] * x[j];
            }
            x[i] = value;
        }
        for i in (0..5).rev() {
            // From the far end, so that the unknown found last is needed last.
            let mut value = x[i];
            for j in (i + 1..6).rev() {
                value -= rows[i][j] * x[j];
            }
            x[i] = value;
        }
        Vector6::from(x)
    }

    /// Loads as fractions of the nominal loads.
    #[inline]
    pub(crate) fn solve_normalised(&self, signals: &Vector6<T>) -> Vector6<T> {
        self.substitute(signals).component_mul(&self.column)
    }
}

impl<T: Real> WrenchSolver<T, 6> for GaussianElimination<T> {
    #[inline]
    fn solve(&self, signals: &Vector6<T>) -> Wrench<T> {
        Wrench::from_components(&self.substitute(signals).component_mul(&self.nominal))
    }

    fn linear_map(&self, sensor: &SensorMatrix<T, 6>) -> Option<LinearMap<T, 6>> {
        let gain = self.gain(sensor);
        Some(LinearMap { gain, own_error: self.own_error(sensor, &gain) })
    }
}

/// Steps of refinement of an inverse: each divides its error by `1/(ε·condition)`, which the
/// constructor keeps well above 1.
const INVERSE_STEPS: usize = 6;

impl<T: Real> GaussianElimination<T> {
    /// The inverse of the sensor matrix, refined until it is the true one to the last digit or
    /// two.
    pub(super) fn gain(&self, sensor: &SensorMatrix<T, 6>) -> Matrix6<T> {
        let scaled = Equilibrated::new(sensor.normalised());
        let mut inverse = Matrix6::zeros();
        for _ in 0..=INVERSE_STEPS {
            let defect = matrix_residual(&Matrix6::identity(), &scaled.matrix, &inverse);
            for gauge in 0..6 {
                let right_side = defect.column(gauge).component_div(&scaled.row);
                let change = self.substitute(&right_side);
                let mut column = inverse.column_mut(gauge);
                column += change;
            }
        }
        Matrix6::from_fn(|axis, gauge| inverse[(axis, gauge)] * scaled.column[axis] * scaled.row[gauge])
    }

    /// From the rounding errors of the two substitutions, counted (Higham 2002, section 8.1), and
    /// the defect of the factors, computed.
    pub(super) fn own_error(&self, sensor: &SensorMatrix<T, 6>, gain: &Matrix6<T>) -> OwnError<T, 6> {
        let scaled = Equilibrated::new(sensor.normalised());
        let magnitude = inverse_magnitude(sensor, gain);
        let row = |i: usize| usize::from(self.order[i]).min(5);
        let triangle = |i: usize, j: usize, inside: core::cmp::Ordering| match i.cmp(&j) {
            core::cmp::Ordering::Equal => T::one(),
            side if side == inside => self.rows[i][j],
            _ => T::zero(),
        };
        let lower = Matrix6::from_fn(|i, j| triangle(i, j, core::cmp::Ordering::Greater));
        let upper = Matrix6::from_fn(|i, j| triangle(i, j, core::cmp::Ordering::Less));
        // The factors stand for the rows of the equilibrated matrix in pivot order, each times the
        // first factor of its substitution.
        let over_pivot = |i: usize| self.rows[i][i] / scaled.row[row(i)];
        let defect = Matrix6::from_fn(|i, j| {
            let start = (over_pivot(i)).two_product(scaled.matrix[(row(i), j)]);
            let products = (0..6).map(|k| (lower[(i, k)], upper[(k, j)]));
            residual(start.0, products) + start.1
        });
        // Row i of the forward substitution rounds its start i + 1 times; row k of the backward one
        // 5 − k times, and a term at most once more.
        let counted = Matrix6::from_fn(|i, j| {
            (0..6).fold(T::zero(), |sum, k| {
                let forward = if k == i { i + 1 } else { i + 1 - k.min(i) };
                let backward = if k == j { 5 - k } else { 6 - k };
                sum + (lower[(i, k)] * upper[(k, j)]).abs() * relative_rounding::<T>(forward + backward)
            })
        });
        let backward = defect.abs() + counted;
        let of_rows =
            Matrix6::from_fn(|i, k| magnitude[(i, row(k))] / (scaled.column[i] * self.rows[k][k].abs()));
        let of_scaled = of_rows * backward;
        let per_load = Matrix6::from_fn(|i, j| of_scaled[(i, j)] * scaled.column[i] / scaled.column[j])
            + Matrix6::identity() * relative_rounding::<T>(1);
        OwnError { per_load, per_signal: Matrix6::zeros(), magnitude }
    }
}

/// A bound on the magnitudes of the entries of `C⁻¹`, given a computed inverse: with
/// `D = |S·C − I|`, `|C⁻¹| ≤ (I − D)⁻¹|S|`. Infinite where that says nothing.
pub(crate) fn inverse_magnitude<T: Real>(sensor: &SensorMatrix<T, 6>, inverse: &Matrix6<T>) -> Matrix6<T> {
    let defect = matrix_residual(&Matrix6::identity(), inverse, sensor.normalised()).abs();
    neumann(&defect).map_or(Matrix6::repeat(T::GREATEST), |factor| factor * inverse.abs())
}
