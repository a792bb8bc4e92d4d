//! The least grip that holds.

mod assemble;
mod block;
mod cholesky;
mod cone;
mod interior;
mod iterate;
mod kernels;
mod least_grip;
mod outcome;
mod program;
mod scaled;
mod scaled_row;
mod step;
mod workspace;

pub(crate) use assemble::{Assembled, assemble};
pub(crate) use block::{Block, Row};
pub(crate) use iterate::Iterate;
pub use least_grip::{LeastGrip, Precision};
pub use outcome::{CannotHold, Grip, GripOutcome};
pub(crate) use program::{Ending, Stop};
