//! How safe a grasp is.

mod ball;
mod closure;
mod margins;
mod reach;

pub use ball::{GraspBall, Metric};
pub use reach::Reach;
