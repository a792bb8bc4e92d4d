//! A sensor that is fitted to known loads: how to fit it, and what it is.

mod curved;
mod drift;
mod error;
mod fitting;
mod one_load;
mod options;
mod sensor_model;
mod streamed;
mod zeros;

pub(crate) use curved::{fit_at_rest, with_chosen_terms, worth_of_terms};
pub(crate) use drift::FittedDrift;
pub use error::CalibrationError;
pub(crate) use fitting::fit_model;
pub use options::{Curvature, Direction, Limits, Method, Options};
pub use sensor_model::{LoadCovariance, SensorModel};
pub(crate) use sensor_model::{design, normalised, responses};
pub use streamed::StreamedFit;
