//! Why there is no calibration.

use thiserror::Error;

use crate::creep::CreepError;
use crate::file::FileError;
use crate::fit::FitError;
use crate::loads::LoadError;

/// Why there is no calibration.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::calibrate;
/// use fingertip_calibration::model::{CalibrationError, Options};
///
/// // A full scale of −10 N is none.
/// let options = Options { nominal: Some(vec![-10.0; 3]), ..Options::default() };
/// assert!(matches!(calibrate(&table, &options), Err(CalibrationError::BadOption { .. })));
/// # Ok::<(), fingertip_calibration::loads::LoadError>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// The table of loads is wrong.
    #[error(transparent)]
    Loads(#[from] LoadError),
    /// The fit has no answer.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// Nothing can be said of creep.
    #[error(transparent)]
    Creep(#[from] CreepError),
    /// The calibration file cannot be used with the table.
    #[error(transparent)]
    File(#[from] FileError),
    /// The options contradict each other or the table.
    #[error("option `{option}`: {message}")]
    BadOption {
        /// Which one.
        option: &'static str,
        /// What is wrong.
        message: String,
    },
    /// A model with more coefficients predicts loads that it has not seen worse than a simpler one.
    #[error(
        "over-fitted: {coefficients} coefficients an axis for {samples} samples leave {fitted:.3} % of full scale on \
         the loads of the fit but {} on loads left out of it; the linear model has {linear:.3} % there",
        percent(*.left_out)
    )]
    OverFitted {
        /// Coefficients per axis.
        coefficients: usize,
        /// Samples.
        samples: usize,
        /// RMS over all axes on the loads of the fit, % of full scale.
        fitted: f64,
        /// RMS over all axes on loads left out, % of full scale; `None` if it cannot be told since
        /// some loads are needed to determine the model at all.
        left_out: Option<f64>,
        /// The same for the linear model.
        linear: f64,
    },
    /// Gauges never change, and too few are left.
    #[error(
        "{dead}, and the {left} other gauges are too few for {axes} components; mend the wiring, or leave some components out"
    )]
    DeadGauges {
        /// Which are, in words.
        dead: String,
        /// How many gauges are left.
        left: usize,
        /// How many components the loads have.
        axes: usize,
    },
    /// The fitted matrix cannot be inverted.
    #[error(
        "the fitted matrix has no inverse: some load gives no signal; fewer gauges than components, or two gauges that \
         read the same, cannot tell the loads apart"
    )]
    Singular,
}

fn percent(value: Option<f64>) -> String {
    value.map_or_else(|| "an undetermined error".to_owned(), |value| format!("{value:.3} %"))
}
