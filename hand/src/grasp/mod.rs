//! Several contacts on one object.

mod value;

pub use value::Grasp;
