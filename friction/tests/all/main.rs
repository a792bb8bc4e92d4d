//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::unwrap_used, reason = "tests")]

mod detectors;
mod dynamics;
mod limits;
mod stored;
mod tribometer;
