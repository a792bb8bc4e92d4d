#![no_main]
//! Any bytes as an OBJ file: no panic, no endless loop, no memory that a header merely claims.

#[path = "../src/mesh_file.rs"]
#[allow(dead_code, reason = "the other target uses the rest")]
mod mesh_file;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| mesh_file::check_obj(bytes));
