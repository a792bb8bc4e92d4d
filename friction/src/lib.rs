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
#[cfg(feature = "std")]
mod limit_curve;
mod load_dependent;
mod model;
mod pressure;
mod ratio_tracker;
mod slip_detector;
mod soft_finger;
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
#[cfg(feature = "std")]
pub use limit_curve::{LimitCurve, LimitPoint};
pub use load_dependent::LoadDependentLimit;
pub use model::{FrictionLimit, FrictionModel, SlipDirection, SlipMargin};
pub use pressure::PressureDistribution;
pub use slip_detector::{SlipDetector, SlipVerdict};
pub use soft_finger::{PowerLimit, SoftFingerLimit};
pub use stribeck::Stribeck;
pub use threshold::RatioThreshold;
pub use uncertain::UncertainCoulomb;
