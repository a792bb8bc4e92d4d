//! Friction in motion: bristles, their laws and their integration in time.

mod bristle;
mod bristle_law;
mod integrator;
mod step;
mod stribeck;

pub use bristle::Bristle;
pub use bristle_law::{BristleLaw, Dahl, ElastoPlastic, LuGre, StribeckFriction};
pub use integrator::{Advanced, Exponential, Implicit, Integrator, ReturnMap};
pub use step::{Coupled, Drive, StepForce};
pub use stribeck::Stribeck;
