//! What each shape has of its own for a contact: its soft fingers, its batches, its sizes.

mod capsule;
mod combinators;
mod cone;
mod cylinder;
#[cfg(feature = "alloc")]
mod dyn_surface;
mod ellipsoid;
mod elliptic_cylinder;
mod frustum;
#[cfg(feature = "alloc")]
mod heightfield;
mod implicit;
#[cfg(feature = "alloc")]
mod mesh;
mod paraboloid;
mod plane;
mod revolution;
mod rounded_box;
mod slanted_side;
mod sphere;
mod superquadric;
mod torus;
