//! Contact with a spin torque about the normal: the soft finger.

pub(crate) mod combinators;
mod cone;
mod convex;
mod cylinder;
mod ellipsoid;
mod frustum;
#[cfg(feature = "alloc")]
mod heightfield;
mod mended;
#[cfg(feature = "alloc")]
mod mesh;
mod model;
pub(crate) mod newton;
mod plane;
mod revolution;
mod rim;
mod search;
mod shapes;
mod solution;
mod torus;
mod unit_sphere;

pub use model::SoftFinger;
pub use search::newton_soft_contacts;
pub use solution::{Search, SoftContact, SoftFingerSurface};
