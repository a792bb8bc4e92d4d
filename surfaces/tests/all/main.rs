//! Shapes, their laws, and files of them.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod construction;
mod corners;
mod dyn_surface;
mod every_shape;
mod extents;
mod far_lines;
mod far_normals;
mod formula;
mod heightfield;
mod hostile_files;
mod implicit;
mod laws;
mod laws_bite;
mod laws_bite_promises;
mod mesh;
mod nearest_facet;
mod on_the_surface;
mod residual;
mod smooth;
mod special_lines;
mod superquadric;
#[cfg(target_os = "linux")]
mod unchanged;
mod wrappers;
