//! What the options of `fingertip calibrate` do.

use fingertip_calibration::file::CalibrationFile;

use crate::common::Folder;
use crate::said::{FULL, noisy, noisy_loads};

/// Calibrates with these options besides: the exit code, and all that is said.
fn calibrate(folder: &Folder, more: &[&str]) -> (i32, String) {
    let all = [&["calibrate", "loads.csv", "-o", "cal.toml"][..], &FULL, more].concat();
    let output = folder.run(&all);
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
    (output.status.code().unwrap(), said)
}

#[test]
fn uncertain_loads_and_readings_have_one_number_or_one_each() {
    let folder = Folder::new();
    folder.write("loads.csv", &noisy_loads());
    let run = |more: &[&str]| calibrate(&folder, more);
    let total = |loads: &str, readings: &str| {
        run(&["--method", "total", "--load-error", loads, "--reading-error", readings])
    };
    let fitted = |loads: &str, readings: &str| {
        let (code, said) = total(loads, readings);
        assert_eq!(code, 0, "{said}");
        folder.read("cal.toml")
    };
    let good = fitted("0.01,0.0001", "0.002");
    // One for each axis and gauge is the same, if they are the same.
    assert_eq!(fitted("0.01,0.01,0.01,0.0001,0.0001,0.0001", "0.002,0.002,0.002,0.002,0.002,0.002"), good);
    assert_ne!(fitted("0.5,0.0001", "0.002"), good);
    assert_ne!(fitted("0.01,0.01", "0.002"), good);
    for loads in ["1", "1,2,3", "0,1", "1,-1", "nan,1", "1,1,1,1,1,0"] {
        let (code, said) = total(loads, "1");
        assert!(
            code == 1
                && said.contains("--load-error must have 2 numbers (forces, torques) or 6, all positive"),
            "{loads}: {said}"
        );
    }
    for readings in ["0", "1,2", "1,1,1,1,1,0"] {
        let (code, said) = total("1,1", readings);
        assert!(
            code == 1 && said.contains("--reading-error must have 1 number or 6, all positive"),
            "{readings}: {said}"
        );
    }
    // Of forces alone one number is enough.
    let forces = "fx_N,fy_N,fz_N,v1_V,v2_V,v3_V\n1,0,0,1,0,0\n0,1,0,0,1,0\n0,0,1,0,0,1\n0,0,0,0,0,0\n-1,0,0,-1,0,0\n0,-1,0,0,-1,0\n0,0,-1,0,0,-1\n";
    folder.write("forces.csv", &noisy(forces, &["v"], 1e-3));
    let total = [
        "calibrate",
        "forces.csv",
        "-o",
        "f.toml",
        "--method",
        "total",
        "--reading-error",
        "0.001",
        "--load-error",
    ];
    let one = folder.succeed(&[&total[..], &["0.001"]].concat());
    assert_eq!(folder.succeed(&[&total[..], &["0.001,0.001,0.001"]].concat()), one);
    // An earlier calibration must be of the same sensor, and its method that of a prior.
    let (code, said) = run(&["--prior", "f.toml"]);
    assert!(code == 1 && said.contains("the earlier calibration has other axes, gauges or units"), "{said}");
    let (code, said) = run(&["--prior", "f.toml", "--method", "huber"]);
    assert!(code == 1 && said.contains("--prior is for --method prior alone"), "{said}");
}

#[test]
fn what_a_calibration_is_told_is_written_down() {
    let folder = Folder::new();
    folder.write("loads.csv", &noisy_loads());
    let run = |more: &[&str]| calibrate(&folder, more);
    let told = [
        "--serial",
        "T7",
        "--date",
        "2026-11-21",
        "--range",
        "-4",
        "4.5",
        "--html",
        "r.html",
        "--cal",
        "x.cal",
    ];
    let (code, said) = run(&told);
    assert!(code == 0 && said.contains("Written: cal.toml, x.cal, r.html\n"), "{said}");
    let text = folder.read("cal.toml");
    for expected in
        ["serial = \"T7\"", "date = \"2026-11-21\"", "source = \"loads.csv\"", "range = [-4.0, 4.5]"]
    {
        assert!(text.contains(expected), "{expected} is not in {text}");
    }
    let page = folder.read("r.html");
    for expected in ["<title>T7</title>", ">T7</td>", ">2026-11-21</td>", ">loads.csv</td>", ">cal.toml</td>"]
    {
        assert!(page.contains(expected), "{expected} is not in {page}");
    }
    folder.succeed(&["check", "cal.toml", "loads.csv", "--html", "check.html", "--overwrite"]);
    let page = folder.read("check.html");
    assert!(
        page.contains(">T7</td>") && page.contains(">2026-11-21</td>") && page.contains(">cal.toml</td>")
    );
    // Without a zero, and of loads from signals.
    run(&["--no-bias"]);
    assert!(
        folder.read("cal.toml").contains("zero = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]"),
        "{}",
        folder.read("cal.toml")
    );
    let (code, said) = run(&["--inverse"]);
    assert!(code == 0 && folder.read("cal.toml").contains("of loads"), "{said}");
}

#[test]
fn a_calibration_with_an_outlier_is_to_be_looked_at() {
    let folder = Folder::new();
    // One reading of one gauge, at an eighth of full scale off.
    let off: String = noisy_loads()
        .lines()
        .enumerate()
        .map(|(row, line)| match line.rsplit_once(',') {
            Some((before, last)) if row == 5 => {
                format!("{before},{}\n", last.parse::<f64>().unwrap() + 0.25)
            }
            _ => format!("{line}\n"),
        })
        .collect();
    let advice = "suspect until somebody has looked: repeat the readings named above";
    folder.write("loads.csv", &off);
    let (code, said) = calibrate(&folder, &["--limit", "4"]);
    assert!(code == 0 && said.contains("SUSPECT") && said.contains(advice), "{code} {said}");
    // Whoever uses it learns of it.
    folder.write("volts.csv", "t_s,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n0,0.1,0.1,0.5,0.1,0.1,0.1\n");
    folder.write(
        "scene.toml",
        "version = 1\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.01\n",
    );
    let analyze =
        ["analyze", "volts.csv", "--scene", "scene.toml", "--calibration", "cal.toml", "--no-report"];
    let doubt = "the calibration calls itself suspect: ";
    let used = folder.succeed(&analyze);
    assert!(used.contains(doubt), "{used}");
    folder.write("loads.csv", &noisy_loads());
    let (code, said) = calibrate(&folder, &["--limit", "4"]);
    assert!(code == 0 && !said.contains(advice), "{said}");
    assert!(!folder.succeed(&analyze).contains("calls itself"));
}

/// A calibration that is bad is an error unless it is accepted; the reasons are a line each, the worst first.
#[test]
fn a_bad_calibration_is_an_error_unless_it_is_accepted() {
    let folder = Folder::new();
    folder.write(
        "loads.csv",
        "fx_N,fy_N,v1_V,v2_V\n0,0,0,0\n1,0,1.1,0\n0,1,0,1.5\n1,1,0.9,0.6\n2,0,2.2,0\n0,2,0.1,1.6\n2,2,1.9,2.7\n",
    );
    for more in [&[][..], &["--stream"]] {
        let calibrate = [&["calibrate", "loads.csv", "-o", "bad.toml"][..], more].concat();
        let error = folder.fail(1, &calibrate);
        assert!(
            error.contains("the calibration bad.toml is bad: F") && error.contains("--accept-bad"),
            "{error}"
        );
        let said = folder.succeed(&[&calibrate[..], &["--accept-bad"]].concat());
        worst_first(&said);
    }
    let output = folder.run(&["check", "bad.toml", "loads.csv"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1));
    worst_first(&said);
}

/// There are two errors at least, each on a line of its own, and none is greater than the one before.
fn worst_first(said: &str) {
    let reasons =
        said.lines().filter_map(|line| line.strip_prefix("  because F")?.split_once(" % of full scale on"));
    let errors: Vec<f64> =
        reasons.map(|(text, _)| text.split_once(": ").unwrap().1.parse().unwrap()).collect();
    assert!(errors.len() >= 2 && errors.is_sorted_by(|a, b| a >= b), "{said}");
}

#[test]
fn several_tables_of_loads_are_calibrated_as_one() {
    let folder = Folder::new();
    let table = noisy_loads();
    folder.write("loads.csv", &table);
    let (_, of_one) = calibrate(&folder, &[]);
    let whole = CalibrationFile::from_toml(&folder.read("cal.toml")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    for (name, rows) in [("a.csv", 1..10), ("b.csv", 10..17), ("c.csv", 17..lines.len())] {
        folder.write(name, &format!("{}\n{}\n", lines[0], lines[rows].join("\n")));
    }
    let parts = ["calibrate", "a.csv", "b.csv", "c.csv", "-o", "cal.toml"];
    let of_parts = folder.succeed(&[&parts[..], &FULL].concat());
    assert!(of_one.contains("24 samples") && of_parts.contains("24 samples"), "{of_parts}");
    let merged = CalibrationFile::from_toml(&folder.read("cal.toml")).unwrap();
    assert!((&merged.matrix - &whole.matrix).amax() < 1e-12);
    assert!(merged.zero.iter().zip(&whole.zero).all(|(merged, whole)| (merged - whole).abs() < 1e-12));
    assert_eq!(merged.provenance.source, "a.csv, b.csv, c.csv");
}

/// The range is that of what the converter reads, and not of what is left when the zero of a group is taken off.
#[test]
fn a_check_by_groups_does_not_ask_the_range_of_tared_readings() {
    let folder = Folder::new();
    // Readings around 5 V, and one without load.
    let lifted: String = noisy_loads()
        .lines()
        .enumerate()
        .map(|(row, line)| {
            let lift = |(column, cell): (usize, &str)| match (row, column) {
                (0, _) | (_, ..7) => cell.to_owned(),
                _ => (cell.parse::<f64>().unwrap() + 5.0).to_string(),
            };
            let cells: Vec<String> = line.split(',').enumerate().map(lift).collect();
            format!("{},{}\n", cells.join(","), if row == 0 { "group" } else { "first" })
        })
        .collect();
    folder.write("loads.csv", &format!("{lifted}24,0,0,0,0,0,0,5.1,5.1,5.1,5.1,5.1,5.1,first\n"));
    let (code, said) = calibrate(&folder, &["--range", "2", "8"]);
    assert_eq!(code, 0, "{said}");
    for more in [&[][..], &["--tare-groups"]] {
        let said = folder.succeed(&[&["check", "cal.toml", "loads.csv"][..], more].concat());
        assert!(said.contains("25 samples") && !said.contains("saturated"), "{said}");
    }
    // Of readings as they are it is asked.
    let (code, said) = calibrate(&folder, &["--range", "2", "6.9"]);
    assert_eq!(code, 0, "{said}");
    let said = folder.succeed(&["check", "cal.toml", "loads.csv"]);
    assert!(said.contains("saturated"), "{said}");
}

/// Loads of a sensor whose gauges have a part that grows with the square of what they feel.
fn curved_loads(square: f64) -> String {
    let mut text = noisy_loads().lines().next().unwrap().to_owned() + "\n";
    for case in 0..96_u32 {
        let mut share = [0.0; 6];
        let place = |step: u32| (step % 6) as usize;
        share[place(case)] = [1.0, -1.0, 0.5, -0.5][(case / 6 % 4) as usize];
        share[place(case + 2)] += 0.25;
        share[place(7 * case + 3)] += 0.3 * f64::from(case).sin();
        let loads = share.iter().enumerate().map(|(i, x)| x * if i < 3 { 10.0 } else { 100.0 });
        let volts = (0..6).map(|i| {
            let felt = 2.0 * share[i] + 0.2 * share[(i + 1) % 6];
            let noise = 1e-3 * (12.9 * (31.0 * f64::from(case) + 17.0 * i as f64)).sin();
            0.1 + felt + square * felt * felt + noise
        });
        let cells: Vec<String> = loads.chain(volts).map(|x| format!("{x:.6}")).collect();
        text += &format!("{case},{}\n", cells.join(","));
    }
    text
}

#[test]
fn a_curved_sensor_is_told_and_calibrated() {
    let folder = Folder::new();
    folder.write("loads.csv", &curved_loads(0.05));
    let run = |more: &[&str]| calibrate(&folder, more);
    let note = "note: --curvature chosen fits terms of higher order, too";
    let (code, said) = run(&["--accept-bad"]);
    assert!(code == 0 && said.contains("Calibration: BAD") && said.contains(note), "{said}");
    for choice in ["chosen", "quadratic"] {
        let (code, said) = run(&["--curvature", choice]);
        assert!(code == 0 && said.contains("Calibration: GOOD") && !said.contains(note), "{choice}: {said}");
        assert!(said.contains("least squares of loads on signals, "), "{choice}: {said}");
        let said = folder.succeed(&["check", "cal.toml", "loads.csv"]);
        assert!(said.contains("Calibration: GOOD"), "{choice}: {said}");
    }
    // One that is straight gets no terms, or is refused them.
    folder.write("loads.csv", &curved_loads(0.0));
    let (code, said) = run(&["--curvature", "chosen"]);
    assert!(code == 0 && said.contains("no term of higher order helps") && !said.contains(note), "{said}");
    let (code, said) = run(&["--curvature", "quadratic"]);
    assert!(code == 1 && said.contains("loads.csv: over-fitted: 28 coefficients"), "{said}");
    let (code, said) = run(&[]);
    assert!(code == 0 && !said.contains(note), "{said}");
}

/// Without torques about z nothing is known of what they do, and the user learns it.
#[test]
fn components_without_loads_are_left_out_and_named() {
    let folder = Folder::new();
    let still: String = noisy_loads()
        .lines()
        .enumerate()
        .filter(|(row, line)| *row == 0 || line.split(',').nth(6) == Some("0"))
        .map(|(_, line)| format!("{line}\n"))
        .collect();
    folder.write("loads.csv", &still);
    let calibrate = ["calibrate", "loads.csv", "-o", "cal.toml", "--accept-bad"];
    let said = folder.succeed(&calibrate);
    let note = "note: Tz: no load has any, so the calibration is for the other components alone";
    assert!(said.contains(note), "{said}");
    let file = CalibrationFile::from_toml(&folder.read("cal.toml")).unwrap();
    assert!(file.axes.len() == 5 && file.axes.iter().all(|axis| axis.to_string() != "Tz"), "{:?}", file.axes);
    folder.write("loads.csv", &noisy_loads());
    assert!(!folder.succeed(&calibrate).contains("no load has any"));
}
