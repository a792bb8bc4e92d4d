#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(all(feature = "batch", feature = "friction"))]
mod batch;
mod builder;
#[cfg(all(feature = "batch", feature = "friction"))]
mod columns;
mod error;
#[cfg(feature = "hand")]
mod finger;
mod pipeline;
pub mod prelude;
#[cfg(feature = "friction")]
mod several;
mod stage;
mod step;
#[cfg(feature = "friction")]
mod touch_sensor;
mod tracking;

pub use fingertip_contact as contact;
#[cfg(feature = "friction")]
pub use fingertip_friction as friction;
#[cfg(feature = "hand")]
pub use fingertip_hand as hand;
pub use fingertip_surfaces as surfaces;
pub use fingertip_wrench as wrench;
/// The vectors and matrices of all interfaces, in the version that they have.
pub use nalgebra;

#[cfg(all(feature = "batch", feature = "friction"))]
pub use batch::Touches;
pub use builder::FingertipBuilder;
pub use error::Error;
pub use pipeline::{Fingertip, Touch};
#[cfg(feature = "friction")]
pub use several::Fingertips;
pub use stage::{Absent, GripStage, Present, SlipStage};
pub use step::Step;
#[cfg(feature = "friction")]
pub use touch_sensor::{AnyTouch, TouchSensor};
pub use tracking::TrackStage;
#[cfg(feature = "track")]
pub use tracking::Tracking;
