//! Several contacts on one object.

mod freedom;
mod internal;
mod spectrum;
mod value;

pub(crate) use spectrum::Spectrum;

pub use freedom::Freedom;
pub use internal::SplitForces;
pub use value::Grasp;
