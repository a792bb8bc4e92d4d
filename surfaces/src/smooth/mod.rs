//! Curvature: what surfaces know beyond crossings and normals.

pub(crate) mod flat_ends;
mod smooth_surface;

pub use smooth_surface::{
    Corner, Extent, Level, SmoothSurface, Topology, hessian_by_differences, shape_operator_by_differences,
};
