//! Every shape under random wrenches, against contacts that are computed with some 31 digits: sizes of a
//! micrometre to a kilometre, forces of 1e-12 to 1e12 N, cosines of incidence down to 1e-3, spin torques to 1e4
//! times force times size, and pure forces that miss. `cargo test --release --test trials -- --ignored` tries a
//! million on each shape.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(
    clippy::op_ref,
    clippy::clone_on_copy,
    reason = "other tests use these files with a number that is no copy"
)]

#[path = "../oracle/twice.rs"]
#[allow(dead_code, reason = "another test uses the rest")]
mod big;
mod draw;
#[path = "../soft/exact.rs"]
#[allow(dead_code, reason = "another test uses the rest")]
mod exact;
mod found;
mod more;
#[path = "../soft/solids.rs"]
mod solids;
mod solve;
mod table;
mod try_out;
#[path = "../soft/wrenches.rs"]
#[allow(dead_code, reason = "another test uses the rest")]
mod wrenches;
