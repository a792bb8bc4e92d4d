//! What to command when something changes.

mod belief;
mod command;
mod controller;
mod finger;
mod settings;
mod squeeze;

pub use belief::{AnyBelief, FrictionBelief, LearntFriction, SlipFactor};
pub use command::{HandCommand, HandState};
pub use controller::HandController;
pub use finger::{FingerSample, FingerState, HandLoad};
pub use settings::{BadHandSettings, HandSettings};
