#![doc = include_str!("../README.md")]

mod design;
#[cfg(feature = "devices")]
mod device;
mod electronics;
mod error;
mod fingertip;
#[cfg(feature = "hand")]
pub mod hand;
mod imperfections;
mod ramp;
mod score;
mod script;
mod sensor;
mod session;
mod surface_point;
mod thermal_drift;
mod timeline;

pub use design::Design;
#[cfg(feature = "devices")]
pub use device::DEVICE;
pub use electronics::Electronics;
pub use error::{ScriptProblem, SimulationError};
pub use fingertip::{Options, SimulatedFingertip, SimulatedSample, Truth};
pub use imperfections::Imperfections;
pub use score::{LevelScore, PressScore, SessionReport, SessionScore, SlipScore};
pub use script::{Script, Segment};
pub use session::standard_session;
pub use surface_point::SurfacePoint;
pub use thermal_drift::ThermalDrift;
pub use timeline::{Phase, TrueContact};
