#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(feature = "alloc")]
extern crate alloc;

mod active_surface;
mod bad_shape;
pub mod batch;
mod combinators;
mod contact;
#[cfg(feature = "alloc")]
mod dyn_surface;
#[cfg(feature = "alloc")]
mod heightfield;
#[cfg(feature = "alloc")]
mod mesh;
mod numeric;
mod serde_parts;
mod shapes;
mod signed_distance;
pub mod testing;

pub use active_surface::{ActiveSurface, ClosestApproach, Crossing};
pub use bad_shape::BadShape;
pub use combinators::{Compound, HalfSpace, Offset, Posed, Region, Trimmed};
pub use contact::{Contact, ContactBound, ContactModel, NoContact, PointContact, Resolution, WorstErrors};
#[cfg(feature = "alloc")]
pub use dyn_surface::{DynSurface, Parts};
#[cfg(feature = "alloc")]
pub use heightfield::Heightfield;
#[cfg(feature = "alloc")]
pub use mesh::{Mesh, MeshError};
pub use shapes::*;
pub use signed_distance::{Distance, SignedDistance};
