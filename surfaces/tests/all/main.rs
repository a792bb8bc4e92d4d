//! Shapes, their laws, and files of them.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod dyn_surface;
mod heightfield;
mod hostile_files;
mod implicit;
mod laws;
mod laws_bite;
mod laws_bite_promises;
mod mesh;
mod smooth;
mod wrappers;
