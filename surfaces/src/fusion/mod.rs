//! Wrench and tactile array together.

mod estimate;
mod prior;

pub use estimate::{Fused, FusedContact, Fusion};
pub use prior::ArrayContact;
