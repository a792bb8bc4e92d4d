//! Friction in motion: bristles, their laws and their integration in time.

mod bristle;
mod bristle_law;
mod integrator;
mod stribeck;

pub use bristle::{Bristle, Coupled, Drive, StepForce};
pub use bristle_law::{BristleLaw, Dahl, ElastoPlastic, LuGre, StribeckFriction};
pub use integrator::{Advanced, Exponential, Implicit, Integrator, ReturnMap};
pub use stribeck::Stribeck;
