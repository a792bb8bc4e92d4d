//! Sensors whose readings go on changing under a load that stays.

use core::fmt::Write as _;

use crate::common::Folder;

/// Load cycles of a sensor of six gauges, each of one axis, of which a lasting load adds some hundredths within 20 s.
/// Every other load is the one before in steps, up and down again.
fn cycles(seed: usize, creeps: f64) -> String {
    let mut table = String::from("t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n");
    let full = [10.0, 10.0, 20.0, 0.2, 0.2, 0.1];
    let shares = [0.03, 0.02, 0.025, 0.02, 0.01, 0.03];
    let (step, mut state) = (0.5, [0.0; 6]);
    for sample in 0..1200 {
        let (cycle, phase) = (sample / 100, sample % 100);
        let height = match phase {
            0..10 | 70.. => 0.0,
            10..30 | 50..70 => 0.5,
            _ => 1.0,
        };
        let _ = write!(table, "{}", step * f64::from(sample));
        let mut readings = String::new();
        for axis in 0..6 {
            let share = height * ((7 * axis + 3 * cycle as usize * (axis + 1) + seed) as f64).sin();
            let noise = 1e-4 * (91.7 * (6 * sample as usize + axis + 13 * seed) as f64).sin();
            let _ = write!(table, ",{}", share * full[axis]);
            let _ = write!(readings, ",{}", 0.2 + share + creeps * shares[axis] * state[axis] + noise);
            state[axis] += (share - state[axis]) * -(-step / 20.0_f64).exp_m1();
        }
        table += &readings;
        table.push('\n');
    }
    table
}

/// RMS of all axes by which a calibration misses loads, % of full scale.
fn missed(folder: &Folder, calibration: &str) -> f64 {
    folder.succeed(&["check", calibration, "later.csv", "--json", "check.json", "--overwrite"]);
    let report: serde_json::Value = serde_json::from_str(&folder.read("check.json")).unwrap();
    let axes = report["axes"].as_array().unwrap();
    axes.iter().map(|axis| axis["rms_percent"].as_f64().unwrap()).sum::<f64>() / axes.len() as f64
}

#[test]
fn creep_is_found_and_taken_off_wherever_readings_are_read() {
    let folder = Folder::new();
    folder.write("cycles.csv", &cycles(1, 1.0));
    folder.write("later.csv", &cycles(2, 1.0));
    folder.succeed(&["calibrate", "cycles.csv", "-o", "plain.toml"]);
    let options =
        ["calibrate", "cycles.csv", "-o", "creep.toml", "--creep", "--json", "r.json", "--html", "r.html"];
    let said = folder.succeed(&options);
    let line = said.lines().find(|line| line.starts_with("Creep: ")).unwrap();
    assert!(line.contains("% within 19.") && line.contains("12 cycles"), "{line}");
    assert!(said.contains("% of full scale: hysteresis "), "{said}");
    assert!(folder.read("r.html").contains("Creep"));
    let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).unwrap();
    let creep = &report["creep"];
    assert_eq!(creep["creep"]["times_s"].as_array().unwrap().len(), 1);
    assert!(creep["without_percent"].as_f64().unwrap() > 10.0 * creep["with_percent"].as_f64().unwrap());
    // Another session of the same sensor.
    let (plain, with) = (missed(&folder, "plain.toml"), missed(&folder, "creep.toml"));
    assert!(plain > 0.3 && with < 0.05, "{plain} {with}");
    // A scene takes it off as well.
    folder.write(
        "scene.toml",
        "version = 1\n[input]\nconvention = \"on_fingertip\"\nrest_s = 4.0\n[surface]\nshape = \"sphere\"\nradius_m = 0.02\n",
    );
    let recording: String = folder
        .read("later.csv")
        .lines()
        .map(|row| {
            let cells: Vec<&str> = row.split(',').collect();
            format!("{},{}\n", cells[0], cells[7..].join(","))
        })
        .collect();
    folder.write("recording.csv", &recording);
    let worst = |calibration: &str| {
        let scene = ["analyze", "--scene", "scene.toml", "--overwrite", "recording.csv", "--calibration"];
        folder.succeed(&[&scene[..], &[calibration]].concat());
        let table = folder.read("contacts.csv");
        let loads = folder.read("later.csv");
        let rows = table.lines().zip(loads.lines()).skip(1).filter(|(row, _)| !row.contains(",rest,"));
        rows.map(|(row, load)| {
            let number = |text: &str, cell: usize| text.split(',').nth(cell).unwrap().parse::<f64>().unwrap();
            (number(row, 4) - number(load, 3)).abs()
        })
        .fold(0.0, f64::max)
    };
    let (plain, with) = (worst("plain.toml"), worst("creep.toml"));
    assert!(plain > 0.2 && with < 0.01, "{plain} {with}");
}

#[test]
fn what_tells_nothing_of_creep_is_said() {
    let folder = Folder::new();
    folder.write("loads.csv", &super::loads(1.0));
    let error = folder.fail(1, &["calibrate", "loads.csv", "--creep"]);
    assert!(error.contains("loads.csv") && error.contains("t_s"), "{error}");
    // None is there: the calibration is that without.
    folder.write("cycles.csv", &cycles(3, 0.0));
    folder.succeed(&["calibrate", "cycles.csv", "-o", "plain.toml"]);
    let said = folder.succeed(&["calibrate", "cycles.csv", "-o", "none.toml", "--creep"]);
    assert!(said.contains("Creep: no creep that could be taken off"), "{said}");
    assert_eq!(folder.read("none.toml"), folder.read("plain.toml"));
    // What holds no state cannot have it.
    folder.write("creeping.csv", &cycles(1, 1.0));
    let rust = ["calibrate", "creeping.csv", "--creep", "--rust", "cal.rs", "-o", "cal.toml"];
    let error = folder.fail(1, &rust);
    assert!(error.contains("CreepCompensation"), "{error}");
}
