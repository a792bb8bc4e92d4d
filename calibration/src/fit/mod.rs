//! The fits themselves: linear regression in all the ways that a calibration needs.
//!
//! Everything here is `f64`: a calibration is fitted once, on a computer; what it gives is
//! converted to any scalar. Matrices have one sample per row.

mod errors_in_both;
mod gauss_helmert;
mod huber;
mod leave_out;
mod ransac;
mod regression;
mod ridge;
mod temperature;
#[cfg(test)]
pub(crate) mod testing;
mod total;

pub(crate) use errors_in_both::with_noise_of_regressors;
pub(crate) use gauss_helmert::gauss_helmert_of_shares;
pub use gauss_helmert::{gauss_helmert, gauss_helmert_correlated};
pub(crate) use huber::deviation;
pub use huber::{HUBER_THRESHOLD, huber};
pub use leave_out::leave_out;
pub(crate) use leave_out::{Change, leave_out_changes};
pub use ransac::{Ransac, ransac};
pub use regression::{Fit, FitError, least_squares, student_factor};
pub use ridge::ridge;
pub use temperature::{TemperatureFit, fit_temperature};
pub use total::total_least_squares;
