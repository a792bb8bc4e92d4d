//! By how much the inertial readings come later than the wrench: the search for a start.

use nalgebra::Vector6;

use super::regressor::Parameters;
use super::solve::{Prior, Rows};

/// No more steps than this to each side.
const STEPS: f64 = 60.0;

/// The delay \[s\] within `±longest` with which least is left of the wrench, on a grid of about one time constant: from there
/// Newton's steps find it. `None` if no delay of the grid has an answer.
pub(super) fn coarse(
    rows: &Rows<'_>,
    longest: f64,
    time_constant: f64,
    deviations: &Vector6<f64>,
    prior: &Prior,
) -> Option<f64> {
    let steps = (longest / time_constant).ceil().clamp(1.0, STEPS);
    let count = 2 * steps as usize + 1;
    let tried = (0..count).filter_map(|k| {
        let delay = longest * (k as f64 / steps - 1.0);
        // About no parameters the delay has no effect, and is not fitted.
        let solved = rows.solve(delay, &Parameters::zeros(), deviations, prior, false)?;
        let left = solved.rms.component_div(deviations).norm_squared();
        (solved.rows > 0).then_some((delay, left))
    });
    tried.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(delay, _)| delay)
}
