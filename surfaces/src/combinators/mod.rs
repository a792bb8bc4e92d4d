//! Shapes made of shapes.

mod compound;
mod offset;
mod posed;
mod trimmed;

pub use compound::Compound;
#[doc(hidden)]
pub use compound::is_inside_along;
pub use offset::Offset;
pub use posed::Posed;
pub use trimmed::{HalfSpace, Region, Trimmed};
