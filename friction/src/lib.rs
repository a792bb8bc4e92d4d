#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

mod anisotropic;
mod bristle;
mod bristle_law;
mod cone;
mod coulomb;
mod cusum;
mod drop_detector;
mod gate;
mod grip;
mod incipient_slip;
mod kinetic_friction;
mod likelihood_ratio;
#[cfg(feature = "std")]
mod limit_curve;
mod load_dependent;
mod model;
mod normal;
mod pressure;
mod ratio_tracker;
pub mod run_length;
mod slip_detector;
mod soft_finger;
mod static_friction;
mod stick_slip;
mod stribeck;
#[cfg(feature = "testing")]
pub mod testing;
mod threshold;
mod uncertain;

pub use anisotropic::AnisotropicCoulomb;
pub use bristle::{Bristle, Coupled, Drive, DynamicFriction, Exponential, Implicit, Integrator, ReturnMap};
pub use bristle_law::{BristleLaw, Dahl, ElastoPlastic, LuGre, StribeckFriction};
pub use coulomb::{BadFriction, Coulomb};
pub use cusum::{BadDetector, Cusum};
pub use drop_detector::DropDetector;
pub use gate::{BadNoise, ForceNoise, NormalForceGate};
pub use grip::{GripController, GripSettings};
pub use incipient_slip::IncipientSlip;
pub use kinetic_friction::KineticFriction;
pub use likelihood_ratio::{LikelihoodRatio, LikelihoodRatioDetector};
#[cfg(feature = "std")]
pub use limit_curve::{LimitCurve, LimitPoint};
pub use load_dependent::LoadDependentLimit;
pub use model::{FrictionLimit, FrictionModel, SlipDirection, SlipMargin};
pub use pressure::PressureDistribution;
pub use slip_detector::{SlipDetector, SlipVerdict};
pub use soft_finger::{PowerLimit, SoftFingerLimit};
pub use static_friction::{FrictionEstimate, StaticFriction};
pub use stick_slip::{StickSlip, StickSlipDetector};
pub use stribeck::Stribeck;
pub use threshold::RatioThreshold;
pub use uncertain::UncertainCoulomb;
