//! Contacts and crossings against 220-bit arithmetic.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod big;
mod pieces;
mod quadrics;
mod revolution;
mod superquadric;
mod torus;
