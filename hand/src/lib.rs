#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

mod bad_contact;
mod contact;
mod friction;
mod grasp;
mod grip;
mod limits;
mod load;
mod object;
mod quality;
mod react;
mod triangle;

pub use bad_contact::{BadContact, BadLimit};
pub use contact::{GraspContact, Hand};
pub use friction::ContactFriction;
pub use grasp::{Freedom, Grasp, SplitForces};
pub use grip::{CannotHold, Grip, GripOutcome, LeastGrip, Precision};
pub use limits::FingerLimits;
pub use load::{FingerContact, UncertainWrench};
pub use object::{ObjectWeight, OtherContact, WeightEstimate};
pub use quality::{GraspBall, Metric, Reach};
pub use react::{
    BadHandSettings, FingerSample, FingerState, FrictionBelief, HandCommand, HandController, HandLoad,
    HandSettings, HandState, LearntFriction, SlipFactor,
};

/// T.
pub static TUNE: [core::sync::atomic::AtomicU64; 8] = [const { core::sync::atomic::AtomicU64::new(0) }; 8];
/// T.
pub fn tune(i: usize) -> f64 { f64::from_bits(TUNE[i].load(core::sync::atomic::Ordering::Relaxed)) }
