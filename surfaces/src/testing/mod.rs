//! Laws that every surface obeys, to be run on your own shapes.
//!
//! ```
//! use fingertip_surfaces::Sphere;
//! use fingertip_surfaces::testing::SurfaceLaws;
//! use nalgebra::Vector3;
//!
//! let centre = Vector3::new(0.0, 0.0, 0.03);
//! let laws = SurfaceLaws::around(centre, 0.013_f64);
//! laws.check(&Sphere::new(centre, 0.013)?)?;
//! laws.check_scaling(|scale| Sphere::new(centre * scale, 0.013 * scale).ok())?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "alloc")]
mod ball;
mod closest;
mod collect;
mod crossings;
#[cfg(feature = "alloc")]
mod cube;
mod law;
mod laws;
mod random;
mod tried;
mod wrapper;

#[cfg(feature = "alloc")]
pub use ball::ball_of_triangles;
#[cfg(feature = "alloc")]
pub use cube::cube_of_triangles;
pub use law::{Law, Violation};
pub use laws::SurfaceLaws;
pub use wrapper::Kept;
