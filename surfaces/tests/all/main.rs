//! Shapes, their laws, files of them, point contact, and how sure it is.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod any_bits;
mod bad_uncertainty;
mod batch;
mod convex_bound;
mod covariance;
mod dyn_surface;
mod grazing;
mod hostile_files;
mod laws;
mod laws_bite;
mod mesh;
mod point_contact;
mod worst_case;
