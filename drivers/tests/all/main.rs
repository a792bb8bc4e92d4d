//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests")]

extern crate alloc;

mod ati_rdt;
mod bota_serial;
mod bridge_bounds;
mod converters;
mod devices;
mod faulty_links;
mod line_sensors;
mod middleware;
mod pace;
mod patience;
mod playback;
mod restart;
mod schunk_answers;
mod schunk_fts;
mod simulated_chips;
mod wire;
