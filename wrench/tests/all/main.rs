//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::expect_used, clippy::panic, clippy::needless_range_loop, reason = "tests")]

mod any_bits;
mod bad_uncertainties;
mod channel_limits;
mod channel_noise;
mod compensations;
mod conditioning;
mod consistency_limits;
mod contact_frames;
mod counted_rounding;
mod elementary_functions;
mod error_bounds;
mod frames;
mod gauge_layouts;
mod least_squares;
mod line_of_action;
mod minimal_solvers;
mod moving_payload;
mod published_certificates;
mod reached_bounds;
mod rest_and_channels;
mod rest_limits;
mod rotations;
mod serialisation;
mod solver_limits;
#[path = "../support/mod.rs"]
mod support;
#[cfg(target_os = "linux")]
mod unchanged;
