//! Curvature: what surfaces know beyond crossings and normals.

pub(crate) mod combinators;
mod distances;
mod flat_ends;
mod gauges;
mod implicit;
mod revolution;
mod smooth_surface;

pub use implicit::SmoothImplicit;
pub use smooth_surface::{
    Corner, Extent, Level, SmoothSurface, Topology, hessian_by_differences, shape_operator_by_differences,
};
