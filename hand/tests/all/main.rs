//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

#[path = "../support/mod.rs"]
mod support;

mod extremes;
mod grasps;
mod least_grip;
mod objects;
mod quality;
mod reaction;
