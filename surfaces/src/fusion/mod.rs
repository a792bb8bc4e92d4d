//! Wrench and tactile array together.

mod cone;
mod estimate;
mod prior;

pub use estimate::{Fused, FusedContact, Fusion, Grip};
pub use prior::ArrayContact;
