//! What is wrong with a design.

use fingertip_wrench::SensorMatrixError;
use fingertip_wrench::gauge_layout::LayoutError;
use thiserror::Error;

/// Why a design cannot be made or judged.
///
/// ```
/// use fingertip_calibration::design::{Bridge, DesignError, NominalLoads};
///
/// assert!(matches!(NominalLoads::equal(-10.0, 0.1), Err(DesignError::OutOfRange { value: -10.0, .. })));
/// // The seventh gauge of six.
/// assert!(matches!(Bridge::quarter(6).validate(6), Err(DesignError::NoSuchPart { index: 6, count: 6, .. })));
/// ```
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DesignError {
    /// A quantity has a value that no design has.
    #[error("the {quantity} is {value}; it must be {requirement}")]
    OutOfRange {
        /// Which quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        requirement: &'static str,
    },
    /// A parameter whose range is empty or not finite.
    #[error("the range of parameter {name} is {lower} to {upper}; it must be finite and not empty")]
    BadParameter {
        /// Its name.
        name: String,
        /// Lower bound.
        lower: f64,
        /// Upper bound.
        upper: f64,
    },
    /// Lists whose lengths do not belong together.
    #[error("{what}: {found} given, {expected} needed")]
    WrongCount {
        /// What was counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// Something refers to a part that is not there.
    #[error("{what} refers to number {index}, but there are only {count}")]
    NoSuchPart {
        /// What refers.
        what: &'static str,
        /// To which (counts from 0).
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// The structure cannot carry or cannot measure some load.
    #[error("the structure is singular: {reason}")]
    Singular {
        /// How that came.
        reason: &'static str,
    },
    /// No wall is thick enough.
    #[error("no thin wall of radius {radius} m carries these loads: {thickness} m would be needed")]
    WallTooThick {
        /// Mean radius \[m\].
        radius: f64,
        /// Thickness that the loads ask for \[m\].
        thickness: f64,
    },
    /// The beam or its gauges.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The sensor matrix that follows.
    #[error(transparent)]
    Matrix(#[from] SensorMatrixError),
    /// A file of a layout that cannot be read.
    #[error("the layout file cannot be read: {0}")]
    Syntax(String),
}

impl DesignError {
    pub(super) fn check_positive(quantity: &'static str, value: f64) -> Result<f64, Self> {
        if value > 0.0 && value.is_finite() {
            Ok(value)
        } else {
            Err(Self::OutOfRange { quantity, value, requirement: "positive and finite" })
        }
    }

    pub(super) fn check_not_negative(quantity: &'static str, value: f64) -> Result<f64, Self> {
        if value >= 0.0 && value.is_finite() {
            Ok(value)
        } else {
            Err(Self::OutOfRange { quantity, value, requirement: "finite and not negative" })
        }
    }
}
