//! Shape from motion: calibration by a weight of known size in unknown directions (Voyles, Morrow &
//! Khosla 1997).

mod constant_force;
mod lever_arms;
mod likelihood;

pub use constant_force::{ConstantForce, MotionError, constant_force};
pub use lever_arms::{LeverArm, LeverArmFit, lever_arms};
