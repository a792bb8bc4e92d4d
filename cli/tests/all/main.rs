//! The commands from outside, as one program: its parts run beside each other.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests, which may fail so")]

mod analyze;
mod analyze_rows;
mod bench;
mod calibrate;
mod calibrate_options;
#[path = "../common/mod.rs"]
mod common;
mod conversions;
mod demo;
mod design;
mod errors_page;
mod exports;
mod fused;
mod hand;
mod health;
mod library;
mod live;
mod nano17;
mod object;
mod recorded;
mod recordings;
mod reports;
mod said;
mod said_of_files;
mod said_of_scenes;
mod scenes;
mod sensors_that_fail;
mod shapes;
mod spared_files;
mod standard_streams;
mod streams;
mod toolchains;
mod whole_files;
