#![cfg_attr(not(feature = "std"), no_std)]
#![doc = include_str!("../README.md")]

mod active_surface;
mod contact;
mod contact_model;
mod cylinder;
mod plane;
mod point_contact;
mod smooth_surface;
mod soft_finger;
mod sphere;
mod uncertainty;

pub use active_surface::{ActiveSurface, BadShape, ClosestApproach, Crossing};
pub use contact::{Contact, NoContact, Resolution};
pub use contact_model::ContactModel;
pub use cylinder::Cylinder;
pub use plane::Plane;
pub use point_contact::PointContact;
pub use smooth_surface::{
    Extent, Level, SmoothSurface, Topology, hessian_by_differences, shape_operator_by_differences,
};
pub use soft_finger::{Search, SoftContact, SoftFinger, SoftFingerSurface, newton_soft_contacts};
pub use sphere::Sphere;
pub use uncertainty::{
    ConfidenceEllipse, ContactCovariance, ContactJacobian, ConvexBound, ErrorBudget, GeometrySensitivity,
    GeometryUncertainty, PaperBounds, SensorUncertainty, ShapeParameters, WorstCase, WrenchNoise, ball_bound,
    sphere_bound,
};
