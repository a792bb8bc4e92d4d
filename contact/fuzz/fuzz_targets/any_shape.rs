#![no_main]
//! Any bytes as shape parameters, wrench and line: no panic, no NaN, no endless loop.

#[path = "../src/any_shape.rs"]
mod any_shape;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: (u8, Vec<u64>, Vec<u32>)| {
    let (kind, double, single) = input;
    if !double.is_empty() {
        any_shape::check_f64(kind, &double);
    }
    if !single.is_empty() {
        any_shape::check_f32(kind, &single);
    }
});
