//! What the options of `fingertip calibrate` do.

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
    folder.write("loads.csv", &noisy_loads());
    let (code, said) = calibrate(&folder, &["--limit", "4"]);
    assert!(code == 0 && !said.contains(advice), "{said}");
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
