//! Long recordings and closed pipes.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "helpers of tests, which may fail so")]

mod common;

use std::fs::File;
use std::io::{BufWriter, Write};
use std::process::{Command, Stdio};

use common::Folder;

const SCENE: &str = "version = 1\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"plane\"\n";

/// A recording of so many rows, 60 bytes each, whose last contact is the only one off the centre.
fn long(folder: &Folder, rows: u32) {
    folder.write("scene.toml", SCENE);
    let mut file = BufWriter::new(File::create(folder.path("long.csv")).unwrap());
    writeln!(file, "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm").unwrap();
    for row in 1..=rows {
        let torque = if row == rows { "0.500000" } else { "0.000000" };
        let load = 1.0 + f64::from(row % 1000) * 0.001;
        writeln!(
            file,
            "{:.3},0.000000,0.000000,-{load:.6},{torque},0.000000,0.000000",
            f64::from(row) * 0.001
        )
        .unwrap();
    }
    file.into_inner().unwrap();
}

/// Runs the program in an address space of 40 MB, which it shares with its libraries.
#[cfg(target_os = "linux")]
fn in_small_memory(folder: &Folder, arguments: &str) -> std::process::Output {
    let run = format!("ulimit -v 40000 && exec {} {arguments}", env!("CARGO_BIN_EXE_fingertip"));
    Command::new("sh").args(["-c", &run]).current_dir(folder.path("")).output().unwrap()
}

#[test]
#[cfg(target_os = "linux")]
fn memory_does_not_grow_with_the_recording() {
    let folder = Folder::new();
    // 65 MB.
    long(&folder, 1_000_000);
    assert!(std::fs::metadata(folder.path("long.csv")).unwrap().len() > 60_000_000);
    let output = in_small_memory(&folder, "analyze long.csv --scene scene.toml --output /dev/null");
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    // No bar where the standard error is no terminal.
    assert_eq!(error, "");
    let summary = String::from_utf8(output.stdout).unwrap();
    assert!(summary.contains("1\u{202f}000\u{202f}000 contacts"), "{summary}");
    let report = folder.read("report.html");
    assert!(report.len() < 400_000, "{} bytes", report.len());
}

#[test]
#[cfg(target_os = "linux")]
fn memory_does_not_grow_with_an_mcap_file_either() {
    let folder = Folder::new();
    long(&folder, 400_000);
    for arguments in ["convert long.csv long.mcap", "convert long.mcap back.csv"] {
        let output = in_small_memory(&folder, arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success() && said.contains("400\u{202f}000 wrenches"), "{said}{error}");
    }
    assert!(std::fs::metadata(folder.path("long.mcap")).unwrap().len() > 50_000_000);
}

#[test]
fn a_reader_that_has_seen_enough_is_no_fault() {
    let folder = Folder::new();
    long(&folder, 20_000);
    for arguments in [
        &["analyze", "long.csv", "--scene", "scene.toml"][..],
        &["analyze", "long.csv", "--scene", "scene.toml", "--output", "-", "--no-report"],
        &["demo"],
    ] {
        let mut child =
            folder.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !error.contains("panicked"), "{arguments:?}: {error}");
    }
}
