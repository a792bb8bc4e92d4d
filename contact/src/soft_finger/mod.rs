//! Contact with a spin torque about the normal: the soft finger.

mod capsule;
mod closed_form;
mod combinators;
mod cone;
mod convex;
mod cylinder;
mod double;
#[cfg(feature = "alloc")]
mod dyn_surface;
mod ellipsoid;
mod elliptic_cylinder;
mod frustum;
#[cfg(feature = "alloc")]
mod heightfield;
mod mended;
#[cfg(feature = "alloc")]
mod mesh;
mod model;
mod newton;
mod patch;
mod plane;
mod refined;
mod revolution;
mod rim;
mod rounded_box;
mod search;
mod smooth_shapes;
mod solution;
mod torus;
mod unit_sphere;

pub use model::SoftFinger;
pub use search::newton_soft_contacts;
pub use solution::{Search, SoftContact, SoftFingerSurface};
