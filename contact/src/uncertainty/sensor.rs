//! From the noise of gauges and of a calibration to the covariance of a wrench.

use fingertip_surfaces::BadShape;
use fingertip_wrench::{Real, Wrench, WrenchSolver, stored};
use nalgebra::{Matrix6, SMatrix, SVector, Vector6};

use crate::uncertainty::is_covariance;

const SHAPE: &str = "sensor uncertainty";
const COVARIANCE: &str = "finite, symmetric and without a negative variance";
const DEVIATIONS: &str = "finite and not negative";

fn are_deviations<T: Real, const N: usize>(deviations: &SVector<T, N>) -> bool {
    deviations.iter().all(|x| x.is_number() && *x >= T::zero())
}

/// What is uncertain in a sensor: the signals, by noise, and the sensor matrix, by calibration.
///
/// `w = B s` with the solver's matrix `B`. The signals are `s = A w + noise`; an error `dA` of
/// the sensitivities `A` \[signal per N, N·m\] acts as an error `−dA w` of the signals. So, with
/// noise covariance `Σ_s` and a covariance `Σ_i` of row `i` of `A` (rows independent, as a
/// calibration by least squares gives them),
///
/// which makes noise proportional to the load out of an uncertain calibration, and a floor out of
/// the noise.
///
/// ```
/// use fingertip_contact::SensorUncertainty;
/// use fingertip_wrench::{GaussianElimination, SensorMatrix, Wrench};
/// use nalgebra::{Matrix6, Vector6};
///
/// // Six gauges, one for each component: 2 mV/N and 2 mV/(N·m), with 0.01 mV of noise.
/// let matrix = SensorMatrix::new(Matrix6::identity() * 2e-3, Vector6::repeat(1.0))?;
/// let solver = GaussianElimination::new(&matrix)?;
/// let sensor = SensorUncertainty::independent(&solver, &Vector6::repeat(1e-5_f64))?;
/// let covariance = sensor.wrench_covariance(&Wrench::zero());
/// // 0.01 mV are 5 mN.
/// assert!((covariance[(2, 2)].sqrt() - 5e-3_f64).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorUncertainty<T: Real, const N: usize> {
    solver: SMatrix<T, 6, N>,
    /// `B Σ_s Bᵀ`.
    floor: Matrix6<T>,
    rows: Option<[Matrix6<T>; N]>,
}

impl<T: Real, const N: usize> SensorUncertainty<T, N> {
    /// Of a solver, with the covariance of its signals. (A solver is linear: its matrix is what it
    /// answers to unit signals.)
    ///
    /// # Errors
    /// [`BadShape`] unless the covariance is finite, symmetric and has no negative variance in any
    /// direction, but for rounding.
    pub fn new<S: WrenchSolver<T, N>>(solver: &S, signals: &SMatrix<T, N, N>) -> Result<Self, BadShape> {
        BadShape::check(SHAPE, "covariance of the signals", COVARIANCE, is_covariance(signals))?;
        let mut matrix = SMatrix::<T, 6, N>::zeros();
        for gauge in 0..N {
            let mut unit = SVector::<T, N>::zeros();
            unit[gauge] = T::one();
            matrix.set_column(gauge, &solver.solve(&unit).components());
        }
        Ok(Self { solver: matrix, floor: matrix * signals * matrix.transpose(), rows: None })
    }

    /// Of a solver whose gauges have independent noise of these standard deviations.
    ///
    /// # Errors
    /// [`BadShape`] unless they are finite and not negative.
    pub fn independent<S: WrenchSolver<T, N>>(
        solver: &S,
        deviations: &SVector<T, N>,
    ) -> Result<Self, BadShape> {
        BadShape::check(SHAPE, "noise of the signals", DEVIATIONS, are_deviations(deviations))?;
        Self::new(solver, &SMatrix::from_diagonal(&deviations.component_mul(deviations)))
    }

    /// Adds the covariance of each gauge's six sensitivities \[signal per N, N·m\]. From a fit by
    /// least squares to loads `X` with residual deviation `s_i`: `s_i² (XᵀX)⁻¹`.
    ///
    /// # Errors
    /// [`BadShape`] unless each is finite, symmetric and has no negative variance in any direction, but for
    /// rounding.
    pub fn with_calibration(self, rows: [Matrix6<T>; N]) -> Result<Self, BadShape> {
        BadShape::check(SHAPE, "covariance of the calibration", COVARIANCE, rows.iter().all(is_covariance))?;
        Ok(Self { rows: Some(rows), ..self })
    }

    /// Covariance of a wrench that was solved from this sensor's signals.
    #[must_use]
    pub fn wrench_covariance(&self, wrench: &Wrench<T>) -> Matrix6<T> {
        let Some(rows) = &self.rows else { return self.floor };
        let w = wrench.components();
        let mut covariance = self.floor;
        for (gauge, row) in rows.iter().enumerate() {
            let variance = w.dot(&(row * w)).max(T::zero());
            let column = self.solver.column(gauge);
            covariance += column * column.transpose() * variance;
        }
        covariance
    }
}

/// The noise model of a data sheet: a floor, and a part that grows with the load,
/// `σ_i² = σ_0i² + (E w_i)²` (`docs/theory/wrench.md#covariance-of-a-wrench`).
///
/// ```
/// use fingertip_contact::WrenchNoise;
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Vector3, Vector6};
///
/// // A data sheet: 10 mN and 0.1 N·mm at rest, and one per cent of the load.
/// let noise = WrenchNoise::new(Vector6::new(0.01_f64, 0.01, 0.01, 1e-4, 1e-4, 1e-4), 0.01)?;
/// let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
/// let covariance = noise.covariance(&wrench);
/// // Of 2 N: 10 mN and 20 mN.
/// assert!((covariance[(2, 2)].sqrt() - 0.01_f64.hypot(0.02)).abs() < 1e-12);
/// assert!((covariance[(0, 0)].sqrt() - 0.01).abs() < 1e-12);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchNoise<T: Real> {
    /// Standard deviations at rest \[N, N, N, N·m, N·m, N·m\].
    pub floor: Vector6<T>,
    /// Relative standard deviation under load.
    pub relative: T,
}

impl<T: Real> WrenchNoise<T> {
    /// From standard deviations at rest \[N, N, N, N·m, N·m, N·m\], and relative ones under load.
    ///
    /// # Errors
    /// [`BadShape`] unless all are finite and not negative.
    pub fn new(floor: Vector6<T>, relative: T) -> Result<Self, BadShape> {
        let good = are_deviations(&floor) && are_deviations(&SVector::<T, 1>::new(relative));
        BadShape::check("noise of a wrench", "standard deviations", DEVIATIONS, good)?;
        Ok(Self { floor, relative })
    }

    /// Variances of the components of a wrench, which are independent \[N², (N·m)²\]: as
    /// [`WrenchSpread::Independent`](crate::WrenchSpread::Independent) they cost less than as a covariance.
    #[inline]
    #[must_use]
    pub fn variances(&self, wrench: &Wrench<T>) -> Vector6<T> {
        let proportional = wrench.components() * self.relative;
        self.floor.component_mul(&self.floor) + proportional.component_mul(&proportional)
    }

    /// Covariance of a wrench, its components independent.
    #[must_use]
    pub fn covariance(&self, wrench: &Wrench<T>) -> Matrix6<T> {
        Matrix6::from_diagonal(&self.variances(wrench))
    }
}

stored! {
    WrenchNoise<T>, [T: Real],
    |noise| {
        floor: Vector6<T> = noise.floor,
        relative: T = noise.relative,
    },
    WrenchNoise::new(floor, relative)
}
