//! Numerics that several crates of this workspace share: no part of what is promised to users.

mod decay;
pub mod jacobi;
pub mod normal;
mod singular_values;

pub use decay::decay;
pub use singular_values::singular_values;
