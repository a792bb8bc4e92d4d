//! Descriptions of robots, of which a scene takes a link. Meshes that they name are tried by `collada`, and in `surfaces`.
#![no_main]

#[path = "../src/robot.rs"]
mod robot;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    // Files of others are not what is tried here, and some have no end.
    if !text.contains("filename") {
        robot::check("robot.urdf", text.as_bytes());
    }
});
