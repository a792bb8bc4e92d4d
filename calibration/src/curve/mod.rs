//! Curved sensors: the terms of higher order beside the matrix, which of them are worth having, and where the fit means
//! anything (`docs/theory/calibration.md#curved-sensors`).

mod forward;
mod region;
mod selection;
mod terms;

pub use region::Region;
pub(crate) use selection::{Chosen, choose};
pub use terms::Terms;
