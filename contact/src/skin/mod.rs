//! Skin over a rigid core.

mod carlson;
mod hertz;
mod indentation;
mod local_hertz;
mod model;
mod simple_laws;
mod tabulated;

pub use hertz::{Hertz, contact_modulus};
pub use indentation::{Indentation, IndentationSlope, SkinLaw};
pub use local_hertz::LocalHertz;
pub use model::{Compliant, CompliantContact, CompliantPointContact, CompliantSoftFinger};
pub use simple_laws::{LinearStiffness, PowerLaw};
pub use tabulated::Tabulated;
