//! Linear algebra that the fits stand on.

mod pairs;
mod singular;
mod triangular;

pub use pairs::pairs;
pub use singular::{Singular, pseudo_inverse};
pub use triangular::{Factors, Triangular, Unobserved};
