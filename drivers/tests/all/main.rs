//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

extern crate alloc;

mod ati_rdt;
mod bota_serial;
mod converters;
mod line_sensors;
mod middleware;
mod patience;
mod playback;
mod schunk_fts;
