//! A fitted shape, and how sure it is.

use nalgebra::DMatrix;

use super::GeometryError;
use super::torques::Step;
use crate::fit::student_factor;

/// A fitted shape, and how sure it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted<S> {
    /// The shape.
    pub shape: S,
    /// Standard deviation of each parameter \[m\], in the order that the function tells.
    pub deviations: Vec<f64>,
    /// Degrees of freedom behind them.
    pub freedom: f64,
    /// RMS of the torque that is left, per component \[N·m\].
    pub rms: f64,
    /// What is left over what the stated noise would leave (root mean squares); near 1 where both shape and
    /// noise are as stated.
    pub noise_scale: f64,
    /// What the touches cannot tell of the shape, in words; empty if they tell everything.
    pub unobserved: Vec<String>,
}

impl<S> Fitted<S> {
    /// Half the width of the interval around each parameter that holds the true one with this probability:
    /// [`deviations`](Self::deviations) times the quantile of Student's distribution
    /// (`docs/theory/calibration.md#intervals`). NaN for a probability that is not between 0 and 1.
    #[must_use]
    pub fn half_widths(&self, probability: f64) -> Vec<f64> {
        let factor = student_factor(probability, self.freedom);
        self.deviations.iter().map(|deviation| deviation * factor).collect()
    }

    pub(super) fn of(shape: S, step: &Step, deviations: Vec<f64>) -> Self {
        Self {
            shape,
            deviations,
            freedom: step.freedom,
            rms: step.rms,
            noise_scale: step.variance().sqrt(),
            unobserved: Vec::new(),
        }
    }
}

/// Refuses what the touches leave open: each interval of 95 % must be narrower than the size beside its name.
pub(super) fn check_widths(
    step: &Step,
    deviations: &[f64],
    names: &[&str],
    sizes: &[f64],
) -> Result<(), GeometryError> {
    let factor = student_factor(0.95, step.freedom);
    for ((name, size), deviation) in names.iter().zip(sizes).zip(deviations) {
        GeometryError::check_width(name, factor * deviation, *size)?;
    }
    Ok(())
}

pub(super) fn roots(covariance: &DMatrix<f64>) -> Vec<f64> {
    covariance.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect()
}
