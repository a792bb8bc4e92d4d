//! Several simulated fingertips on one object, under gravity.
//!
//! [`SimulatedHand`] is the world: a rigid object ([`HeldObject`]), a table, fingertips on the paper's sensors, each
//! moved along the axis of its beam by a drive, skin that yields, and LuGre friction of force and spin. A
//! [`HandScript`] moves the hand, pours, pushes, and hands over. [`GrippingHand`] closes the loop at the rate of the
//! sensors: from their volts alone to the normal forces that
//! [`HandController`](fingertip_hand::HandController) wants, and to the speeds of the drives.

mod body;
mod finger;
mod gripping;
mod object;
mod script;
mod session;
mod skin;
mod surroundings;
mod weighing;
mod world;

pub use body::Inertial;
pub use finger::FingerPlace;
pub use gripping::{Felt, GrippingHand, GrippingSettings};
pub use object::HeldObject;
pub use script::{HandScript, HandSegment};
pub use session::{play_standard_hand, standard_hand};
pub use skin::SkinSettings;
pub use weighing::Weighing;
pub use world::{HandOptions, HandSample, HandTruth, SimulatedHand, TrueTouch, World};
