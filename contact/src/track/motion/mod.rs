//! How a finger moves against what it touches: sticking, rolling, sliding, and what rolling tells of the object.

mod finger_velocity;
mod judge;
mod rolled;

pub use finger_velocity::FingerVelocity;
pub use judge::{MotionJudge, Motions};
pub use rolled::{NoCurvature, ObjectCurvature, RollingCurvature};
