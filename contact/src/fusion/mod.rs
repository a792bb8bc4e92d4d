//! Wrench and tactile array together.

mod cone;
mod estimate;
mod prior;

pub use cone::Grip;
pub use estimate::{Fused, FusedContact, Fusion};
pub use prior::ArrayContact;
