//! Slip as the samples tell it: detectors, and how often they err.

mod cusum;
mod drop_detector;
mod gate;
mod incipient_slip;
mod likelihood_ratio;
pub(crate) mod ratio_tracker;
pub mod run_length;
mod slip_detector;
mod stick_slip;
mod threshold;

pub use cusum::{BadDetector, Cusum};
pub use drop_detector::DropDetector;
pub use gate::{BadNoise, ForceNoise, NormalForceGate};
pub use incipient_slip::IncipientSlip;
pub use likelihood_ratio::{LikelihoodRatio, LikelihoodRatioDetector};
pub use slip_detector::{SlipDetector, SlipVerdict};
pub use stick_slip::{StickSlip, StickSlipDetector};
pub use threshold::RatioThreshold;
