#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

mod coulomb;
mod cusum;
mod drop_detector;
mod gate;
mod model;
mod ratio_tracker;
mod slip_detector;
mod threshold;

pub use coulomb::{BadFriction, Coulomb};
pub use cusum::{BadDetector, Cusum};
pub use drop_detector::DropDetector;
pub use gate::{BadNoise, ForceNoise, NormalForceGate};
pub use model::{FrictionModel, SlipMargin};
pub use slip_detector::{SlipDetector, SlipVerdict};
pub use threshold::RatioThreshold;
