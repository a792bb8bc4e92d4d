#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

#[cfg(feature = "alloc")]
extern crate alloc;

mod active_surface;
mod auto;
mod bad_shape;
pub mod batch;
mod combinators;
mod compliant;
mod contact;
#[cfg(feature = "alloc")]
mod dyn_surface;
mod force_line;
mod fusion;
#[cfg(feature = "alloc")]
mod heightfield;
#[cfg(feature = "alloc")]
mod mesh;
mod numeric;
mod shapes;
mod signed_distance;
mod smooth;
mod soft_finger;
pub mod testing;
mod uncertainty;

pub use active_surface::{ActiveSurface, ClosestApproach, Crossing, Entry, ForceParts};
pub use auto::{Auto, Choice, PitchTest};
pub use bad_shape::BadShape;
pub use combinators::{Compound, HalfSpace, Offset, Posed, Region, Trimmed};
pub use compliant::{
    Compliant, CompliantContact, CompliantPointContact, CompliantSoftFinger, Hertz, Indentation,
    IndentationSlope, LinearStiffness, LocalHertz, PowerLaw, SkinLaw, StiffnessLaw, Tabulated,
    contact_modulus,
};
pub use contact::{Contact, ContactBound, ContactModel, NoContact, PointContact, Resolution, WorstErrors};
#[cfg(feature = "alloc")]
pub use dyn_surface::{DynSurface, Parts};
pub use force_line::ForceLine;
pub use fusion::{ArrayContact, Fused, FusedContact, Fusion, Grip};
#[cfg(feature = "alloc")]
pub use heightfield::Heightfield;
#[cfg(feature = "alloc")]
pub use mesh::{Mesh, MeshError};
pub use shapes::*;
pub use signed_distance::{Distance, SignedDistance};
pub use smooth::{
    Corner, Extent, Level, SmoothImplicit, SmoothSurface, Topology, hessian_by_differences,
    shape_operator_by_differences,
};
pub use soft_finger::{Patch, Search, SoftContact, SoftFinger, SoftFingerSurface, newton_soft_contacts};
pub use uncertainty::{
    ConfidenceEllipse, ContactCovariance, ContactJacobian, ConvexBound, GeometrySensitivity,
    GeometryUncertainty, IndependentNoise, IsotropicNoise, PaperBounds, SensorUncertainty, ShapeParameters,
    WorstCase, WrenchNoise, WrenchSpread,
};
