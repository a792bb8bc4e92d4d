//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

#[path = "../support/mod.rs"]
mod support;

mod ball;
mod beliefs;
mod extremes;
mod freedoms;
mod grasps;
mod joints;
mod least_grip;
mod objects;
mod precision;
mod quality;
mod reaction;
mod squeeze;
mod stored;
mod warm_starts;
mod without_safety;
