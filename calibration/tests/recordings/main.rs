//! The recordings of others, where they are present: see `common` for where they are looked for.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests, which may fail so")]

mod ati_files;
mod axia_gravity;
mod certificates;
mod common;
mod fareke;
mod optical_sensor;
