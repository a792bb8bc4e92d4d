//! What a sensor carries, from a motion: mass, centre and inertia by the readings of an inertial unit.

mod body;
mod delay;
mod error;
mod fit;
mod outcome;
mod regressor;
mod samples;
mod smoothed;
mod solve;

pub use body::{Body, Consistency};
pub use error::InertialError;
pub use fit::{InertialOptions, fit_inertial};
pub use outcome::{Delay, InertialFit};
pub use samples::{MovingSample, moving_samples};
