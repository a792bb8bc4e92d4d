//! How much tangential force and torque a contact bears: friction limits and margins.

mod anisotropic;
pub(crate) mod cone;
mod coulomb;
#[cfg(feature = "std")]
mod limit_curve;
mod load_dependent;
mod model;
mod pressure;
pub(crate) mod soft_finger;
mod uncertain;

pub use anisotropic::AnisotropicCoulomb;
pub use coulomb::Coulomb;
#[cfg(feature = "std")]
pub use limit_curve::{LimitCurve, LimitPoint};
pub use load_dependent::LoadDependentLimit;
pub use model::{FrictionLimit, FrictionModel, SlipDirection, SlipMargin};
pub use pressure::PressureDistribution;
pub use soft_finger::{PowerLimit, SoftFingerLimit};
pub use uncertain::UncertainCoulomb;
