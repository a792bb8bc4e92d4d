//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

extern crate alloc;

mod ati_rdt;
mod bota_serial;
mod bridge_bounds;
mod converters;
mod faulty_links;
mod line_sensors;
mod mcap;
mod mcap_by_hand;
mod middleware;
mod pace;
mod patience;
mod prototype;
mod real_recordings;
mod recording;
mod rows;
mod schunk_answers;
mod schunk_fts;
mod simulated_chips;
mod simulated_flaws;
mod simulated_truth;
mod simulation;
mod wire;
