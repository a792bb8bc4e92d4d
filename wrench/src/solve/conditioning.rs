//! How a sensor magnifies errors.

use nalgebra::{SMatrix, Vector6};
use thiserror::Error;

use crate::solve::orthogonal::Orthogonal;
use crate::{Real, SensorMatrix, singular_values};

/// The conditioning of a normalised sensor matrix: how much it magnifies errors of the signals and
/// of its own entries, before any solver adds its own.
///
/// Everything depends on the nominal loads, by which the columns are scaled: the choice that says
/// which errors of a force and of a torque count as equally bad.
///
/// ```
/// use fingertip_wrench::{Conditioning, SensorMatrix};
/// use nalgebra::{Matrix6, Vector6};
///
/// let sensor = SensorMatrix::new(
///     Matrix6::from_diagonal(&Vector6::new(2.0, 2.0, 2.0, 1.0, 1.0, 1.0)),
///     Vector6::repeat(1.0),
/// )?;
/// let conditioning = Conditioning::of(&sensor);
/// assert_eq!(conditioning.condition_number(), 2.0);
/// // Signals known to 1 %, the matrix to 1 %: equation (14).
/// let bound: f64 = conditioning.relative_error_bound(0.01, 0.01)?;
/// assert!((bound - 0.02 * 2.0 / (1.0 - 0.02)).abs() < 1e-15);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Conditioning<T: Real> {
    /// Singular values of the normalised matrix \[signal per nominal load\], largest first.
    pub singular_values: Vector6<T>,
    /// Skeel's condition number `‖|C⁺||C|‖∞` (Skeel 1979): the magnification of errors relative to
    /// each single entry; unlike N_c it does not change with the scale of a gauge. `None` if the
    /// matrix is singular to working precision.
    pub skeel: Option<T>,
    /// Per axis: standard deviation of the load, as a fraction of the nominal load, per unit of
    /// independent noise in every signal (the length of a row of `C⁺`). `None` if singular.
    pub amplification: Option<Vector6<T>>,
    /// Per axis: largest error of the load, as a fraction of the nominal load, when no signal is
    /// off by more than one unit (the sum of magnitudes of a row of `C⁺`). `None` if singular.
    pub worst_amplification: Option<Vector6<T>>,
}

/// Equation (14) says nothing about errors this large.
///
/// ```
/// use fingertip_wrench::{BeyondBound, Conditioning, SensorMatrix};
/// use nalgebra::{Matrix6, Vector6};
///
/// let matrix = Matrix6::from_diagonal(&Vector6::new(4.0, 1.0, 1.0, 1.0, 1.0, 1.0));
/// let conditioning = Conditioning::of(&SensorMatrix::new(matrix, Vector6::repeat(1.0_f64))?);
/// // A matrix known to 1 % of its norm: (0.1 % + 1 %)·4/(1 − 0.04).
/// let bound = conditioning.relative_error_bound(0.001, 0.01)?;
/// assert!((bound - 0.044 / 0.96).abs() < 1e-12);
/// // One known to half of it may be singular.
/// let refused = conditioning.relative_error_bound(0.001, 0.5).unwrap_err();
/// assert!(matches!(refused, BeyondBound::MatrixMayBeSingular { product } if (product - 2.0).abs() < 1e-12));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BeyondBound {
    /// `N_c ‖dC‖/‖C‖ ≥ 1`: within its uncertainty the matrix may be singular.
    #[error(
        "the bound holds only while condition number times relative matrix error is below 1; it is {product:.3}: \
         within its uncertainty the sensor matrix may be singular"
    )]
    MatrixMayBeSingular {
        /// `N_c ‖dC‖/‖C‖`; infinite for a singular matrix.
        product: f64,
    },
    /// A relative error is negative, NaN or infinite.
    #[error("the relative errors of signals and matrix must be finite and not negative")]
    BadRelativeError,
}

impl<T: Real> Conditioning<T> {
    /// The conditioning of a sensor. Works for singular matrices too, and then says so.
    #[must_use]
    pub fn of<const N: usize>(sensor: &SensorMatrix<T, N>) -> Self {
        let matrix = sensor.normalised();
        let inverse = Orthogonal::new(matrix).ok().map(|factors| factors.pseudo_inverse);
        let row_sums = |m: &SMatrix<T, 6, 6>| m.column_sum().amax();
        Self {
            singular_values: singular_values(matrix),
            skeel: inverse.map(|inverse| row_sums(&(inverse.abs() * matrix.abs()))),
            amplification: inverse.map(|inverse| Vector6::from_fn(|axis, _| length(&inverse, axis))),
            worst_amplification: inverse.map(|inverse| inverse.abs().column_sum()),
        }
    }

    /// The condition number N_c: largest over smallest singular value, at least 1; infinite for a
    /// singular matrix.
    ///
    /// Known to a relative error of about `10 ε N_c`: near `1/ε` only its size means something.
    #[must_use]
    pub fn condition_number(&self) -> T {
        self.singular_values[0] / self.singular_values[5]
    }

    /// Equation (14) of Bicchi & Dario 1987: bound on `‖dP‖/‖P‖` in the Euclidean norm of
    /// normalised loads, from the relative errors `‖dV‖/‖V‖` and `‖dC‖/‖C‖` (spectral norm):
    /// `(‖dV‖/‖V‖ + ‖dC‖/‖C‖)·N_c / (1 − N_c‖dC‖/‖C‖)`.
    ///
    /// `‖V‖` is of signals that obey the matrix (`V = C P`), as six gauges always do; of an
    /// extended sensor take the consistent part.
    ///
    /// # Errors
    /// [`BeyondBound`] where the equation does not hold; it is not extrapolated.
    pub fn relative_error_bound(&self, signal_error: T, matrix_error: T) -> Result<T, BeyondBound> {
        let valid = |error: T| error >= T::zero() && error.is_number();
        if !(valid(signal_error) && valid(matrix_error)) {
            return Err(BeyondBound::BadRelativeError);
        }
        let condition = self.condition_number();
        let product = condition * matrix_error;
        if !(condition.is_number() && product < T::one()) {
            let product = if product.is_number() { product.to_f64() } else { f64::INFINITY };
            return Err(BeyondBound::MatrixMayBeSingular { product });
        }
        Ok((signal_error + matrix_error) * condition / (T::one() - product))
    }
}

/// The length of a row, whatever its size.
fn length<T: Real, const N: usize>(matrix: &SMatrix<T, 6, N>, row: usize) -> T {
    let scale = matrix.row(row).amax().normalising_factor();
    (matrix.row(row) * scale).norm_squared().root() / scale
}
