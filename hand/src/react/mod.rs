//! What to command when something changes.

mod controller;
mod finger;
mod settings;

pub use controller::{HandCommand, HandController, HandState};
pub use finger::{FingerSample, FingerState, HandLoad};
pub use settings::{BadHandSettings, HandSettings};
