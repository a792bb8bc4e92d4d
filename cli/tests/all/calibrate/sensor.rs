//! Methods, plans, motion, touches and streams.

use nalgebra::{DMatrix, DVector, Rotation3, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use crate::common::Folder;

const FULL: [&str; 2] = ["--full-scale", "10,10,10,0.1,0.1,0.1"];

#[test]
fn every_method_can_be_asked_for() {
    let folder = Folder::new();
    folder.write("loads.csv", &super::loads(1.0));
    folder.succeed(&[&["calibrate", "loads.csv", "-o", "old.toml"][..], &FULL].concat());
    let uncertain = ["--load-error", "0.01,0.0001", "--reading-error", "0.001"];
    let total = [&["--method", "total"][..], &uncertain].concat();
    let helmert = [&["--method", "gauss-helmert", "--load-error-share", "0.001"][..], &uncertain].concat();
    for (options, name) in [
        (vec!["--method", "huber"], "Huber"),
        (vec!["--method", "ransac", "--bad-share", "0.3"], "RANSAC"),
        (total, "total least squares"),
        (helmert, "Gauss-Helmert"),
        (vec!["--prior", "old.toml", "--prior-error", "0.2"], "least squares with a prior"),
    ] {
        let start = ["calibrate", "loads.csv", "-o", "cal.toml", "--tip-radius", "0.02"];
        let said = folder.succeed(&[&start[..], &options, &FULL].concat());
        assert!(said.contains(name) && said.contains("sphere of 20 mm"), "{said}");
        assert!(folder.read("cal.toml").contains(&format!("method = \"{name} of signals")));
    }
    folder.fail(2, &["calibrate", "loads.csv", "--method", "total"]);
    folder.fail(2, &["calibrate", "loads.csv", "--method", "prior"]);
    let wrong =
        ["calibrate", "loads.csv", "--method", "total", "--load-error", "1,2,3", "--reading-error", "1"];
    let error = folder.fail(1, &wrong);
    assert!(error.contains("--load-error") && error.contains("loads.csv"), "{error}");
    let error = folder.fail(1, &["calibrate", "loads.csv", "--prior", "none.toml"]);
    assert!(error.contains("none.toml"), "{error}");
    folder.write(
        "scene.toml",
        "version = 1\n[input]\nconvention = \"reaction\"\n[surface]\nshape = \"cylinder\"\nradius_m = 0.01\n",
    );
    let said = folder.succeed(&["calibrate", "loads.csv", "--scene", "scene.toml", "--touch-force", "2"]);
    assert!(said.contains("surface of scene.toml under 2.000 N"), "{said}");
}

/// Two errors are those of forces and torques, but of a sensor of two forces those of each.
#[test]
fn two_errors_of_two_forces_are_one_for_each() {
    let folder = Folder::new();
    let rows = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mut table = String::from("fx_N,fy_N,v1_V,v2_V\n");
    for (i, [x, y]) in rows.into_iter().enumerate() {
        let noise = |j: usize| 0.01 * (12.9 * (3 * i + j) as f64).sin();
        table += &format!("{x},{y},{},{}\n", x + noise(0), y + noise(1));
    }
    folder.write("loads.csv", &table);
    let fitted = |errors: &str| {
        let options = ["--method", "total", "--reading-error", "0.01", "--load-error", errors];
        folder.succeed(&[&["calibrate", "loads.csv", "-o", "cal.toml"][..], &options].concat());
        folder.read("cal.toml")
    };
    let same = fitted("0.01");
    assert_eq!(fitted("0.01,0.01"), same);
    assert_ne!(fitted("0.01,0.2"), same);
    folder.succeed(&["check", "cal.toml", "loads.csv"]);
}

#[test]
fn a_stream_gives_the_same_matrix() {
    let folder = Folder::new();
    folder.write("loads.csv", &super::loads(1.0));
    folder.succeed(&["calibrate", "loads.csv", "-o", "all.toml"]);
    let said = folder.succeed(&["calibrate", "loads.csv", "--stream", "-o", "stream.toml", "--rust", "s.rs"]);
    assert!(said.contains("unchecked") && said.contains("24 samples"), "{said}");
    let numbers = |name: &str| -> Vec<f64> {
        let text = folder.read(name);
        let rows = text.split("\nmatrix = [").nth(1).unwrap().split("\n]").next().unwrap();
        rows.split(['[', ']', ',', '\n']).filter_map(|cell| cell.trim().parse().ok()).collect()
    };
    let (all, stream) = (numbers("all.toml"), numbers("stream.toml"));
    assert_eq!((all.len(), stream.len()), (36, 36));
    assert!(all.iter().zip(&stream).all(|(a, b)| (a - b).abs() < 1e-12));
    folder.write("bad.csv", &super::loads(1.0).replacen(",10,", ",x,", 1));
    let error = folder.fail(1, &["calibrate", "bad.csv", "--stream"]);
    assert!(error.contains("bad.csv: line") && error.contains("column"), "{error}");
    let error = folder.fail(1, &["calibrate", "loads.csv", "--stream", "--method", "huber"]);
    assert!(error.contains("least-squares"), "{error}");
}

#[test]
fn a_plan_says_which_loads_and_how_many() {
    let folder = Folder::new();
    let mut text = String::from("name,fx_N,fy_N,fz_N\n");
    for axis in 0..3 {
        for sign in ["", "-"] {
            let cells: Vec<String> =
                (0..3).map(|j| if j == axis { format!("{sign}5") } else { "0".to_owned() }).collect();
            text += &format!("{sign}{axis},{}\n", cells.join(","));
        }
    }
    folder.write("rig.csv", &text);
    let said = folder.succeed(&["plan", "rig.csv", "--no-bias", "--accuracy", "0.5"]);
    assert!(said.contains("12 loads are enough"), "{said}");
    folder.write("done.csv", &text);
    let said = folder.succeed(&["plan", "rig.csv", "--no-bias", "--accuracy", "0.5", "--done", "done.csv"]);
    assert!(said.contains("6 loads beside the 6"), "{said}");
    for scale in ["5,5", "5,5,0", "5,-5,5", "nan,5,5"] {
        let error = folder.fail(1, &["plan", "rig.csv", &format!("--full-scale={scale}")]);
        assert!(
            error.contains("--full-scale needs one positive number for each of 3 axes"),
            "{scale}: {error}"
        );
    }
    folder.write("torques.csv", "tx_Nm,ty_Nm,tz_Nm\n1,0,0\n0,1,0\n");
    let error = folder.fail(1, &["plan", "rig.csv", "--done", "torques.csv"]);
    assert!(error.contains("torques.csv: it has other axes than the loads that can be applied"), "{error}");
    folder.write("flat.csv", "fx_N,fy_N,fz_N\n1,0,0\n0,1,0\n");
    let error = folder.fail(1, &["plan", "flat.csv", "--most", "50"]);
    assert!(error.contains("flat.csv") && error.contains("unobserved: ") && error.contains("Fz"), "{error}");
}

fn direction(random: &mut Pcg64Mcg) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)).normalize()
}

fn volts(readings: &DVector<f64>) -> String {
    readings.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
}

#[test]
fn motion_finds_a_sensor_of_three_components() {
    let random = &mut Pcg64Mcg::seed_from_u64(3);
    let sensor = DMatrix::from_fn(3, 3, |i, j| if i == j { 2.0 } else { 0.1 * (i as f64 - j as f64) });
    let read = |force: Vector3<f64>| {
        &sensor * DVector::from_column_slice(force.as_slice()) + DVector::from_element(3, 0.5)
    };
    let mut text = String::from("v1_V,v2_V,v3_V\n");
    (0..30).for_each(|_| text += &format!("{}\n", volts(&read(direction(random) * 4.0))));
    let mut known = String::from("fx_N,fy_N,fz_N,v1_V,v2_V,v3_V\n");
    for f in [Vector3::x(), Vector3::y(), Vector3::z()] {
        known += &format!("{},{},{},{}\n", f.x, f.y, f.z, volts(&read(f * 4.0)));
    }
    let folder = Folder::new();
    folder.write("turned.csv", &text);
    folder.write("known.csv", &known);
    let said = folder.succeed(&["motion", "turned.csv", "--force", "4"]);
    assert!(said.contains("not observed: one rotation"), "{said}");
    folder.fail(2, &["motion", "turned.csv", "--force", "4", "-o", "cal.toml"]);
    folder.succeed(&["motion", "turned.csv", "--force", "4", "--align", "known.csv", "-o", "cal.toml"]);
    folder.write(
        "test.csv",
        &known.replace("1,0,0,", "4,0,0,").replace("0,1,0,", "0,4,0,").replace("0,0,1,", "0,0,4,"),
    );
    let said = folder.succeed(&["check", "cal.toml", "test.csv", "--limit", "0.001"]);
    assert!(said.contains("GOOD"), "{said}");
    folder.write("two.csv", &known.replacen(",v3_V", ",other", 1));
    let error = folder.fail(1, &["motion", "turned.csv", "--force", "4", "--align", "two.csv"]);
    assert!(error.contains("two.csv: it has other gauges or units than the readings"), "{error}");
    folder.write("ratio.csv", &known.replacen("_V", "_mVpV", 3));
    let error = folder.fail(1, &["motion", "turned.csv", "--force", "4", "--align", "ratio.csv"]);
    assert!(error.contains("ratio.csv: it has other gauges or units than the readings"), "{error}");
    let error = folder.fail(1, &["motion", "turned.csv", "--force", "0"]);
    assert!(error.contains("turned.csv"), "{error}");
}

#[test]
fn motion_finds_a_sensor_of_six_components() {
    let random = &mut Pcg64Mcg::seed_from_u64(4);
    let sensor = DMatrix::from_fn(7, 6, |i, j| {
        (if i == j { 2.0 } else { 0.2 * random.random_range(-1.0..1.0) }) * if j < 3 { 1.0 } else { 20.0 }
    });
    let read = |arm: Vector3<f64>, force: Vector3<f64>| {
        let torque = arm.cross(&force);
        let load = DVector::from_iterator(6, force.iter().chain(torque.iter()).copied());
        &sensor * load + DVector::from_element(7, 0.5)
    };
    let arms = [[0.05, 0.0, 0.0], [0.0, 0.05, 0.0], [0.0, 0.0, 0.05], [0.04, 0.04, 0.03]].map(Vector3::from);
    let header = "v1_V,v2_V,v3_V,v4_V,v5_V,v6_V,v7_V";
    let mut text = format!("arm_x_m,arm_y_m,arm_z_m,{header}\n");
    for arm in arms {
        for _ in 0..20 {
            let reading = read(arm, direction(random) * 5.0);
            text += &format!("{},{},{},{}\n", arm.x, arm.y, arm.z, volts(&reading));
        }
    }
    let known = read(arms[0], Vector3::new(0.0, 0.0, -5.0));
    let folder = Folder::new();
    folder.write("hung.csv", &text);
    folder.write("known.csv", &format!("fx_N,fy_N,fz_N,{header}\n0,0,-1,{}\n", volts(&known)));
    let command = ["motion", "hung.csv", "--force", "5", "--tolerance", "1e-6"];
    folder.succeed(&[&command[..], &["--align", "known.csv", "-o", "cal.toml"]].concat());
    let mut test = format!("fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,{header}\n");
    for _ in 0..10 {
        let (arm, force) = (direction(random) * 0.05, direction(random) * 5.0);
        let torque = arm.cross(&force);
        let load: Vec<String> = force.iter().chain(torque.iter()).map(ToString::to_string).collect();
        test += &format!("{},{}\n", load.join(","), volts(&read(arm, force)));
    }
    folder.write("test.csv", &test);
    let said = folder.succeed(&["check", "cal.toml", "test.csv", "--limit", "0.01"]);
    assert!(said.contains("GOOD"), "{said}");
}

#[test]
fn touches_mend_a_calibration() {
    let random = &mut Pcg64Mcg::seed_from_u64(6);
    let turn = |random: &mut Pcg64Mcg| Rotation3::from_scaled_axis(direction(random));
    let mut touches = String::from("v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n");
    // The sensor of `loads`, of which gauge 4 has become 5 % weaker.
    let read = |share: [f64; 6]| {
        let weaker = |i: usize| if i == 3 { 0.95 } else { 1.0 };
        DVector::from_fn(6, |i, _| 0.1 + weaker(i) * (2.0 * share[i] + 0.2 * share[(i + 1) % 6]))
    };
    for _ in 0..200 {
        let normal = turn(random) * Vector3::x();
        let force = direction(random) * 5.0;
        let torque = (normal * 0.01).cross(&force);
        let share = core::array::from_fn(|i| if i < 3 { force[i] / 10.0 } else { torque[i - 3] / 0.1 });
        touches += &format!("{}\n", volts(&read(share)));
    }
    let folder = Folder::new();
    folder.write("loads.csv", &super::loads(1.0));
    folder.succeed(&[&["calibrate", "loads.csv", "-o", "cal.toml"][..], &FULL].concat());
    folder.write("touches.csv", &touches);
    let known: String = super::loads(1.0)
        .lines()
        .enumerate()
        .map(|(i, line)| {
            if i == 0 {
                return format!("{line}\n");
            }
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            let volts: f64 = cells[10].parse().unwrap();
            cells[10] = (0.1 + 0.95 * (volts - 0.1)).to_string();
            format!("{}\n", cells.join(","))
        })
        .collect();
    folder.write("all.csv", &known);
    // Six loads of the weakened sensor, with the touches, mend all of it.
    let few: Vec<&str> = known.lines().take(8).collect();
    folder.write("few.csv", &few.join("\n"));
    let said = folder.succeed(&["refine", "cal.toml", "touches.csv"]);
    assert!(said.contains("200 touches") && said.contains("off that of the calibration"), "{said}");
    folder.fail(1, &["check", "cal.toml", "all.csv", "--limit", "0.5"]);
    folder.succeed(&["refine", "cal.toml", "touches.csv", "--loads", "few.csv", "-o", "mended.toml"]);
    let said = folder.succeed(&["check", "mended.toml", "all.csv", "--limit", "0.5"]);
    assert!(said.contains("GOOD"), "{said}");
    let error = folder.fail(1, &["refine", "cal.toml", "none.csv"]);
    assert!(error.contains("none.csv"), "{error}");
    let lines = |column: &str| touches.replacen(",v6_V", column, 1);
    folder.write("five.csv", &lines(",other"));
    let error = folder.fail(1, &["refine", "cal.toml", "five.csv"]);
    assert!(error.contains("five.csv: it has 5 gauges, the calibration 6"), "{error}");
    folder.write("ratio.csv", &touches.replacen("_V", "_mVpV", 6));
    let error = folder.fail(1, &["refine", "cal.toml", "ratio.csv"]);
    assert!(error.contains("ratio.csv: its readings are in another unit than the calibration"), "{error}");
}
