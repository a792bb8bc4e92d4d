//! `health`, and what other commands see of it beside their work.

use core::fmt::Write as _;

use fingertip_test_support::recording;

use crate::common::Folder;

/// Twelve uniform numbers are nearly a normal one.
pub(crate) fn normal(state: &mut u64) -> f64 {
    let mut sum = -6.0;
    for _ in 0..12 {
        // Knuth's generator.
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        sum += (*state >> 11) as f64 / (1_u64 << 53) as f64;
    }
    sum
}

/// Six gauges at 1 kHz with a noise of 1 mV in steps of 0.1 mV, which `change` may change.
pub(crate) fn gauges(samples: u32, change: impl Fn(f64, &mut [f64; 6])) -> String {
    let mut text = String::from("t_s,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n");
    let mut state = 7;
    for i in 0..samples {
        let time = f64::from(i) * 1e-3;
        let mut readings = [0.0; 6].map(|_: f64| 0.5 + (10.0 * normal(&mut state)).round() * 1e-4);
        change(time, &mut readings);
        let cells = readings.map(|reading| format!("{reading:.4}")).join(",");
        writeln!(text, "{time:.3},{cells}").unwrap();
    }
    text
}

#[test]
fn a_sound_sensor_is_called_sound_and_has_a_page() {
    let folder = Folder::new();
    folder.write("rest.csv", &gauges(5000, |_, _| {}));
    let said = folder.succeed(&["health", "rest.csv", "--html", "page.html", "--json", "all.json"]);
    assert!(said.contains("Verdict: sound"), "{said}");
    assert!(said.contains("5\u{202f}000 samples at 1000 a second, evenly"), "{said}");
    let page = folder.read("page.html");
    for part in [
        "Health of the sensor in rest.csv",
        "Allan deviation, gauges",
        "Spectrum, gauges",
        "Course, gauges",
        "<svg",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let json: serde_json::Value = serde_json::from_str(&folder.read("all.json")).unwrap();
    let noise = json["channels"][3]["noise"]["deviation"].as_f64().unwrap();
    assert!((noise / 1e-3 - 1.0).abs() < 0.05, "{noise}");
    assert!((json["channels"][3]["step"].as_f64().unwrap() / 1e-4 - 1.0).abs() < 1e-3);
    assert_eq!(json["channels"][0]["name"], "v1_V");
    assert!(folder.fail(1, &["health", "rest.csv", "--json", "all.json"]).contains("--overwrite"));
}

#[test]
fn what_is_wrong_is_named_as_the_file_names_it_and_the_code_is_one() {
    let folder = Folder::new();
    folder.write(
        "bad.csv",
        &gauges(5000, |time, readings| {
            readings[2] = 0.25;
            if time > 3.0 {
                readings[0] = 0.5007;
            }
            readings[4] += 3e-3 * (core::f64::consts::TAU * 50.0 * time).sin();
        }),
    );
    let output = folder.run(&["health", "bad.csv"]);
    let (said, error) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(1));
    assert!(error.contains("bad.csv gives wrong readings: v1_V is stuck: "), "{error}");
    assert!(said.contains("v3_V is dead") && said.contains("Readings at fault"), "{said}");
    assert!(said.contains("v5_V: ") && said.contains("at 50 Hz (mains, 50 Hz)"), "{said}");
    assert!(folder.fail(1, &["health", "bad.csv", "--rate", "0"]).contains("--rate"));
    folder.write("empty.csv", "t_s,v1_V\n");
    assert!(folder.fail(1, &["health", "empty.csv"]).contains("no rows"));
}

/// A calibration of 2 V for 10 N or 0.1 N·m.
pub(crate) fn calibration(folder: &Folder) {
    let mut loads = String::from("fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n");
    let mut state = 3;
    for i in 0..60_usize {
        let load: [f64; 6] =
            core::array::from_fn(|axis| if axis == i % 6 { f64::from(i as u8) / 3.0 - 10.0 } else { 0.0 });
        let volts = load.map(|load| 0.5 + 0.2 * load + 1e-5 * normal(&mut state));
        let cells = |scale: [f64; 6], values: [f64; 6]| {
            core::array::from_fn::<String, 6, _>(|k| format!("{:.6}", values[k] * scale[k])).join(",")
        };
        let scale = [1.0, 1.0, 1.0, 0.01, 0.01, 0.01];
        writeln!(loads, "{},{}", cells(scale, load), cells([1.0; 6], volts)).unwrap();
    }
    folder.write("loads.csv", &loads);
    folder.succeed(&["calibrate", "loads.csv", "-o", "tip.toml", "--accept-bad"]);
}

#[test]
fn with_a_calibration_it_speaks_of_the_wrench_too() {
    let folder = Folder::new();
    calibration(&folder);
    folder.write("rest.csv", &gauges(5000, |_, _| {}));
    let said = folder.succeed(&["health", "rest.csv", "--calibration", "tip.toml"]);
    assert!(
        said.contains("fz / N") && said.contains("tz / N·m") && said.contains("Verdict: sound"),
        "{said}"
    );
    let row = said.lines().find(|line| line.trim_start().starts_with("fz / N")).unwrap();
    // 1 mV of 0.2 V/N.
    let noise: f64 = row.split_whitespace().nth(3).unwrap().parse().unwrap();
    assert!((noise / 5e-3 - 1.0).abs() < 0.1, "{row}");
}

#[test]
fn other_commands_say_what_they_see() {
    let folder = Folder::new();
    calibration(&folder);
    folder.write(
        "scene.toml",
        "version = 2\n[input]\nconvention = \"on_fingertip\"\nrest_s = 1.0\n[surface]\nshape = \"sphere\"\nradius_m = 0.5\n",
    );
    folder.write("dead.csv", &gauges(4000, |_, readings| readings[1] = 0.125));
    let analyze =
        ["analyze", "dead.csv", "--scene", "scene.toml", "--calibration", "tip.toml", "--no-report"];
    let said = folder.succeed(&analyze);
    assert!(said.contains("v2_V is dead: it reads 0.125 V all the time"), "{said}");
    let said = folder.succeed(&["tare", "tip.toml", "dead.csv", "-o", "new.toml"]);
    assert!(said.contains("gauge 2 is dead"), "{said}");
    let loads = folder.read("loads.csv");
    let dead: Vec<String> = loads
        .lines()
        .enumerate()
        .map(|(i, line)| if i == 0 { format!("{line},v7_V") } else { format!("{line},0.75") })
        .collect();
    folder.write("seven.csv", &dead.join("\n"));
    let output = folder.run(&["calibrate", "seven.csv", "-o", "seven.toml"]);
    let all = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(all.contains("gauge 7 is dead"), "{all}");
}

#[test]
fn rows_without_a_time_are_left_out_and_recordings_without_times_are_told() {
    let folder = Folder::new();
    let timed = gauges(3000, |_, _| {});
    folder.write("gap.csv", &timed.replacen("\n1.500,", "\n,", 1));
    let said = folder.succeed(&["health", "gap.csv"]);
    assert!(said.contains("2\u{202f}999 samples at 1000 a second"), "{said}");
    let untimed: Vec<&str> = timed.lines().filter_map(|line| Some(line.split_once(',')?.1)).collect();
    folder.write("untimed.csv", &untimed.join("\n"));
    let none = "the recording has no column of time";
    let said = folder.succeed(&["health", "untimed.csv"]);
    assert!(said.contains("3\u{202f}000 samples") && said.contains(none), "{said}");
    let said = folder.succeed(&["health", "untimed.csv", "--rate", "500"]);
    assert!(said.contains("at 500 a second") && !said.contains(none), "{said}");
    assert!(!folder.succeed(&["health", "gap.csv"]).contains(none));
}

#[test]
fn a_tare_of_what_moves_is_refused() {
    let folder = Folder::new();
    calibration(&folder);
    // ±20 N.
    folder.write("swing.csv", &gauges(4000, |time, readings| readings[2] += 4.0 * (9.0 * time).sin()));
    let error = folder.fail(1, &["tare", "tip.toml", "swing.csv", "-o", "new.toml"]);
    assert!(error.contains("this is no rest: Fz ranged over") && error.contains("gauge 3"), "{error}");
    let said = folder.succeed(&["tare", "tip.toml", "swing.csv", "-o", "new.toml", "--accept-motion"]);
    assert!(said.contains("so far the zero may be off: Fz by"), "{said}");
}

/// What the recordings of others are said to show.
#[test]
fn recordings_of_others_are_judged() {
    let folder = Folder::new();
    let Some(path) = recording("ati_delta_raw_1khz/quiet_drives_off.csv") else { return };
    let said = folder.succeed(&["health", path.to_str().unwrap()]);
    // 2.2 mV beside 0.4.
    assert!(said.contains("gromit_v4 is noisier than the others: 0.00223 beside 3.75e-4"), "{said}");
    assert_eq!(said.lines().filter(|line| line.contains("noisier")).count(), 1, "{said}");
    let row = said.lines().find(|line| line.trim_start().starts_with("wallace_v0")).unwrap();
    // Published: 0.436 mV, and a step of 0.3218 mV.
    let numbers: Vec<f64> = row.split_whitespace().skip(1).map(|cell| cell.parse().unwrap()).collect();
    assert!(
        (numbers[0] / 0.436e-3 - 1.0).abs() < 0.05 && (numbers[4] / 0.3218e-3 - 1.0).abs() < 5e-3,
        "{row}"
    );
    let Some(path) = recording("nano17_three_finger/roll.csv") else { return };
    let said = folder.succeed(&["health", path.to_str().unwrap(), "--rate", "53"]);
    assert!(said.contains("Verdict: sound"), "{said}");
}

#[test]
fn a_plain_matrix_becomes_a_calibration_by_what_is_said_of_it() {
    let folder = Folder::new();
    let row = |i: usize| (0..6).map(|j| if i == j { "5.0" } else { "0.0" }).collect::<Vec<_>>().join(",");
    folder.write("plain.csv", &(0..6).map(row).collect::<Vec<_>>().join("\n"));
    let units = ["--matrix", "load-per-signal", "--signal", "V", "--force", "N", "--torque", "Nmm"];
    let with = |more: &[&'static str]| -> Vec<&str> {
        [&["import", "plain.csv", "-o", "plain.toml", "--overwrite"][..], &units, more].concat()
    };
    let said = folder.succeed(&with(&["--full-scale", "10,0.1"]));
    assert!(said.contains("6 gauges for 6 components") && said.contains("tare before use"), "{said}");
    assert!(folder.fail(1, &with(&[])).contains("give --full-scale"));
    let error = folder.fail(1, &["import", "plain.csv", "-o", "x.toml", "--full-scale", "10,0.1"]);
    assert!(error.contains("give --matrix"), "{error}");
    folder.write("rest.csv", &gauges(2000, |_, _| {}));
    let said = folder.succeed(&["health", "rest.csv", "--calibration", "plain.toml"]);
    // 1 mV of 5 N/V and 5 N·mm/V.
    for (axis, noise) in [("fz / N", 5e-3), ("tz / N·m", 5e-6)] {
        let row = said.lines().find(|line| line.trim_start().starts_with(axis)).unwrap();
        let found: f64 = row.split_whitespace().nth(3).unwrap().parse().unwrap();
        assert!((found / noise - 1.0).abs() < 0.1, "{row}");
    }
    // Where a calibration is taken, a matrix that says nothing of itself is sent here.
    let error = folder.fail(1, &["health", "rest.csv", "--calibration", "plain.csv"]);
    assert!(error.contains("fingertip import"), "{error}");
    // By hand, without a checksum: taken, with a plain warning.
    let rows = (0..6).map(|i| format!("[{}]", row(i))).collect::<Vec<_>>().join(", ");
    let by_hand = format!(
        "version = 1\naxes = [\"fx\", \"fy\", \"fz\", \"tx\", \"ty\", \"tz\"]\nsignal_unit = \"V\"\n\
         nominal = [10.0, 10.0, 10.0, 0.1, 0.1, 0.1]\nzero = [0.5, 0.5, 0.5, 0.5, 0.5, 0.5]\nmatrix = [{rows}]\n"
    );
    folder.write("hand.toml", &by_hand);
    let said = folder.succeed(&["health", "rest.csv", "--calibration", "hand.toml"]);
    assert!(said.contains("no checksum: it was written by hand"), "{said}");
}

#[test]
fn tables_that_do_not_determine_all_say_so() {
    let folder = Folder::new();
    let mut state = 5;
    let mut six = String::from("fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,v1_V,v2_V\n");
    for _ in 0..40 {
        let [x, y] = [normal(&mut state), normal(&mut state)];
        writeln!(six, "{x},{y},0,0,0,0,{},{}", 0.3 + x + 0.1 * y + 1e-4 * normal(&mut state), 0.2 * x - y)
            .unwrap();
    }
    folder.write("two.csv", &six);
    let said = folder.succeed(&["calibrate", "two.csv", "-o", "two.toml"]);
    assert!(said.contains("Fz, Tx, Ty, Tz: no load has any"), "{said}");
    assert!(folder.read("two.toml").contains("axes = [\"fx\", \"fy\"]"));
    calibration(&folder);
    let loads = folder.read("loads.csv");
    let dead: Vec<String> = loads
        .lines()
        .enumerate()
        .map(
            |(i, line)| {
                if i == 0 { line.to_owned() } else { format!("{},0.25", line.rsplit_once(',').unwrap().0) }
            },
        )
        .collect();
    folder.write("dead.csv", &dead.join("\n"));
    let error = folder.fail(1, &["calibrate", "dead.csv", "-o", "dead.toml"]);
    assert!(
        error.contains("gauge 6 is dead: it always reads 0.25, and the 5 other gauges are too few for 6"),
        "{error}"
    );
}
