//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::expect_used, clippy::panic, clippy::needless_range_loop, reason = "tests")]

mod any_bits;
mod conditioning;
mod error_bounds;
mod frames;
mod gauge_layouts;
mod least_squares;
mod line_of_action;
mod minimal_solvers;
mod published_certificates;
mod rest_and_channels;
mod serialisation;
#[path = "../support/mod.rs"]
mod support;
