#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

mod bad_contact;
mod contact;
mod grasp;
mod grip;
mod limits;

pub use bad_contact::{BadContact, BadLimit};
pub use contact::{GraspContact, Hand};
pub use grasp::Grasp;
pub use grip::{CannotHold, Grip, GripOutcome, LeastGrip, Precision};
pub use limits::FingerLimits;
