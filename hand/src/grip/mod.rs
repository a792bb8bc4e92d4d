//! The least grip that holds.

mod block;
mod cholesky;
mod cone;
mod least_grip;
mod outcome;
mod program;

pub(crate) use block::Row;
pub use least_grip::{LeastGrip, Precision};
pub use outcome::{CannotHold, Grip, GripOutcome};
