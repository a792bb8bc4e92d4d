//! Wrenches, the frames they are told in, and the line and the parts of a force.

mod contact_force;
mod contact_frame;
mod frame;
mod line_of_action;
mod tangential_force;
mod tangents;
mod transform;
mod wrench;

pub use contact_force::ContactForce;
pub use contact_frame::{BadNormal, ContactFrame, ContactLoad};
pub use frame::{Frame, Sensor};
pub use line_of_action::{Line, LineOfAction, NoLineOfAction};
pub use tangential_force::{TangentialForce, scaled_length};
pub use tangents::tangents;
pub use transform::{RigidTransform, TransformError};
pub use wrench::Wrench;
