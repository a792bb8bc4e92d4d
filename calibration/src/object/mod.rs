//! An object that a fingertip touches: points of its surface, and the plane, sphere or cylinder that they lie on.

mod cylinder;
mod error;
mod fit;
mod plane;
mod ply;
mod point;
mod sphere;

pub use cylinder::fit_cylinder;
pub use error::ObjectError;
pub use fit::{Concave, FittedObject};
pub use plane::fit_plane;
pub use ply::to_ply;
pub use point::{ObjectPoint, PoseNoise};
pub use sphere::fit_sphere;
