//! Shapes, their laws, files of them, point contact, and how sure it is.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod any_bits;
mod auto;
mod bad_uncertainty;
mod batch;
mod convex_bound;
mod covariance;
mod dyn_surface;
mod fusion;
mod grazing;
mod heightfield;
mod hostile_files;
mod laws;
mod laws_bite;
mod mesh;
mod point_contact;
mod smooth;
mod worst_case;
