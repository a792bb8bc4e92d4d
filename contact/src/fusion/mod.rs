//! Wrench and tactile array together.

mod cone;
mod estimate;
mod fused;
mod prior;

pub use cone::Grip;
pub use estimate::Fusion;
pub use fused::{Fused, FusedContact};
pub use prior::ArrayContact;
