//! Contact with a spin torque about the normal: the soft finger.

pub(crate) mod closed_form;
pub(crate) mod convex;
pub(crate) mod double;
pub(crate) mod edge;
pub(crate) mod mended;
pub(crate) mod model;
pub(crate) mod newton;
pub(crate) mod patch;
pub(crate) mod placed;
pub(crate) mod refined;
pub(crate) mod resolve;
pub(crate) mod rim;
pub(crate) mod search;
pub(crate) mod solution;
pub(crate) mod sure_rim;
mod three;
pub(crate) mod tip;
pub(crate) mod unit_sphere;

pub use model::SoftFinger;
pub use placed::Patch;
pub use search::newton_soft_contacts;
pub use solution::{Search, SoftContact, SoftFingerSurface};
