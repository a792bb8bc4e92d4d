//! `fingertip analyze` on recordings whose answer is known, and on bad ones.

use crate::common::{Contacts, Folder};

const SCENE: &str = "version = 1\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.01\n\
                     [contact]\nleast_force_N = 0.5\n[friction]\nstatic_coefficient = 0.5\n\
                     [slip]\ndetector = \"threshold\"\nnoise_N = 0.01\n";
const HEADER: &str = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n";

/// A push of 2 N on top of the sphere (z = 10 mm), with a tangential force along x.
fn push(time: f64, tangential: f64) -> String {
    format!("{time},{tangential},0,-2,0,{},0\n", 0.01 * tangential)
}

fn folder(rows: &str) -> Folder {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    folder.write("touch.csv", &format!("{HEADER}{rows}"));
    folder
}

const ANALYZE: [&str; 4] = ["analyze", "touch.csv", "--scene", "scene.toml"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&ANALYZE, more].concat()
}

/// What only a report shows is not kept without one; nothing else may miss it.
#[test]
fn without_a_report_the_rest_is_the_same() {
    let rows: String = (0..900)
        .map(|row| {
            if row % 7 == 3 {
                format!("{row}e-3,0,0,nan,0,0,0\n")
            } else {
                push(f64::from(row) * 1e-3, 0.001 * f64::from(row))
            }
        })
        .collect();
    let folder = folder(&rows);
    let with_report = folder.succeed(&with(&["--output", "a.csv", "--report", "a.html"]));
    let without = folder.succeed(&with(&["--output", "b.csv", "--no-report"]));
    assert_eq!(folder.read("a.csv"), folder.read("b.csv"));
    let before_files =
        |said: &str| said.split("a.csv").next().unwrap().split("b.csv").next().unwrap().to_owned();
    assert_eq!(before_files(&with_report), before_files(&without));
    assert!(with_report.lines().count() > 10 && folder.read("a.html").contains("<svg"));
}

/// Through a filter a load comes slowly; but of what was before samples that are missing it knows nothing.
#[test]
fn a_filter_begins_anew_behind_a_gap() {
    let filter = "[filter]\nkind = \"low_pass\"\ncutoff_Hz = 10.0\n[surface]";
    let scene = SCENE.replace("[surface]", filter);
    let scene = scene.replace("version = 1", "version = 2");
    let scene = scene.replace("\"on_fingertip\"\n", "\"on_fingertip\"\nsample_rate_Hz = 1000.0\n");
    let first_behind = |pause: f64| {
        let row = |k: u32| match k {
            0..50 => format!("{},0,0,-3,0,0,0\n", f64::from(k) * 1e-3),
            _ => format!("{},0,0,-1,0,0,0\n", f64::from(k) * 1e-3 + pause),
        };
        let folder = folder(&(0..60).map(row).collect::<String>());
        folder.write("scene.toml", &scene);
        folder.succeed(&with(&["--output", "a.csv", "--no-report"]));
        Contacts::parse(&folder.read("a.csv")).numbers("normal_N")[50]
    };
    assert!(first_behind(0.0) > 2.5);
    assert_eq!(first_behind(0.2), 1.0);
}

/// One scene serves recordings of volts and of wrenches, and says which part of it is idle.
#[test]
fn a_calibration_that_wrenches_do_not_need_is_said_to_be_idle() {
    let folder = folder(&push(0.0, 0.0));
    folder.write("loads.csv", &crate::calibrate::loads(1.0));
    folder.succeed(&["calibrate", "loads.csv", "-o", "cal.toml"]);
    let said = "[sensor] of the scene is not used: the recording holds wrenches";
    assert!(!folder.succeed(&ANALYZE).contains(said));
    folder.write("scene.toml", &format!("{SCENE}[sensor]\ncalibration = \"cal.toml\"\n"));
    let text = folder.succeed(&with(&["--overwrite"]));
    assert!(text.contains(said) && text.contains("1 contact"), "{text}");
}

#[test]
fn every_outcome_has_its_word_and_every_contact_its_numbers() {
    let rows = [
        push(0.0, 0.0),
        push(0.001, 0.6),
        push(0.002, 1.2),
        // Too weak, pulling beside the sphere, not a number.
        "0.003,0,0,-0.4,0,0,0\n".to_owned(),
        "0.004,0,0,-2,0.04,0,0\n".to_owned(),
        "0.005,0,0,nan,0,0,0\n".to_owned(),
    ];
    let folder = folder(&rows.concat());
    let summary = folder.succeed(&ANALYZE);
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    let expected = ["contact", "contact", "contact", "below_threshold", "misses", "unusable_row"];
    assert_eq!(contacts.words("status"), expected);
    assert_eq!(contacts.words("slip")[..3], ["holding", "holding", "slipping"]);
    for (name, expected) in [
        ("x_m", [0.0, 0.0, 0.0]),
        ("z_m", [0.01; 3]),
        ("nz", [1.0; 3]),
        ("normal_N", [2.0; 3]),
        ("tangential_N", [0.0, 0.6, 1.2]),
        ("ratio", [0.0, 0.3, 0.6]),
        // (μ f_n − |f_t|)/√(1 + μ²)
        ("margin_N", [1.0, 0.4, -0.2].map(|x| x / 1.25_f64.sqrt())),
        ("ty_Nm", [0.0, 0.006, 0.012]),
    ] {
        for (found, expected) in contacts.numbers(name).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-7, "{name}: {found} for {expected}");
        }
    }
    // The line of the fifth row passes at y = 20 mm, 10 mm beside the sphere.
    assert!((contacts.numbers("gap_m")[4] - 0.01).abs() < 1e-8);
    for expected in ["6 samples", "3 contacts", "One slip was seen", "misses the surface", "not finite"] {
        assert!(summary.contains(expected), "{expected:?} is not in:\n{summary}");
    }
    let report = folder.read("report.html");
    assert!(report.starts_with("<!doctype html>") && report.trim_end().ends_with("</html>"));
    assert_eq!(report.matches("<svg viewBox").count(), report.matches("<figure>").count());
    // Self-contained.
    for outside in ["src=", "href=", "url(", "@import", "<script ", "import(", "fetch(", "<link"] {
        assert!(!report.contains(outside), "{outside}");
    }
    assert!(!report.contains("NaN") && !report.contains("inf"), "a number that is none in the report");
}

#[test]
fn a_recording_without_a_contact_still_has_its_report() {
    for (shape, rows) in [
        ("sphere\"\nradius_m = 0.01", 1),
        ("cylinder\"\nradius_m = 0.01\nhalf_length_m = 0.02", 3),
        ("plane\"", 3),
    ] {
        let weak: String = (0..rows).map(|i| format!("{i},0,0,-0.1,0,0,0\n")).collect();
        let folder = folder(&weak);
        folder.write("scene.toml", &SCENE.replace("sphere\"\nradius_m = 0.01", shape));
        let summary = folder.succeed(&ANALYZE);
        assert!(summary.contains("0 contacts") && summary.contains("No slip was seen"), "{summary}");
        let report = folder.read("report.html");
        assert!(!report.contains("NaN") && !report.contains("inf"), "{shape}");
    }
}

#[test]
fn the_reaction_and_other_units_give_the_same_contacts() {
    let folder = folder(&push(0.0, 0.6));
    folder.succeed(&with(&["--no-report"]));
    let expected = folder.read("contacts.csv");
    folder.write("scene.toml", &SCENE.replace("on_fingertip", "reaction"));
    folder.write(
        "touch.csv",
        "time_ms;finger Fx [mN];finger Fy [mN];finger Fz [mN];finger Tx [Nmm];finger Ty [Nmm];finger Tz [Nmm]\n0;-600;0;2000;0;-6;0\n",
    );
    folder.succeed(&with(&["--no-report"]));
    let found = folder.read("contacts.csv");
    // Signs of zeros differ.
    assert_eq!(found.replace("-0.0,", "0.0,"), expected.replace("-0.0,", "0.0,"));
    assert!(!folder.path("report.html").exists());
}

#[test]
fn the_rest_is_taken_off_and_a_pose_moves_the_surface() {
    let mut rows = String::new();
    for i in 0..100 {
        rows.push_str(&format!("{},0.3,0.1,-0.2,0.01,0.02,0.03\n", f64::from(i) * 0.001));
    }
    // The same push as above, at a sphere 5 mm higher, on top of the bias.
    rows.push_str("0.1,0.9,0.1,-2.2,0.01,0.029,0.03\n");
    let folder = folder(&rows);
    let scene = SCENE.replace("[input]", "[pose]\ntranslation_m = [0.0, 0.0, 0.005]\n[input]\nrest_s = 0.1");
    folder.write("scene.toml", &scene);
    folder.succeed(&ANALYZE);
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    let status = contacts.words("status");
    assert!(status[..100].iter().all(|word| *word == "rest"));
    assert_eq!(status[100], "contact");
    for (name, expected) in [("x_m", 0.0), ("z_m", 0.015), ("normal_N", 2.0), ("tangential_N", 0.6)] {
        assert!((contacts.numbers(name)[100] - expected).abs() < 1e-7, "{name}");
    }
    folder.write("scene.toml", &scene.replace("rest_s = 0.1", "rest_s = 5"));
    let error = folder.fail(1, &ANALYZE);
    assert!(error.contains("5 s of rest") && error.contains("rest_s"), "{error}");
}

#[test]
fn contacts_can_go_to_the_standard_output() {
    let folder = folder(&push(0.0, 0.6));
    let output = folder.run(&with(&["--output", "-", "--no-report"]));
    assert!(output.status.success());
    assert_eq!(Contacts::parse(core::str::from_utf8(&output.stdout).unwrap()).len(), 1);
    assert!(String::from_utf8(output.stderr).unwrap().contains("1 contacts"));
}

#[test]
fn bad_recordings_are_refused_in_one_sentence() {
    let good = push(0.0, 0.0);
    let cases = [
        (String::new(), "is empty"),
        (HEADER.to_owned(), "no rows"),
        ("a,b\n1,2\n".to_owned(), "no column is a force"),
        (format!("{}\n{good}", HEADER.replace("fx_N", "fx").trim()), "no unit"),
        (format!("{HEADER}{good}0.001,x,0,0,0,0,0\n"), "line 3, column fx_N"),
        (format!("{HEADER}{good}0.001,0,0\n"), "line 3: 3 cells"),
        (format!("{}\n0,0,-2,0,0,0\n", "fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm"), "sample_rate_Hz"),
        ("t_s,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n0,1,2,3,4,5,6\n".to_owned(), "--calibration"),
    ];
    for (text, expected) in cases {
        let folder = folder("");
        folder.write("touch.csv", &text);
        let error = folder.fail(1, &ANALYZE);
        assert!(error.starts_with("error: ") && error.trim_end().lines().count() == 1, "{error}");
        assert!(error.contains(expected) && error.contains("touch.csv"), "{expected:?} is not in {error}");
    }
}

#[test]
fn bad_paths_and_scenes_are_refused_in_one_sentence() {
    let folder = folder(&push(0.0, 0.0));
    folder.write("typo.toml", &SCENE.replace("radius_m", "radius_mm"));
    folder.write("signless.toml", &SCENE.replace("convention = \"on_fingertip\"\n", ""));
    folder.write("not.toml", "version = = 1");
    folder.write("bad_calibration.toml", "version = 1\n");
    let cases: [(&[&str], &str); 10] = [
        (&["analyze", "none.csv", "--scene", "scene.toml"], "none.csv"),
        (&["analyze", "touch.csv", "--scene", "none.toml"], "none.toml"),
        (&["analyze", ".", "--scene", "scene.toml"], "recording"),
        (&["analyze", "touch.csv", "--scene", "typo.toml"], "unknown field `radius_mm`"),
        (&["analyze", "touch.csv", "--scene", "signless.toml"], "missing field `convention`"),
        (&["analyze", "touch.csv", "--scene", "not.toml"], "not.toml, line 1"),
        (&with(&["--output", "no/such/folder.csv"]), "no/such/folder.csv"),
        (&with(&["--report", "no/such/report.html"]), "no/such/report.html"),
        (&with(&["--output", "touch.csv"]), "would be overwritten"),
        (&with(&["--calibration", "bad_calibration.toml"]), "bad_calibration.toml"),
    ];
    let recording = folder.read("touch.csv");
    for (arguments, expected) in cases {
        let error = folder.fail(1, arguments);
        assert!(error.starts_with("error: ") && error.trim_end().lines().count() == 1, "{error}");
        assert!(error.contains(expected), "{expected:?} is not in {error}");
    }
    assert_eq!(folder.read("touch.csv"), recording, "the recording was touched");
}

#[test]
fn wrong_usage_is_told_apart() {
    let folder = Folder::new();
    for arguments in [
        &[][..],
        &["analyse"],
        &["analyze"],
        &["analyze", "touch.csv"],
        &["analyze", "touch.csv", "--scene", "scene.toml", "--speed", "9"],
        &["analyze", "touch.csv", "--scene", "s.toml", "--report", "r.html", "--no-report"],
        &["demo", "--seed", "many"],
    ] {
        let error = folder.fail(2, arguments);
        assert!(error.contains("--help"), "{error}");
    }
    assert!(folder.succeed(&["--help"]).contains("analyze"));
    assert!(folder.succeed(&["--version"]).contains(env!("CARGO_PKG_VERSION")));
}

#[test]
fn a_rest_that_was_none_is_warned_of_or_refused() {
    // Noise of 10 mN in steps of 2 mN; a finger that presses with up to `load` during the rest.
    let recording = |load: f64| {
        let mut rows = String::new();
        for i in 0..1000_u32 {
            let noise = (f64::from(i * 7919 % 1009) / 1009.0 - 0.5) * 0.03;
            let moving = if i < 600 { load * (f64::from(i) * 0.008).sin() } else { 2.0 };
            let force = ((noise - moving) / 0.002).round() * 0.002;
            rows.push_str(&format!("{},0,0,{force:.3},0,0,0\n", f64::from(i) * 0.001));
        }
        rows
    };
    let rest = SCENE.replace("[input]", "[input]\nrest_s = 0.5");
    let run = |load: f64, scene: &str| {
        let folder = folder(&recording(load));
        folder.write("scene.toml", scene);
        let output = folder.run(&ANALYZE);
        let text = |bytes| String::from_utf8(bytes).unwrap();
        let report = if output.status.success() { folder.read("report.html") } else { String::new() };
        (output.status.code(), text(output.stdout), text(output.stderr), report)
    };

    // A true rest is passed in silence.
    let (code, summary, errors, _) = run(0.0, &rest);
    assert_eq!((code, errors.as_str()), (Some(0), ""));
    assert!(!summary.contains("at rest"), "{summary}");

    // A hand that moves is seen, named and told how to be mended, everywhere.
    let (code, summary, errors, report) = run(3.0, &rest);
    assert_eq!(code, Some(0));
    assert!(errors.starts_with("warning: ") && errors.trim_end().lines().count() == 1, "{errors}");
    for text in [&summary, &errors, &report] {
        for expected in ["may not have been at rest", "fz", "rest_s", "tare may be off"] {
            assert!(text.contains(expected), "{expected:?} is not in {text}");
        }
    }

    // What ranges over more than a hundred thresholds is refused.
    let (code, _, error, _) = run(60.0, &rest);
    assert_eq!(code, Some(1));
    assert!(error.starts_with("error: ") && error.trim_end().lines().count() == 1, "{error}");
    assert!(error.contains("not at rest") && error.contains("rest_s = 0"), "{error}");

    // Where every force counts there is no threshold that it could be a multiple of.
    let (code, _, errors, _) = run(60.0, &rest.replace("least_force_N = 0.5", "least_force_N = 0.0"));
    assert!(code == Some(0) && errors.contains("may not have been at rest"), "{code:?} {errors}");

    // Without the tare the same recording is taken as it is.
    let (code, summary, errors, _) = run(60.0, &SCENE.replace("[input]", "[input]\nrest_s = 0"));
    assert_eq!((code, errors.as_str()), (Some(0), ""));
    assert!(summary.contains("no tare"), "{summary}");
}

#[test]
fn mcap_is_read_as_csv_is() {
    let rows: String = (0..200).map(|i| push(f64::from(i) * 0.001, f64::from(i) * 0.007)).collect();
    let folder = folder(&rows);
    folder.succeed(&with(&["--output", "of_csv.csv", "--no-report"]));
    folder.succeed(&["convert", "touch.csv", "touch.mcap"]);
    let said = folder.succeed(&[
        "analyze",
        "touch.mcap",
        "--scene",
        "scene.toml",
        "--output",
        "of_mcap.csv",
        "--no-report",
    ]);
    assert!(said.contains("touch.mcap"), "{said}");
    assert_eq!(folder.read("of_csv.csv"), folder.read("of_mcap.csv"));
    folder.write("broken.mcap", "no such thing");
    let error = folder.fail(1, &["analyze", "broken.mcap", "--scene", "scene.toml"]);
    assert!(error.contains("broken.mcap"), "{error}");
}

/// Columns by their numbers: the same contacts as of a recording that names them, its first row included.
#[test]
fn a_recording_without_a_header_is_read_by_the_numbers_of_its_columns() {
    let rows: String = (0..20).map(|i| push(f64::from(i) * 0.01, 0.05 * f64::from(i))).collect();
    let folder = folder(&rows);
    folder.succeed(&with(&["--no-report"]));
    let named = folder.read("contacts.csv");
    // The same with a column before, the torques first, in millimetres, and fz turned round.
    let moved = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        format!(
            "9,{},{},{},{},{},{},{}\n",
            cells[4] * 1e3,
            cells[5] * 1e3,
            cells[6] * 1e3,
            cells[1],
            cells[2],
            -cells[3],
            cells[0]
        )
    };
    folder.write("touch.csv", &rows.lines().map(moved).collect::<String>());
    let columns = "header = false\ncolumns = { time = 8, fx = 5, fy = 6, fz = -7, tx = 2, ty = \"3\", tz = 4 }\n\
                   units = { torque = \"Nmm\" }\n[surface]";
    folder.write("scene.toml", &SCENE.replace("[surface]", columns));
    folder.succeed(&with(&["--no-report", "--overwrite"]));
    let (named, numbered) = (Contacts::parse(&named), Contacts::parse(&folder.read("contacts.csv")));
    assert_eq!((named.len(), named.words("status")), (20, numbered.words("status")));
    for column in ["t_s", "x_m", "normal_N", "ratio", "fz_N"] {
        for (a, b) in named.numbers(column).iter().zip(numbered.numbers(column)) {
            assert!((a - b).abs() < 1e-7, "{column}: {a} and {b}");
        }
    }
    folder.write("scene.toml", &SCENE.replace("[surface]", &columns.replace("fx = 5", "fx = 9")));
    let error = folder.fail(1, &with(&["--no-report", "--overwrite"]));
    assert!(error.contains("no column 9") || error.contains("9"), "{error}");
}

/// Without a time column, the rate of the scene is the clock: of what is told, and of what takes time.
#[test]
fn a_rate_stands_for_a_time_column() {
    let timed: String = (0..60).map(|k| push(f64::from(k) * 0.01, 0.02 * f64::from(k))).collect();
    let folder = folder(&timed);
    let scene = SCENE.replace("version = 1\n[input]\n", "version = 2\n[input]\nsample_rate_Hz = 100.0\n");
    folder.write("scene.toml", &format!("{scene}[grip]\nsafety = 1.5\nleast_N = 0.2\ngreatest_N = 20.0\nrise_N_per_s = 2.0\nfall_N_per_s = 0.5\n"));
    folder.succeed(&ANALYZE);
    let by_column = Contacts::parse(&folder.read("contacts.csv"));
    let untimed: String =
        timed.lines().map(|line| line.split_once(',').unwrap().1.to_owned() + "\n").collect();
    folder.write("touch.csv", &format!("{}{untimed}", HEADER.replace("t_s,", "")));
    folder.succeed(&ANALYZE);
    let by_rate = Contacts::parse(&folder.read("contacts.csv"));
    assert_eq!(by_rate.words("slip"), by_column.words("slip"));
    let commands = by_rate.numbers("grip_N");
    assert!(commands[59] > commands[1] + 0.1, "the command rises with time: {commands:?}");
    for name in ["t_s", "grip_N"] {
        for (rate, column) in by_rate.numbers(name).iter().zip(by_column.numbers(name)) {
            assert!((rate - column).abs() < 1e-9, "{name}: {rate} for {column}");
        }
    }
}

/// A part of a recording gives the rows that the whole gives there; the rest at its start is taken before.
#[test]
fn a_part_of_a_recording_is_analysed() {
    let mut rows: String =
        (0..100).map(|k| format!("{},0.3,0.1,-0.2,0,0,0\n", 5.0 + f64::from(k) * 0.01)).collect();
    rows += &(100..300).map(|k| push(5.0 + f64::from(k) * 0.01, 0.002 * f64::from(k))).collect::<String>();
    let folder = folder(&rows);
    folder.write("scene.toml", &SCENE.replace("[input]\n", "[input]\nrest_s = 0.9\n"));
    folder.succeed(&ANALYZE);
    let whole = folder.read("contacts.csv");
    let said = folder.succeed(&with(&["--start", "1.5", "--end", "2.5"]));
    assert!(
        said.contains("Note: only what was recorded from 1.5 s to 2.5 s behind the first row."),
        "{said}"
    );
    let part = folder.read("contacts.csv");
    let time = |line: &str| line.split(',').next().unwrap().parse::<f64>().unwrap();
    let between = |line: &&str| (6.5 - 1e-12..=7.5 + 1e-12).contains(&time(line));
    let expected: Vec<&str> = whole.lines().skip(1).filter(between).collect();
    assert!(expected.len() == 101 && part.lines().skip(1).eq(expected.iter().copied()), "{part}");
    // What comes behind the end is not even read.
    folder.write("touch.csv", &format!("{HEADER}{rows}9,broken\n"));
    folder.succeed(&with(&["--end", "1.5", "--start", "1.2"]));
    for (options, says) in [
        (["--start=4", "--end=5"], "--start 4 must be before the end of the recording"),
        (["--start=0.1", "--end=0.5"], "--end 0.5 must be behind `rest_s` of the scene"),
        (["--start=2", "--end=1"], "--end 1 must not be before --start"),
        (["--start=0", "--end=nan"], "--end NaN must be a number of seconds behind the first row"),
        (["--start=-1", "--end=1"], "--start -1 must be a number of seconds behind the first row"),
    ] {
        folder.write("touch.csv", &format!("{HEADER}{rows}"));
        let output = folder.run(&with(&options));
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && error.contains(says), "{error}");
    }
    // Where nothing is left, it is said why.
    folder.write("scene.toml", SCENE);
    for (rows, options, says) in [
        ("", ["--start=1", "--end=2"], "touch.csv has a header but no rows"),
        (&rows, ["--start=0.003", "--end=0.007"], "--start 0.003 has no row between itself and --end"),
    ] {
        folder.write("touch.csv", &format!("{HEADER}{rows}"));
        let error = folder.fail(1, &with(&options));
        assert!(error.contains(says), "{error}");
    }
}

/// For programs: one line, with the numbers of the text.
#[test]
fn the_summary_comes_as_json() {
    let rows: String = (0..300).map(|k| push(f64::from(k) * 0.01, 0.005 * f64::from(k))).collect();
    let folder = folder(&format!("{rows}2.99,0,0,-2,0,0,0\n3.0,0,0,-0.1,0,0,0\n"));
    let line = folder.succeed(&with(&["--json", "--no-report"]));
    assert_eq!(line.lines().count(), 1);
    let told: serde_json::Value = serde_json::from_str(&line).unwrap();
    assert_eq!(told["recording"], "touch.csv");
    assert_eq!(told["samples"], 302);
    let contacts = Contacts::parse(&folder.read("contacts.csv"));
    let statuses = contacts.words("status");
    for (word, samples) in told["outcomes"].as_object().unwrap() {
        assert_eq!(
            samples.as_u64().unwrap() as usize,
            statuses.iter().filter(|status| *status == word).count()
        );
    }
    assert_eq!((&told["first_time_s"], &told["last_time_s"]), (&0.0.into(), &3.0.into()));
    let normal = &told["distributions"]["normal_N"];
    assert!((normal["median"].as_f64().unwrap() - 2.0).abs() < 0.05, "{normal}");
    assert_eq!(told["slips"]["count"], 1);
    assert!((told["slips"]["first"][0]["ratio"].as_f64().unwrap() - 0.5).abs() < 0.02, "{told}");
    assert_eq!(told["faults"]["times that do not advance"]["first_lines"][0], 302, "{told}");
    // What did not happen is not told.
    for told in [&told["faults"], &told["outcomes"]] {
        let counts = told.as_object().unwrap().values();
        assert!(
            counts.map(|told| told.get("count").unwrap_or(told)).all(|count| count.as_u64() > Some(0)),
            "{told}"
        );
    }
    assert_eq!(told["written"][0], "contacts.csv");
    // Beside rows on the standard output it goes where words go.
    let output = folder.run(&with(&["--json", "--no-report", "--output", "-"]));
    assert!(String::from_utf8(output.stdout).unwrap().starts_with("t_s,"));
    serde_json::from_slice::<serde_json::Value>(&output.stderr).unwrap();
}
