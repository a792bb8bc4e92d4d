//! The report runs, and writes what it says it writes.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::path::Path;
use std::process::Command;

#[test]
fn the_quick_report_writes_its_files() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report");
    let ran = Command::new(env!("CARGO_BIN_EXE_report")).arg("--quick").arg("--out").arg(&folder).status();
    assert!(ran.unwrap().success());
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let page = read("report.html");
    let text = read("report.md");
    for title in [
        "Signals to wrench",
        "Wrench to contact",
        "Dynamic friction",
        "Slip detectors",
        "Calibration",
        "Stability",
    ] {
        assert!(text.contains(title) && page.contains(title), "{title} is missing");
    }
    assert!(page.matches("<svg").count() >= 20, "{} diagrams", page.matches("<svg").count());
    // Every diagram is a file too, and every table of data has rows of equal length.
    for name in ["solvers", "contact", "integrators", "detectors", "calibration"] {
        let data = read(&format!("{name}.csv"));
        let columns = data.lines().next().unwrap().split(',').count();
        assert!(data.lines().count() > 4 && columns > 4, "{name}");
        assert!(!data.contains("NaN"), "{name}: a figure is not a number");
    }
    let unknown = Command::new(env!("CARGO_BIN_EXE_report")).arg("--fast").output().unwrap();
    assert!(!unknown.status.success());
}
