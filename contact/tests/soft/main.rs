//! Soft fingers, skins, and how sure a contact is.

// Helpers of tests are tests too.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod active;
#[path = "../oracle/big.rs"]
#[allow(dead_code, reason = "another test uses the rest")]
mod big;
mod bodies;
mod coarse;
mod common;
mod compliant;
mod convex_bounds;
mod exact;
mod fusion;
mod gauge_noise;
mod golden;
mod hard_convex;
mod heights;
mod honesty;
mod jacobians;
mod limits;
mod meshes;
mod misses;
mod moved;
mod parameters;
mod pillow;
mod pitch;
mod shapes;
mod short_in_double;
mod short_ways;
mod skin;
mod skin_covariance;
mod slanted_sides;
mod solids;
mod superquadrics;
mod torus;
mod uncertainty;
#[cfg(target_os = "linux")]
mod unchanged;
mod uniqueness;
mod units;
mod wrenches;
