//! Calibration by gravity: a body of unknown weight in several poses.

mod error;
mod frames;
mod orientation;
mod payload;
mod payload_parts;
mod payload_sureness;
mod pose_noise;
mod poses;
mod products;
mod quadratic;

pub use error::PayloadError;
pub use frames::{FrameTrial, Frames, try_frames};
pub use orientation::{Orientation, fit_orientation};
pub use payload::{PayloadFit, PayloadFreedom, PayloadOptions, fit_payload};
pub use poses::{Pose, poses_from_csv};
