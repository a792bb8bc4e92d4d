//! Soft fingers, skins, and how sure a contact is.

// Helpers of tests are tests too.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../oracle/big.rs"]
#[allow(dead_code, reason = "another test uses the rest")]
mod big;
mod bodies;
mod common;
mod compliant;
mod exact;
mod fusion;
mod golden;
mod honesty;
mod jacobians;
mod pillow;
mod shapes;
mod skin;
mod solids;
mod torus;
mod uncertainty;
mod uniqueness;
mod wrenches;
