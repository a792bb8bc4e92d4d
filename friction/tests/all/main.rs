//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::unwrap_used, reason = "tests")]

#[path = "../support/stick_slip.rs"]
mod reference;

mod adaptive;
mod anisotropic;
mod body;
mod broken_detectors;
mod broken_limits;
mod broken_models;
mod cones;
mod damping;
mod detectors;
mod dynamics;
mod estimators;
mod evidence;
mod grip;
mod incipient;
mod integrators;
mod laws_of_detectors;
mod limits;
mod load_dependent;
mod resets;
mod run_lengths;
mod statistics;
mod stick_slip;
mod stored;
mod tracker;
mod tribometer;
#[cfg(target_os = "linux")]
mod unchanged;
