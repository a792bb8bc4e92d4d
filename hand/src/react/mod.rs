//! What to command when something changes.

mod belief;
mod controller;
mod finger;
mod settings;

pub use belief::{AnyBelief, FrictionBelief, LearntFriction, SlipFactor};
pub use controller::{HandCommand, HandController, HandState};
pub use finger::{FingerSample, FingerState, HandLoad};
pub use settings::{BadHandSettings, HandSettings};
