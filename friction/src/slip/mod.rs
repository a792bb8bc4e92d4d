//! Slip as the samples tell it: detectors, and how often they err.

mod adaptive_drop;
mod block_maxima;
mod change_test;
mod cusum;
mod drop_detector;
mod followed_lines;
mod gate;
mod incipient_slip;
mod likelihood_ratio;
mod predictor;
mod ratio_tracker;
pub mod run_length;
mod sample_block;
mod slip_detector;
mod stick_slip;
mod threshold;

pub use adaptive_drop::AdaptiveDropDetector;
pub use cusum::Cusum;
pub use drop_detector::DropDetector;
pub use gate::{ForceNoise, NormalForceGate};
pub use incipient_slip::IncipientSlip;
pub use likelihood_ratio::{LikelihoodRatio, LikelihoodRatioDetector};
pub use slip_detector::{SlipDetector, SlipVerdict};
pub use stick_slip::{StickSlip, StickSlipDetector};
pub use threshold::RatioThreshold;
