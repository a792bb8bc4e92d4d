//! Shapes, their laws, files of them, and point contact.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod any_bits;
mod batch;
mod dyn_surface;
mod grazing;
mod laws;
mod mesh;
mod point_contact;
