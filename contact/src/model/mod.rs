//! From wrench and surface to contact.

mod auto;
mod bound;
mod contact_model;
mod long_way;
mod onto_line;
mod outcome;
mod point_contact;
mod seen;

pub use auto::{Auto, Choice, PitchTest};
pub use bound::{ContactBound, WorstErrors};
pub use contact_model::ContactModel;
pub(crate) use long_way::long_way;
pub(crate) use onto_line::{normal_at, outside_by, torque_left};
pub use outcome::{Contact, NoContact, Resolution};
pub use point_contact::PointContact;
pub(crate) use point_contact::{flat, flat_when_moved};
