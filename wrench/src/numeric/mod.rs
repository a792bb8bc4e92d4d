//! Numerics that several crates of this workspace share: no part of what is promised to users.

pub mod jacobi;
pub mod normal;
mod singular_values;

pub use singular_values::singular_values;
