//! Linear algebra that the fits stand on.

mod factors;
mod less;
mod pairs;
mod singular;
mod triangular;

pub use factors::{Factors, Unobserved};
pub(crate) use less::less;
pub use pairs::pairs;
pub(crate) use singular::quick_inverse;
pub use singular::{Singular, pseudo_inverse};
pub use triangular::Triangular;
