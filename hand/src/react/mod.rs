//! What to command when something changes.

mod controller;
mod settings;

pub use controller::{FingerSample, HandCommand, HandController, HandState};
pub use settings::{BadHandSettings, HandSettings};
