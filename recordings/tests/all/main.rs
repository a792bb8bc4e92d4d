//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod csv;
mod mcap;
mod mcap_by_hand;
mod mcap_damaged;
mod real_recordings;
mod rows;
