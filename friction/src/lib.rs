#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

mod bad_parameter;
#[cfg(feature = "std")]
mod boxed;
mod dynamics;
mod estimate;
mod grip;
mod limits;
mod slip;
#[cfg(feature = "testing")]
pub mod testing;

pub use bad_parameter::BadParameter;
pub use dynamics::{
    Advanced, Bristle, BristleLaw, Coupled, Dahl, Drive, ElastoPlastic, Exponential, Implicit, Integrator,
    LuGre, ReturnMap, StepForce, Stribeck, StribeckFriction,
};
pub use estimate::{FrictionEstimate, KineticFriction, StaticFriction};
pub use grip::{GripController, GripSettings};
pub use limits::{
    AnisotropicCoulomb, Coulomb, FrictionLimit, FrictionModel, LoadDependentLimit, PowerLimit,
    PressureDistribution, SlipDirection, SlipMargin, SoftFingerLimit, UncertainCoulomb,
};
#[cfg(feature = "std")]
pub use limits::{LimitCurve, LimitPoint};
pub use slip::run_length;
pub use slip::{
    AdaptiveDropDetector, Cusum, DropDetector, ForceNoise, IncipientSlip, LikelihoodRatio,
    LikelihoodRatioDetector, NormalForceGate, RatioThreshold, SlipDetector, SlipVerdict, StickSlip,
    StickSlipDetector,
};
