//! A few additions instead of a matrix product.

use core::marker::PhantomData;

use nalgebra::{Matrix6, SMatrix, SVector};
use thiserror::Error;

use crate::scalar::rounding::relative_rounding;
use crate::solve::compensated::matrix_residual;
use crate::solve::nonnegative::neumann;
use crate::{
    Combination, GaussianElimination, LinearMap, OwnError, Real, SensorMatrix, SensorMatrixError,
    SingularMatrix, Wrench, WrenchSolver,
};

/// The paper's fast path (Bicchi & Dario 1987, equations (19), (20)): signals are combined by a
/// sparse matrix M, and the block-triangular part of M·C is solved.
///
/// On a real sensor, M·C has small entries where the drawing has zeros. They are neglected in the
/// solve, as in the paper; but their effect is kept: [`neglected`](Self::neglected) says what part
/// of each nominal load shows up as another, and [`ErrorBound`](crate::ErrorBound) bounds it for
/// each sample.
///
/// ```
/// use fingertip_wrench::gauge_layout::{GaugeLayout, ThinWalledBeam};
/// use fingertip_wrench::{BicchiDario, Decoupled, Wrench, WrenchSolver};
/// use nalgebra::{Vector3, Vector6};
///
/// let beam = ThinWalledBeam { radius: 5e-3, thickness: 2e-4, youngs_modulus: 70e9, poisson_ratio: 0.33 };
/// let gauges = GaugeLayout::bicchi_dario_gauges(14.0_f64.to_radians(), 0.01);
/// let layout = GaugeLayout::new(&beam, gauges)?;
/// let sensor = layout.sensor_matrix(1e4, Vector6::new(30.0, 30.0, 30.0, 0.3, 0.3, 0.3))?;
/// let solver: Decoupled<f64, BicchiDario, 6> = Decoupled::new(&sensor)?;
/// let load = Wrench::on_fingertip(Vector3::new(-5.0, 1.0, 0.0), Vector3::new(0.0, 0.01, 0.0));
/// let found = solver.solve(&sensor.signals(&load));
/// assert!((found.force() - load.force()).norm() < 1e-13);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decoupled<T: Real, K: Combination<N>, const N: usize> {
    /// Newtons and newton metres per combined signal; only kept entries are ever read.
    inverse: [[T; 6]; 6],
    neglected: Matrix6<T>,
    combination: PhantomData<K>,
}

/// Why a sensor cannot be solved by a combination of its signals.
///
/// ```
/// use fingertip_wrench::{Decoupled, NotDecoupled, SensorMatrix, ThreeRosettes};
/// use nalgebra::{Matrix6, Vector6};
///
/// // A gauge for each load is not the sensor that sums and differences are for.
/// let sensor = SensorMatrix::new(Matrix6::identity(), Vector6::repeat(1.0_f64))?;
/// let refused = Decoupled::<_, ThreeRosettes, 6>::new(&sensor).unwrap_err();
/// assert_eq!(refused, NotDecoupled::BlindCombination { combination: 1 });
/// assert_eq!(refused.to_string(), "combination 1 does not tell its load from the others");
/// # Ok::<(), fingertip_wrench::SensorMatrixError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NotDecoupled {
    /// The pattern of kept entries is not that of its own inverse: a fault of the
    /// [`Combination`].
    #[error("the pattern of kept entries lacks its diagonal or is not closed (row {row}, column {column})")]
    PatternNotClosed {
        /// Row of the entry that is missing.
        row: usize,
        /// Column of the entry that is missing.
        column: usize,
    },
    /// A combination that ought to see its load does not.
    #[error("combination {combination} does not tell its load from the others")]
    BlindCombination {
        /// Which combination, counted from 0.
        combination: usize,
    },
    /// What would be neglected is as large as what would be kept: this is not the sensor that the
    /// combination is for.
    #[error("the couplings to be neglected are too large to bound their effect")]
    TooCoupled,
    /// Entries leave the range of the scalar type.
    #[error("the sensor matrix or a nominal load is too large or too small for the scalar type")]
    OutOfRange,
}

impl<T: Real, K: Combination<N>, const N: usize> Decoupled<T, K, N> {
    /// Combines the rows of the calibrated matrix and inverts the kept part.
    ///
    /// # Errors
    /// [`NotDecoupled`].
    pub fn new(sensor: &SensorMatrix<T, N>) -> Result<Self, NotDecoupled> {
        check_pattern(&K::KEPT)?;
        let combined = matrix_of::<T, K, N>() * sensor.normalised();
        let kept = Matrix6::from_fn(|i, j| if K::KEPT[i][j] { combined[(i, j)] } else { T::zero() });
        let kept = SensorMatrix::new(kept, *sensor.nominal()).map_err(|error| match error {
            SensorMatrixError::DeadGauge { gauge } => NotDecoupled::BlindCombination { combination: gauge },
            SensorMatrixError::BlindAxis { axis } => NotDecoupled::BlindCombination { combination: axis },
            _ => NotDecoupled::OutOfRange,
        })?;
        let factors = GaussianElimination::new(&kept).map_err(|error| match error {
            SingularMatrix::DependentGauge { gauge, .. } => {
                NotDecoupled::BlindCombination { combination: gauge }
            }
            SingularMatrix::OutOfRange => NotDecoupled::OutOfRange,
        })?;
        let normalised = factors.gain(&kept);
        let mut inverse = [[T::zero(); 6]; 6];
        for (i, row) in inverse.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                if K::KEPT[i][j] {
                    *entry = normalised[(i, j)] * sensor.nominal()[i];
                }
            }
        }
        let mut solver = Self { inverse, neglected: Matrix6::zeros(), combination: PhantomData };
        solver.neglected =
            matrix_residual(&Matrix6::identity(), &solver.gain(sensor), sensor.normalised()).abs();
        if !solver.inverse.iter().flatten().all(|x| x.is_number()) {
            return Err(NotDecoupled::OutOfRange);
        }
        neumann(&solver.neglected).ok_or(NotDecoupled::TooCoupled)?;
        Ok(solver)
    }

    /// Entry (i, j): what fraction of nominal load `i` a full nominal load `j` feigns, because its
    /// coupling is neglected. Zero but for rounding on the sensor of the drawing.
    #[inline]
    #[must_use]
    pub const fn neglected(&self) -> &Matrix6<T> {
        &self.neglected
    }
}

fn check_pattern(kept: &[[bool; 6]; 6]) -> Result<(), NotDecoupled> {
    for i in 0..6 {
        if !kept[i][i] {
            return Err(NotDecoupled::PatternNotClosed { row: i, column: i });
        }
        for j in 0..6 {
            for k in 0..6 {
                if kept[i][j] && kept[j][k] && !kept[i][k] {
                    return Err(NotDecoupled::PatternNotClosed { row: i, column: k });
                }
            }
        }
    }
    Ok(())
}

/// M as a matrix of type `T`.
fn matrix_of<T: Real, K: Combination<N>, const N: usize>() -> SMatrix<T, 6, N> {
    SMatrix::from_fn(|i, j| T::literal(K::MATRIX[i][j]))
}

impl<T: Real, K: Combination<N>, const N: usize> WrenchSolver<T, N> for Decoupled<T, K, N> {
    #[inline]
    fn solve(&self, signals: &SVector<T, N>) -> Wrench<T> {
        let combined = K::combine(signals);
        let mut wrench = combined;
        for i in 0..6 {
            let mut load = self.inverse[i][i] * combined[i];
            for j in 0..6 {
                if j != i && K::KEPT[i][j] {
                    load += self.inverse[i][j] * combined[j];
                }
            }
            wrench[i] = load;
        }
        Wrench::from_components(&wrench)
    }

    fn linear_map(&self, sensor: &SensorMatrix<T, N>) -> Option<LinearMap<T, N>> {
        let gain = self.gain(sensor);
        Some(LinearMap { gain, own_error: self.own_error(sensor, &gain) })
    }
}

impl<T: Real, K: Combination<N>, const N: usize> Decoupled<T, K, N> {
    fn gain(&self, sensor: &SensorMatrix<T, N>) -> SMatrix<T, 6, N> {
        let normalised = Matrix6::from_fn(|i, j| self.inverse[i][j] / sensor.nominal()[i]);
        normalised * matrix_of::<T, K, N>()
    }

    /// `N + 1` roundings of the combination, up to seven of its solution; and nine of the product
    /// that [`gain`](Self::gain) is.
    fn own_error(&self, sensor: &SensorMatrix<T, N>, gain: &SMatrix<T, 6, N>) -> OwnError<T, N> {
        let magnitudes = Matrix6::from_fn(|i, j| (self.inverse[i][j] / sensor.nominal()[i]).abs());
        let per_signal = magnitudes * matrix_of::<T, K, N>().abs() * relative_rounding::<T>(N + 17);
        OwnError { per_load: self.neglected, per_signal, magnitude: gain.abs() }
    }
}
