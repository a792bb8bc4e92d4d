//! Linear algebra that the fits stand on.

mod singular;
mod triangular;

pub use singular::{Singular, pseudo_inverse};
pub use triangular::{Factors, Triangular, Unobserved};
