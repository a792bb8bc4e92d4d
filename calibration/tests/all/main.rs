//! The tests of the crate from outside, as one program: each program more is linked again.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests, which may fail so")]

mod consensus;
mod covariance;
mod coverage;
mod creep;
mod curved;
mod design_end_to_end;
mod design_optimum;
mod drift_coverage;
mod equivariance;
mod file_covariance;
mod files;
mod in_situ;
mod inertial;
mod intervals;
mod kept;
mod metrics;
mod mistakes;
mod motion;
mod objects;
mod payload;
mod plans;
mod plots;
mod pose_coverage;
mod random;
mod recordings;
mod refusals;
mod report;
mod report_forms;
mod residuals;
mod robust;
mod rust_constants;
mod searches;
mod shapes;
mod spread;
mod structures;
mod tables;
mod tares;
#[path = "../../src/testing.rs"]
mod testing;
mod touch_noise;
mod touched;
#[cfg(target_os = "linux")]
mod unchanged;
mod untangling;
mod verdict;
