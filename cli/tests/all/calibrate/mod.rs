//! The commands that calibrate, from outside.

mod creep;
mod inertial;
pub(crate) mod payload;
mod sensor;
pub(crate) mod surface;
mod temperature;

use crate::common::Folder;

/// Loads of each axis up and down; gauge i reads 2 V under 10 N or 0.1 N·m of axis i, and a tenth of its
/// neighbour's; zeros of 0.1 V, readings rounded to 0.1 mV.
pub(crate) fn loads(gain: f64) -> String {
    let mut text = String::from("case,fx_N,fy_N,fz_N,tx_Nmm,ty_Nmm,tz_Nmm,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n");
    for case in 0..24 {
        let mut share = [0.0; 6];
        share[case % 6] = [1.0, -1.0, 0.5, -0.5][case / 6];
        share[(case + 2) % 6] += 0.25;
        let load: Vec<String> = share
            .iter()
            .enumerate()
            .map(|(i, x)| (x * if i < 3 { 10.0 } else { 100.0 }).to_string())
            .collect();
        let volts: Vec<String> = (0..6)
            .map(|i| format!("{:.4}", 0.1 + gain * (2.0 * share[i] + 0.2 * share[(i + 1) % 6])))
            .collect();
        text.push_str(&format!("{case},{},{}\n", load.join(","), volts.join(",")));
    }
    text
}

#[test]
fn calibrate_check_tare() {
    let folder = Folder::new();
    folder.write("loads.csv", &loads(1.0));
    let text = folder.succeed(&[
        "calibrate",
        "loads.csv",
        "-o",
        "tip.toml",
        "--serial",
        "T1",
        "--html",
        "r.html",
        "--json",
        "r.json",
        "--cal",
        "tip.cal",
        "--rust",
        "tip.rs",
        "--full-scale",
        "10,10,10,0.1,0.1,0.1",
    ]);
    assert!(!text.contains("columns not used"), "{text}");
    assert!(text.contains("Calibration: GOOD") && text.contains("Written: tip.toml, tip.cal"), "{text}");
    assert!(
        folder.read("r.html").contains("<svg") && folder.read("r.json").contains("\"verdict\": \"good\"")
    );
    assert!(folder.read("tip.rs").contains("pub const NORMALISED"));
    let checked = folder.succeed(&["check", "tip.toml", "loads.csv"]);
    assert!(checked.contains("GOOD"), "{checked}");
    // A sensor whose gain has drifted by 10 %.
    folder.write("later.csv", &loads(1.1));
    let error = folder.fail(1, &["check", "tip.toml", "later.csv"]);
    assert!(error.contains("does not hold") && error.contains("% of full scale"), "{error}");
    // A new zero: rest at 0.2 V. The ATI file has no zero of its own.
    folder.write("rest.csv", "v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n.2,.2,.2,.2,.2,.2\n.2,.2,.2,.2,.2,.2\n");
    let tared = folder.succeed(&["tare", "tip.toml", "rest.csv", "-o", "tared.toml"]);
    assert!(tared.contains("Zero of 2 readings") && tared.contains("the old zero read"), "{tared}");
    assert!(folder.read("tared.toml").contains("zero = [0.2, 0.2"));
    folder.succeed(&["tare", "tip.cal", "rest.csv", "-o", "from_ati.toml"]);
}

#[test]
fn mistakes_are_explained() {
    let folder = Folder::new();
    let table = loads(1.0);
    folder.write("loads.csv", &table);
    folder.write("unit.csv", &table.replace("fx_N", "fx_stone"));
    let moody: String = table
        .lines()
        .enumerate()
        .map(|(row, line)| format!("{line},{}\n", if row == 0 { "mood".to_owned() } else { row.to_string() }))
        .collect();
    folder.write("moody.csv", &moody);
    let said = folder.succeed(&["calibrate", "moody.csv", "-o", "moody.toml"]);
    assert!(said.contains("moody.csv: columns not used: mood"), "{said}");
    let error = folder.fail(1, &["calibrate", "unit.csv"]);
    assert!(error.contains("fx_stone") && error.contains("line 1"), "{error}");
    let error = folder.fail(1, &["calibrate", "loads.csv", "-o", "loads.csv"]);
    assert!(error.contains("overwritten"), "{error}");
    let error = folder.fail(1, &["calibrate", "none.csv"]);
    assert!(error.contains("none.csv"), "{error}");
    folder.fail(2, &["calibrate"]);
    folder.fail(2, &["calibrate", "loads.csv", "--quadratic"]);
    // Only forces: the torques are not observed, and named.
    let few: Vec<&str> = table.lines().take(2).collect();
    folder.write("few.csv", &few.join("\n"));
    let error = folder.fail(1, &["calibrate", "few.csv"]);
    assert!(error.contains("unobserved"), "{error}");
    folder.succeed(&["calibrate", "loads.csv", "-o", "tip.toml"]);
    folder.write(
        "edited.toml",
        &folder.read("tip.toml").replacen("signal_unit = \"V\"", "signal_unit = \"count\"", 1),
    );
    let error = folder.fail(1, &["check", "edited.toml", "loads.csv"]);
    assert!(error.contains("checksum"), "{error}");
}

#[test]
fn gravity() {
    let folder = Folder::new();
    // 2 N, centre of mass at 30 mm on z, force bias (1, 2, 3) N; turns by 180° and 90° about the axes.
    let mut text = String::from("qx,qy,qz,qw,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n");
    let h = core::f64::consts::FRAC_1_SQRT_2;
    for (q, down) in [
        ([0.0, 0.0, 0.0, 1.0], [0.0, 0.0, -1.0]),
        ([1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        ([h, 0.0, 0.0, h], [0.0, -1.0, 0.0]),
        ([-h, 0.0, 0.0, h], [0.0, 1.0, 0.0]),
        ([0.0, h, 0.0, h], [1.0, 0.0, 0.0]),
        ([0.0, -h, 0.0, h], [-1.0, 0.0, 0.0]),
    ] {
        let f = down.map(|x| 2.0 * x);
        let m = [-0.03 * f[1], 0.03 * f[0], 0.0];
        text.push_str(&format!(
            "{},{},{},{},{},{},{},{},{},{}\n",
            q[0],
            q[1],
            q[2],
            q[3],
            f[0] + 1.0,
            f[1] + 2.0,
            f[2] + 3.0,
            m[0],
            m[1],
            m[2]
        ));
    }
    folder.write("poses.csv", &text);
    let said = folder.succeed(&["calibrate", "--gravity", "poses.csv"]);
    assert!(
        said.contains("Written: payload.toml") && folder.read("payload.toml").contains("mass_kg = 0.2039")
    );
    assert!(said.contains("2.00000 ±") && said.contains("+30.00000 mm"), "{said}");
    assert!(said.contains("+1.00000 +2.00000 +3.00000 N"), "{said}");
    folder.succeed(&["calibrate", "--gravity", "poses.csv", "--serial", "T7", "--date", "2026-11-21"]);
    for expected in ["serial = \"T7\"", "date = \"2026-11-21\"", "source = \"poses.csv\""] {
        assert!(folder.read("payload.toml").contains(expected), "{expected} is not in it");
    }
}
