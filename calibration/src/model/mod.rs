//! From a table of known loads to a sensor that can be trusted.

mod calibrate;
mod options;
mod pairs;
mod sensor_model;
mod streamed;
mod zeros;

pub(crate) use crate::fit::deviation;
pub use calibrate::{Calibration, CalibrationError, calibrate};
pub use options::{Direction, Limits, Method, Options};
pub use pairs::pairs;
pub use sensor_model::SensorModel;
pub(crate) use sensor_model::normalised;
pub use streamed::StreamedFit;
