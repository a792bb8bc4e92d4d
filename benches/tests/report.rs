//! The report runs, and writes what it says it writes.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::path::Path;
use std::process::Command;

/// How many cells each line of a table has; a cell in quotes may hold commas.
fn cells(line: &str) -> usize {
    let mut quoted = false;
    let commas = line.chars().filter(|letter| {
        quoted ^= *letter == '"';
        *letter == ',' && !quoted
    });
    1 + commas.count()
}

#[test]
fn the_quick_report_writes_its_files() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report");
    // What an earlier run has written is no evidence.
    if folder.exists() {
        std::fs::remove_dir_all(&folder).unwrap();
    }
    let ran = Command::new(env!("CARGO_BIN_EXE_report"))
        .arg("--quick")
        .arg("--out")
        .arg(&folder)
        .arg("--book")
        .arg(folder.join("book"))
        .status();
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
        "The cost of a scene",
    ] {
        assert!(text.contains(title) && page.contains(title), "{title} is missing");
    }
    // Every diagram of the page is a file too.
    let diagrams: Vec<_> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".svg"))
        .collect();
    assert!(diagrams.len() >= 20, "{diagrams:?}");
    assert_eq!(page.matches("<svg").count(), diagrams.len(), "{diagrams:?}");
    // The pages of the book, to each of which the first one leads, have all diagrams among them.
    let first = read("book/README.md");
    let mut drawn = 0;
    for name in ["solvers", "contact", "integrators", "detectors", "calibration", "stability", "scenes"] {
        assert!(first.contains(&format!("]({name}.md)")), "{first}");
        let page = read(&format!("book/{name}.md"));
        drawn += page.matches("<svg").count();
        let mut drawing = page.lines().filter(|line| line.starts_with('<'));
        assert!(!drawing.any(|line| line.contains("NaN") || line.contains("inf")), "{name}: a point is none");
    }
    assert_eq!(drawn, diagrams.len());
    for name in &diagrams {
        assert!(page.contains(&read(name)), "{name} is not on the page");
    }
    // Every table of data has rows of equal length, and no figure of it is none.
    for name in ["solvers", "contact", "integrators", "detectors", "calibration"] {
        let data = read(&format!("{name}.csv"));
        let mut lines = data.lines();
        let columns = cells(lines.next().unwrap());
        assert!(lines.clone().count() >= 4 && columns > 4, "{name}");
        for line in lines {
            assert_eq!(cells(line), columns, "{name}: {line}");
        }
        assert!(!data.contains("NaN"), "{name}: a figure is not a number");
        let infinite = |cell: &str| matches!(cell.trim(), "inf" | "-inf");
        assert!(!data.split([',', '\n']).any(infinite), "{name}: a figure is infinite");
    }
    for refused in [&["--fast"][..], &["--only", "contacts"], &["--only", "contact", "--book", "book"]] {
        let unknown = Command::new(env!("CARGO_BIN_EXE_report")).args(refused).output().unwrap();
        assert!(!unknown.status.success(), "{refused:?}");
    }
}
