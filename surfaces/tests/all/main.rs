//! Shapes, their laws, and files of them.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod dyn_surface;
mod laws;
mod mesh;
