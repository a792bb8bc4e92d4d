//! Calibration by gravity: a body of unknown weight in several poses.

mod payload;
mod poses;

pub use payload::{Orientation, PayloadError, PayloadFit, PayloadOptions, fit_orientation, fit_payload};
pub use poses::{Pose, poses_from_csv};
