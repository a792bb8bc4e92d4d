#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(feature = "alloc")]
extern crate alloc;

mod active_surface;
mod bad_shape;
mod combinators;
#[cfg(feature = "alloc")]
mod dyn_surface;
mod force_line;
#[cfg(feature = "alloc")]
mod heightfield;
mod local_surface;
#[cfg(feature = "alloc")]
mod mesh;
#[doc(hidden)]
#[allow(missing_docs, reason = "shared with the crate of the contact, and no part of the interface")]
pub mod numeric;
mod shapes;
mod shortcuts;
mod signed_distance;
mod smooth;
pub mod testing;

pub use active_surface::{ActiveSurface, ClosestApproach, Crossing, Entry, ForceParts};
#[doc(hidden)]
pub use active_surface::{nearest_crossing, rare_crossings};
pub use bad_shape::BadShape;
#[doc(hidden)]
pub use combinators::is_inside_along;
pub use combinators::{Compound, HalfSpace, Offset, Posed, Region, Trimmed};
#[cfg(feature = "alloc")]
pub use dyn_surface::DynSurface;
pub use force_line::ForceLine;
#[cfg(feature = "alloc")]
pub use heightfield::Heightfield;
pub use local_surface::LocalSurface;
#[cfg(feature = "alloc")]
pub use mesh::{Mesh, MeshError};
pub use shapes::*;
#[doc(hidden)]
pub use shortcuts::is_closed_convex;
pub use shortcuts::{LineInDouble, NoShortcuts, Shortcuts};
pub use signed_distance::{Distance, SignedDistance};
pub use smooth::{
    Corner, Extent, Level, SmoothSurface, Topology, hessian_by_differences, shape_operator_by_differences,
};
