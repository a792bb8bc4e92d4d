//! What the tests of several crates share. Not published.
#![allow(clippy::panic, clippy::expect_used)]

pub mod mcap;
mod recordings;
mod worst;

pub use recordings::{recording, recording_text};
pub use worst::Worst;
