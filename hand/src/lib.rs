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
    AnyBelief, BadHandSettings, FingerSample, FingerState, FrictionBelief, HandCommand, HandController,
    HandLoad, HandSettings, HandState, LearntFriction, SlipFactor,
};
