//! What is held, and what else touches it.

mod other;
mod weight;

pub use other::OtherContact;
pub use weight::{ObjectWeight, WeightEstimate};
