//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests")]

mod hand;
mod hand_consistency;
mod hand_session;
mod health;
mod prototype;
mod simulated_flaws;
mod simulated_truth;
mod simulation;
mod tracking;
#[cfg(target_os = "linux")]
mod unchanged;
