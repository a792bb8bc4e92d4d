//! Meshes in Collada, which descriptions of robots name.
#![no_main]

#[path = "../src/robot.rs"]
mod robot;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| robot::check("mesh.dae", bytes));
