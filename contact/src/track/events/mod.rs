//! Touch, release and impact, as the noise allows to tell them.

mod contact_events;
mod evidence;
mod impact;

pub use contact_events::{ContactEvents, Happened};
pub use impact::Impact;
