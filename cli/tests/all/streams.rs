//! Long recordings and closed pipes.
#![cfg(unix)]

use std::fs::File;
use std::io::{BufWriter, Write};
use std::process::{Command, Stdio};

use crate::common::Folder;

const SCENE: &str = "version = 1\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"plane\"\n";

/// A recording of so many rows, each with so many signals beside its wrench; the last contact is the only one off
/// the centre. Cells are long, so that a long file has few rows.
fn long(folder: &Folder, rows: u32, signals: usize) {
    folder.write("scene.toml", SCENE);
    let mut file = BufWriter::new(File::create(folder.path("long.csv")).unwrap());
    let names: String = (1..=signals).map(|number| format!(",v{number}_V")).collect();
    writeln!(file, "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm{names}").unwrap();
    let (zero, signals) = ("0.000000000000000000", ",0.000000000000000001".repeat(signals));
    for row in 1..=rows {
        let torque = if row == rows { "0.500000" } else { zero };
        let (time, load) = (f64::from(row) * 0.001, 1.0 + f64::from(row % 1000) * 0.001);
        writeln!(file, "{time:.3},{zero},{zero},-{load:.18},{torque},{zero},{zero}{signals}").unwrap();
    }
    file.into_inner().unwrap();
}

/// What the program may have beside its code, which is not of the recording \[KiB\].
#[cfg(target_os = "linux")]
const MEMORY: u64 = 8_000;

#[cfg(target_os = "linux")]
fn in_small_memory(folder: &Folder, arguments: &str) -> std::process::Output {
    let run = format!("ulimit -d {MEMORY} && exec {} {arguments}", env!("CARGO_BIN_EXE_fingertip"));
    Command::new("sh").args(["-c", &run]).current_dir(folder.path("")).output().unwrap()
}

#[test]
#[cfg(target_os = "linux")]
fn memory_does_not_grow_with_the_recording() {
    let folder = Folder::new();
    long(&folder, 280_000, 0);
    assert!(std::fs::metadata(folder.path("long.csv")).unwrap().len() > 1024 * MEMORY);
    let output = in_small_memory(&folder, "analyze long.csv --scene scene.toml --output /dev/null");
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    // No bar where the standard error is no terminal.
    assert_eq!(error, "");
    let summary = String::from_utf8(output.stdout).unwrap();
    assert!(summary.contains("280\u{202f}000 contacts"), "{summary}");
    let report = folder.read("report.html");
    assert!(report.len() < 400_000, "{} bytes", report.len());
}

#[test]
#[cfg(target_os = "linux")]
fn memory_does_not_grow_with_an_mcap_file_either() {
    let folder = Folder::new();
    long(&folder, 60_000, 56);
    for (arguments, expected) in [
        ("convert long.csv long.mcap", "wrenches"),
        ("convert long.mcap back.csv", "wrenches"),
        ("analyze long.mcap --scene scene.toml --output /dev/null --no-report", "contacts"),
    ] {
        let output = in_small_memory(&folder, arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        let said = String::from_utf8_lossy(&output.stdout);
        let all = format!("60\u{202f}000 {expected}");
        assert!(output.status.success() && said.contains(&all), "{arguments}: {said}{error}");
    }
    assert!(std::fs::metadata(folder.path("long.mcap")).unwrap().len() > 1024 * MEMORY);
}

#[test]
fn a_reader_that_has_seen_enough_is_no_fault() {
    let folder = Folder::new();
    long(&folder, 20_000, 0);
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

/// A recording that does not end can be analysed up to a time: nothing waits for what lies behind it.
#[test]
fn what_lies_behind_the_end_is_not_read() {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    let arguments =
        ["analyze", "-", "--scene", "scene.toml", "--end", "0.5", "--output", "/dev/null", "--no-report"];
    let mut command = folder.command(&arguments);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut rows = BufWriter::new(child.stdin.take().unwrap());
    writeln!(rows, "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm").unwrap();
    // Far more than are read ahead; it ends, so that a fault makes the test fail and not hang.
    let is_read = |row: u32| writeln!(rows, "{:.3},0,0,-1,0,0,0", f64::from(row) * 1e-3).is_ok();
    assert!(!(0..3_000_000).all(is_read), "all was read");
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && said.contains(" contacts"), "{said}");
}
