//! Friction in motion: bristles, their laws and their integration in time.

mod bristle;
mod bristle_law;
mod stribeck;

pub use bristle::{Bristle, Coupled, Drive, DynamicFriction, Exponential, Implicit, Integrator, ReturnMap};
pub use bristle_law::{BristleLaw, Dahl, ElastoPlastic, LuGre, StribeckFriction};
pub use stribeck::Stribeck;
