//! The scalar that everything is generic in.

#[cfg(feature = "num-dual")]
mod dual;
pub(crate) mod hardware_sqrt;
pub(crate) mod largest;
mod powers;
mod real;
pub(crate) mod rounding;

pub use real::Real;
