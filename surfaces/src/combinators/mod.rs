//! Shapes made of shapes.

mod compound;
mod offset;
mod posed;
mod trimmed;

pub use compound::Compound;
#[cfg(feature = "alloc")]
pub(crate) use compound::closest_of;
#[doc(hidden)]
pub use compound::is_inside_along;
pub use offset::Offset;
pub use posed::Posed;
pub use trimmed::{HalfSpace, Region, Trimmed};
