//! Coefficients of friction, learnt from touches.

mod kinetic_friction;
mod static_friction;

pub use kinetic_friction::KineticFriction;
pub use static_friction::{FrictionEstimate, StaticFriction};
