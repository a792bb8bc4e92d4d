//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

#[path = "../support/mod.rs"]
mod support;

mod least_grip;
