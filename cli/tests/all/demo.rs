//! `fingertip demo`, and its volts through `fingertip analyze`.

use std::fs;

use fingertip_simulation::{Options, SimulatedFingertip, standard_session};

use crate::common::{Contacts, Folder, scene};

/// The drawing of a report that has this title.
fn drawing<'a>(report: &'a str, title: &str) -> &'a str {
    let (_, rest) = report.split_once(&format!("<title>{title}</title>")).unwrap();
    rest.split_once("</figure>").unwrap().0
}

#[test]
fn the_demo_needs_nothing_and_finds_what_happened() {
    let folder = Folder::new();
    for seed in ["1", "2", "3"] {
        let text = folder.succeed(&["demo", "--seed", seed]);
        assert!(
            text.contains("All 8 slips were found within 20 ms, with no false alarm."),
            "seed {seed}:\n{text}"
        );
        let row = |load: &str| -> Vec<f64> {
            let line = text.lines().find(|line| line.trim_start().starts_with(load)).unwrap();
            line.split_whitespace().map(|cell| cell.parse().unwrap()).collect()
        };
        // Force error [%] and position error [mm]: the paper has about 2 %, 0.2 mm at 1 N, less than
        // 0.1 mm at 10 N, and less than 1 mm over its range.
        for (load, force_error, position_error) in
            [("0.100 ", 15.0, 1.0), ("1.00 ", 4.0, 0.3), ("10.0 ", 3.0, 0.1), ("30.0 ", 3.0, 0.1)]
        {
            let row = row(load);
            assert!(row[1] < force_error && row[2] < position_error, "seed {seed}: {row:?}");
        }
    }
    let report = folder.read("report.html");
    assert!(report.contains("Position error against load") && report.contains("prefers-color-scheme: dark"));
    assert!(!report.contains("NaN"));
    // Every kind of dot that the legend names is there: samples by the hundred, and the nine loads of the table.
    let dots = |class: &str| {
        let (_, path) = drawing(&report, "Position error against load").split_once(class).unwrap();
        path.split_once('"').unwrap().0.matches("h0").count()
    };
    assert!(dots("\"dots a faint\" d=\"") > 100 && dots("\"dots b large\" d=\"") == 9);
}

#[test]
fn the_same_seed_gives_the_same_report() {
    let folder = Folder::new();
    let report = |seed: &str, name: &str| {
        folder.succeed(&["demo", "--seed", seed, "--out", name]);
        folder.read(name)
    };
    assert_eq!(report("7", "a.html"), report("7", "b.html"));
    assert_ne!(report("8", "c.html"), folder.read("a.html"));
}

#[test]
fn its_volts_analyzed_give_the_true_contacts() {
    let folder = Folder::new();
    folder.succeed(&["demo", "--recording", "volts.csv", "--calibration", "calibration.toml"]);
    let paper = scene("paper_sphere.toml");
    let analyze = ["analyze", "volts.csv", "--scene", &paper, "--calibration", "calibration.toml"];
    let summary = folder.succeed(&analyze);
    assert!(summary.contains("8 slips were seen"), "{summary}");
    let report = folder.read("report.html");
    for (part, said) in [
        ("calibration", "calibration.toml"),
        ("calibrated by", "simulated"),
        ("calibrated with", "fingertip demo"),
        ("calibration quality", "unchecked"),
    ] {
        let row = format!("<th scope=\"row\">{part}</th><td class=\"word\">{said}</td>");
        assert!(report.contains(&row), "{row}");
    }
    assert!(!report.contains("calibrated sensor") && !report.contains("calibrated on"));

    // A scene that names the calibration itself says the same.
    let alone =
        format!("{}\n[sensor]\ncalibration = \"calibration.toml\"\n", fs::read_to_string(&paper).unwrap());
    folder.write("alone.toml", &alone);
    let by_option = folder.read("contacts.csv");
    folder.succeed(&["analyze", "volts.csv", "--scene", "alone.toml"]);
    assert_eq!(folder.read("contacts.csv"), by_option);
    // Filtered, it is late and quieter, and the summary says so.
    folder.write("filtered.toml", &format!("{alone}[filter]\nkind = \"low_pass\"\ncutoff_Hz = 40.0\n"));
    let filtered = ["analyze", "volts.csv", "--scene", "filtered.toml", "--output", "filtered.csv"];
    let said = folder.succeed(&filtered);
    assert!(said.contains("the filter makes what changes slowly come 5.6 ms late"), "{said}");
    assert_ne!(folder.read("filtered.csv"), by_option);

    // A threshold of five deviations of the rest, in which a force component has some 5 to 20 mN of noise.
    let measured = alone.replace("least_force_N = 0.1", "least_force_deviations = 5.0");
    assert_ne!(measured, alone);
    folder.write("measured.toml", &measured);
    let said =
        folder.succeed(&["analyze", "volts.csv", "--scene", "measured.toml", "--output", "measured.csv"]);
    assert!(said.contains("the noisiest components of the rest have deviations of 0.0"), "{said}");
    let forces = |name: &str| {
        let contacts = Contacts::parse(&folder.read(name));
        let (status, normal) = (contacts.words("status"), contacts.numbers("normal_N"));
        let least =
            status.iter().zip(normal).filter(|(status, _)| **status == "contact").map(|(_, force)| force);
        least.fold(f64::INFINITY, f64::min)
    };
    assert_ne!(forces("measured.csv"), forces("contacts.csv"));

    let contacts = Contacts::parse(&by_option);
    let truth: Vec<_> = SimulatedFingertip::new(&standard_session(), Options::default()).unwrap().collect();
    assert_eq!(contacts.len(), truth.len());
    let status = contacts.words("status");
    let [normal, x, y, z] = ["normal_N", "x_m", "y_m", "z_m"].map(|name| contacts.numbers(name));
    let mut compared = 0;
    for (row, sample) in truth.iter().enumerate() {
        if sample.truth.phase == 0 {
            assert_eq!(status[row], "rest");
            continue;
        }
        // Where the load is well above the noise, every sample is a contact near the true point.
        let Some(contact) = sample.truth.contact.filter(|contact| contact.force.norm() > 2.0) else {
            continue;
        };
        assert_eq!(status[row], "contact", "row {row}");
        let error =
            (contact.point.x - x[row]).hypot(contact.point.y - y[row]).hypot(contact.point.z - z[row]);
        assert!(error < 1e-3, "row {row}: {error}");
        assert!((normal[row] / contact.contact_force().normal - 1.0).abs() < 0.1, "row {row}");
        compared += 1;
    }
    assert!(compared > 5000, "{compared}");

    // A gauge at the end of its range is no reading.
    let volts = folder.read("volts.csv");
    let line = volts.lines().nth(5000).unwrap();
    let mut cells: Vec<&str> = line.split(',').collect();
    cells[3] = "0.0";
    folder.write("volts.csv", &volts.replacen(line, &cells.join(","), 1));
    folder.succeed(&analyze);
    let status = folder.read("contacts.csv").lines().nth(5000).unwrap().split(',').nth(1).map(str::to_owned);
    assert_eq!(status.as_deref(), Some("saturated"));

    // Nor does it enter the tare.
    let line = volts.lines().nth(500).unwrap();
    let mut cells: Vec<&str> = line.split(',').collect();
    cells[3] = "0.0";
    folder.write("volts.csv", &volts.replacen(line, &cells.join(","), 1));
    let output = folder.run(&analyze);
    assert!(output.status.success() && output.stderr.is_empty());
    let status = folder.read("contacts.csv").lines().nth(500).unwrap().split(',').nth(1).map(str::to_owned);
    assert_eq!(status.as_deref(), Some("saturated"));

    // A damaged calibration is refused.
    let calibration = folder.read("calibration.toml");
    folder.write("calibration.toml", &calibration.replacen("30.0", "31.0", 1));
    let error = folder.fail(1, &analyze);
    assert!(error.contains("calibration.toml") && error.contains("checksum"), "{error}");
}

#[test]
fn a_simulated_hand_weighs_what_it_holds_and_keeps_it() {
    let folder = Folder::new();
    let text = folder.succeed(&["demo", "--hand"]);
    // "201 ± 2.41 g for 200 g": within three per cent, and three of the deviations that are stated.
    let line = text.lines().find(|line| line.starts_with("It weighed")).unwrap();
    let masses: Vec<Vec<f64>> = line
        .trim_start_matches("It weighed ")
        .split(", ")
        .map(|mass| mass.split_whitespace().filter_map(|word| word.parse().ok()).collect())
        .collect();
    assert_eq!(masses.iter().map(|mass| mass[2]).collect::<Vec<_>>(), [200.0, 300.0, 300.0, 300.0], "{line}");
    for mass in &masses {
        let error = (mass[0] - mass[2]).abs();
        assert!(error < 0.03 * mass[2] && error < 3.0 * mass[1], "{line}");
    }
    // It was not lost: "in the hand the jar moved by 0.121 mm at most."
    let (_, moved) = text.split_once("the jar moved by ").unwrap();
    assert!(moved.split_once(" mm").unwrap().0.parse::<f64>().unwrap() < 1.0, "{moved}");
    let report = folder.read("report.html");
    for title in ["Normal forces", "Friction left", "What it weighs", "moves in the hand"] {
        assert!(report.contains(title), "{title}");
    }
    // The line below which a contact slips lies at zero, five sixths down from 100 % to −20 %; slips that are called are marked.
    let left = drawing(&report, "Friction left");
    assert!(left.contains("data-y=\"friction left / %;-20.0000;100.000\""));
    let (_, level) = left.split_once("<path class=\"level\" d=\"M44.0 ").unwrap();
    let height: f64 = level.split_once('L').unwrap().0.parse().unwrap();
    assert!((height - (24.0 + 175.0 * 5.0 / 6.0)).abs() < 0.1, "{height}");
    assert!(left.contains("<path class=\"mark\" "), "no call of a slip is marked");
    assert!(!report.contains("NaN"));
    folder.succeed(&["demo", "--hand", "--out", "again.html"]);
    assert_eq!(folder.read("again.html"), report);
    folder.succeed(&["demo", "--hand", "--seed", "2", "--out", "other.html"]);
    assert_ne!(folder.read("other.html"), report);
}
