//! `fingertip design`: files that load, numbers that stay, errors that help.

use fingertip_calibration::design::{LayoutFile, LoadedTube, NominalLoads};
use fingertip_calibration::file::CalibrationFile;

use crate::common::Folder;

#[test]
fn writes_a_layout_that_loads() {
    let folder = Folder::new();
    let text = folder.succeed(&["design", "--starts", "6", "--calibration", "cal.toml"]);
    assert!(text.contains("Condition number 1.41"), "{text}");
    let file = LayoutFile::from_toml(&folder.read("layout.toml")).unwrap();
    assert_eq!(file.find_decoupling().unwrap().map(|found| found.couplings()), Some(0));
    let tube: LoadedTube = file.loaded_tube();
    assert!((tube.radius - 10e-3).abs() < 1e-9);
    // As thin as the safety allows, and no thinner.
    let wall = file.layout().beam.thickness;
    let safety = tube.strength(wall).unwrap().safety();
    assert!(
        (safety / 3.0 - 1.0).abs() < 1e-6 && text.contains("bears 3 times the nominal loads"),
        "{safety}"
    );
    // Three times the loads, and it just fails.
    let loads =
        NominalLoads { force: tube.loads.force.map(|f| 3.0 * f), torque: tube.loads.torque.map(|m| 3.0 * m) };
    let ratio = LoadedTube { loads, ..tube }.strength(wall).unwrap().worst_ratio();
    assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
    assert!(text.contains("then it yields") || text.contains("then its wall buckles"), "{text}");
    assert!(text.contains("R is at its greatest, 10 mm: --radius-mm moves it"), "{text}");
    assert!(!text.contains("starts found no sensor"), "{text}");
    let calibration = CalibrationFile::from_toml(&folder.read("cal.toml")).unwrap();
    let matrix = calibration.sensor_matrix::<6>().unwrap();
    assert_eq!(matrix, file.sensor_matrix::<6>().unwrap());
    let page = folder.read("design.html");
    assert!(page.starts_with("<!doctype html>") && page.matches("<svg ").count() >= 4);
    assert!(!page.contains("NaN") && !page.contains("inf "), "a number is missing");
    assert!(
        !page.contains("http://")
            || page.matches("http://").count() == page.matches("http://www.w3.org").count()
    );
}

/// The paper's gauges turned the other way are another sensor, and here the better one.
#[test]
fn both_signs_of_the_papers_angle_are_tried() {
    let folder = Folder::new();
    let text = folder.succeed(&["design", "--layout", "paper", "--torque", "0.1", "--starts", "8"]);
    assert!(text.contains("Condition number 5.06"), "{text}");
    assert!(text.contains("-15.15"), "{text}");
}

/// The paper's second ring wants to be far behind the first.
#[test]
fn a_tube_that_is_too_short_is_said_to_be() {
    let folder = Folder::new();
    let bound = "d is at its greatest, 9.6 mm: gauges stay within 0.8 of the clamped length";
    let paper = ["design", "--layout", "paper", "--starts", "2"];
    let said = folder.succeed(&[&paper[..], &["--length-mm", "12"]].concat());
    assert!(said.contains(bound) && said.contains("--length-mm moves it"), "{said}");
    assert!(!folder.succeed(&[&paper[..], &["--length-mm", "40"]].concat()).contains("d is at its"));
}

/// Only the widest of the tubes bear such loads with a wall that is thin: some starts do not meet one.
#[test]
fn starts_without_a_sensor_are_counted() {
    let folder = Folder::new();
    let text = folder.succeed(&["design", "--starts", "8", "--force", "1085", "--torque", "10.85"]);
    let (before, _) = text.split_once(" starts found no sensor that can be built").unwrap();
    let failed: u32 = before.rsplit(' ').next().unwrap().parse().unwrap();
    assert!((1..8).contains(&failed), "{text}");
    // The others share what was found.
    let (_, table) = text.split_once("Local minima").unwrap();
    let (table, _) = table.split_once("\n\n").unwrap();
    let shares =
        table.lines().filter_map(|line| line.split_once(" %")?.0.rsplit(' ').next()?.parse::<f64>().ok());
    let others = 100.0 * f64::from(8 - failed) / 8.0;
    assert!((shares.sum::<f64>() - others).abs() < 4.5, "{failed} of 8 starts failed: {table}");
}

#[test]
fn the_seed_decides() {
    let folder = Folder::new();
    let free = ["design", "--layout", "free", "--starts", "3"];
    let run = |seed: &str| {
        let said = folder.succeed(&[&free[..], &["--seed", seed]].concat());
        assert!(said.contains("No small combination of the signals separates the loads"), "{said}");
        folder.read("layout.toml")
    };
    assert_eq!(run("7"), run("7"));
    assert_ne!(run("7"), run("8"));
}

#[test]
fn every_family_and_criterion_works() {
    let folder = Folder::new();
    for criterion in ["condition-number", "contact-error", "worst-axis", "trace", "log-determinant"] {
        let text =
            folder.succeed(&["design", "--layout", "paper", "--starts", "1", "--criterion", criterion]);
        assert!(text.contains("three pairs at"), "{text}");
        assert!(!text.contains("NaN"), "{text}");
        // The innermost contour of the landscape is 2 % over its least value, which is that of the best design, in the
        // unit of the table, but for the grid.
        let (_, table) = text.split_once("Local minima").unwrap();
        let best = table.lines().find_map(|line| line.trim().strip_prefix("1  ")).unwrap();
        let best: f64 = best.split_whitespace().next().unwrap().parse().unwrap();
        let page = folder.read("design.html");
        let landscape = page.split("<figure>").nth(2).unwrap();
        let (_, key) = landscape.split_once("<i class=\"q0\"></i>").unwrap();
        let least: f64 = key.split('<').next().unwrap().parse().unwrap();
        assert!((1.0..1.1).contains(&(least / best)), "{criterion}: {least} {best}");
    }
    let text = folder.succeed(&["design", "--gauges", "8", "--starts", "2", "--wall-mm", "0.3"]);
    assert!(text.contains("wall of 0.300 mm"), "{text}");
}

#[test]
fn says_what_cannot_be() {
    let folder = Folder::new();
    let error = folder.fail(1, &["design", "--gauges", "7"]);
    assert!(error.contains("gauges: 7 given, 8 needed"), "{error}");
    let error = folder.fail(1, &["design", "--force", "0"]);
    assert!(error.contains("nominal force"), "{error}");
    let error = folder.fail(1, &["design", "--force", "1e7", "--torque", "1e5"]);
    assert!(error.contains("no start gave a sensor") || error.contains("no thin wall"), "{error}");
    let error = folder.fail(1, &["design", "--radius-mm", "9", "4"]);
    assert!(error.contains("range of parameter R"), "{error}");
    let error = folder.fail(2, &["design", "--material", "cheese"]);
    assert!(error.contains("aluminium-7075-t6"), "{error}");
    let error = folder.fail(1, &["design", "--starts", "2", "--out", "no/such/folder.toml"]);
    assert!(error.contains("cannot write layout"), "{error}");
}
