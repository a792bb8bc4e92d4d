//! The shapes, one file each.

mod axis;
mod capped_cylinder;
mod capsule;
mod cone;
mod cylinder;
mod disk;
mod ellipsoid;
mod elliptic_cylinder;
#[cfg(feature = "alloc")]
mod formula;
mod frustum;
mod implicit;
mod outline;
mod paraboloid;
mod plane;
mod profile;
mod profile_crossings;
mod rectangle;
mod revolution;
mod ring;
mod rounded_box;
mod sight;
mod sphere;
mod spherical_cap;
mod steepness;
mod superquadric;
mod superquadric_entry;
mod superquadric_gauge;
mod term;
mod torus;

pub use capped_cylinder::CappedCylinder;
pub use capsule::Capsule;
pub use cone::Cone;
pub use cylinder::Cylinder;
pub use disk::Disk;
pub use ellipsoid::Ellipsoid;
pub use elliptic_cylinder::{CylinderEnds, EllipticCylinder};
#[cfg(feature = "alloc")]
pub use formula::{Formula, FormulaStep};
pub use frustum::Frustum;
pub use implicit::{Implicit, ImplicitSurface};
pub use paraboloid::Paraboloid;
pub use plane::Plane;
pub use profile::{Knot, Profile, ProfileInDouble};
pub use rectangle::Rectangle;
pub use revolution::Revolution;
pub use rounded_box::RoundedBox;
pub use sphere::Sphere;
pub use spherical_cap::SphericalCap;
pub use superquadric::Superquadric;
#[doc(hidden)]
pub use superquadric_gauge::{Gauge, Powers};
pub use term::Term;
pub use torus::Torus;
