//! What the commands that calibrate and design say of noisy data, as somebody has looked at it.

use nalgebra::{DMatrix, DVector, Rotation3, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use crate::calibrate::{loads, payload, surface};
use crate::common::{Folder, assert_accepted, body};

/// Something like noise of so many units in the columns whose names start so.
pub(crate) fn noisy(table: &str, starts: &[&str], size: f64) -> String {
    let mut lines = table.lines();
    let header = lines.next().unwrap();
    let chosen: Vec<bool> =
        header.split(',').map(|name| starts.iter().any(|start| name.starts_with(start))).collect();
    let mut text = format!("{header}\n");
    for (i, line) in lines.enumerate() {
        let cells: Vec<String> = line
            .split(',')
            .zip(&chosen)
            .enumerate()
            .map(|(j, (cell, chosen))| {
                let noise = size * (12.9 * (31 * i + 17 * j) as f64).sin();
                if *chosen { format!("{:.9}", cell.parse::<f64>().unwrap() + noise) } else { cell.to_owned() }
            })
            .collect();
        text += &format!("{}\n", cells.join(","));
    }
    text
}

pub(crate) fn noisy_loads() -> String {
    noisy(&loads(1.0), &["v"], 2e-3)
}

pub(crate) const FULL: [&str; 2] = ["--full-scale", "10,10,10,0.1,0.1,0.1"];

#[test]
fn of_a_calibration_and_its_check() {
    let folder = Folder::new();
    folder.write("loads.csv", &noisy_loads());
    let calibrate = ["calibrate", "loads.csv", "-o", "cal.toml", "--tip-radius", "0.012"];
    assert_accepted("calibrate.txt", &folder.succeed(&[&calibrate[..], &FULL].concat()));
    folder.write("later.csv", &noisy(&loads(1.0), &["v"], 5e-3));
    let check = ["check", "cal.toml", "later.csv", "--touch-force", "3"];
    assert_accepted("check.txt", &folder.succeed(&check));
    folder.write(
        "rest.csv",
        &noisy("v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n.2,.2,.2,.2,.2,.2\n.2,.2,.2,.2,.2,.2\n", &["v"], 1e-3),
    );
    assert_accepted("tare.txt", &folder.succeed(&["tare", "cal.toml", "rest.csv", "-o", "tared.toml"]));
    // Surfaces of scenes, on which the report says what the calibration is worth.
    for (name, shape) in [
        ("plane", "shape = \"plane\"\npoint_m = [0.0, 0.0, 0.01]"),
        ("cap", "shape = \"sphere\"\nradius_m = 0.01\nactive_half_angle_deg = 60.0"),
        ("cylinder", "shape = \"cylinder\"\nradius_m = 0.01\nhalf_length_m = 0.01"),
        ("ellipsoid", "shape = \"ellipsoid\"\nsemi_axes_m = [0.01, 0.012, 0.014]"),
    ] {
        folder.write(
            "scene.toml",
            &format!("version = 1\n[input]\nconvention = \"on_fingertip\"\n[surface]\n{shape}\n"),
        );
        let said = folder.succeed(&["check", "cal.toml", "later.csv", "--scene", "scene.toml"]);
        assert_accepted(&format!("check_on_{name}.txt"), &said);
    }
}

#[test]
fn of_a_stream_of_two_files() {
    let folder = Folder::new();
    // The second file has a reading at the end of the range, and a column that is not used.
    let table = noisy_loads();
    folder.write("a.csv", &table);
    let more: String = table
        .lines()
        .enumerate()
        .map(|(i, line)| format!("{line},{}\n", if i == 0 { "mood" } else { "x" }))
        .collect();
    folder.write("b.csv", &more);
    let stream = ["calibrate", "a.csv", "b.csv", "--stream", "-o", "cal.toml", "--range", "-1.9", "1.9"];
    assert_accepted("stream.txt", &folder.succeed(&[&stream[..], &FULL].concat()));
    let bad = [&stream[..], &FULL, &["--limit", "0.01", "--accept-bad"]].concat();
    assert_accepted("stream_bad.txt", &folder.succeed(&bad));
    assert!(folder.read("cal.toml").contains("verdict = \"bad\""));
    // A reading at the end of the range is none; and more rows than are looked at at once.
    let least = table
        .lines()
        .skip(1)
        .flat_map(|line| line.split(',').skip(7).map(|cell| cell.parse::<f64>().unwrap()).collect::<Vec<_>>())
        .fold(f64::INFINITY, f64::min);
    let least = format!("{least:.9}");
    let said = folder.succeed(&["calibrate", "a.csv", "--stream", "-o", "c.toml", "--range", &least, "9"]);
    assert!(said.contains("23 samples"), "{said}");
    let header = table.lines().next().unwrap();
    let rows: String = table.lines().skip(1).map(|line| format!("{line}\n")).collect();
    folder.write("many.csv", &format!("{header}\n{}", rows.repeat(400)));
    let errors = |file: &str| {
        let said = folder.succeed(&["calibrate", file, "--stream", "-o", "c.toml"]);
        said.lines().filter(|line| line.contains("RMS")).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(errors("a.csv").len(), 6);
    assert_eq!(errors("many.csv"), errors("a.csv"));
    // Rows without weight or of less than none.
    let weighted = |weight: &str| {
        table
            .lines()
            .enumerate()
            .map(|(i, line)| format!("{line},{}\n", if i == 0 { "weight" } else { weight }))
            .collect::<String>()
    };
    folder.write("c.csv", &weighted("2"));
    let said = folder.succeed(&["calibrate", "c.csv", "--stream", "-o", "c.toml"]);
    assert!(said.contains("24 samples") && !said.contains("saturated"), "{said}");
    folder.write("c.csv", &weighted("-2"));
    let error = folder.fail(1, &["calibrate", "c.csv", "--stream", "-o", "c.toml"]);
    assert!(error.contains("c.csv: line 2: the weight is negative"), "{error}");
    folder.write("other.csv", &table.replace(",v6_V", ",dummy"));
    let error = folder.fail(1, &["calibrate", "a.csv", "other.csv", "--stream", "-o", "c.toml"]);
    assert!(error.contains("other.csv") && error.contains("than the first file"), "{error}");
}

#[test]
fn of_a_payload() {
    let folder = Folder::new();
    let mount = Rotation3::from_scaled_axis(Vector3::new(0.02, 0.01, 0.3));
    let table = |mount: &Rotation3<f64>| noisy(&payload::poses(mount), &["f", "t"], 2e-3);
    folder.write("poses.csv", &table(&Rotation3::identity()));
    let gravity = ["calibrate", "--gravity", "poses.csv"];
    for (name, more) in [
        ("plain", &[][..]),
        ("down", &["--fit-down"]),
        ("centre_on_z", &["--centre-on", "z"]),
        ("centre_on_x", &["--centre-on", "x"]),
        ("centre_on_y", &["--centre-on", "y"]),
        ("in_base", &["--wrench-in-base"]),
        ("reaction", &["--reaction"]),
    ] {
        let output = folder.run(&[&gravity[..], more].concat());
        let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
        assert_accepted(&format!("gravity_{name}.txt"), &said);
    }
    folder.write("poses.csv", &table(&mount));
    assert_accepted("gravity_mounting.txt", &folder.succeed(&[&gravity[..], &["--fit-mounting"]].concat()));
}

#[test]
fn of_surfaces() {
    const KNOWN: &str = "version = 1\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.01\n";
    let folder = Folder::new();
    for shape in ["sphere", "ellipsoid", "aligned-ellipsoid", "cylinder", "plane", "pivot", "pose"] {
        let data = surface::touches(if shape == "aligned-ellipsoid" { "sphere" } else { shape });
        folder.write("touches.csv", &noisy(&data, &["tx", "ty", "tz"], 1e-4));
        let mut command = vec!["geometry", shape, "touches.csv"];
        match shape {
            // A point is no surface, and a pose is that of one.
            "pivot" => {}
            "pose" => {
                folder.write("known.toml", KNOWN);
                command.extend(["--scene", "known.toml", "-o", "scene.toml"]);
            }
            _ => command.extend(["-o", "scene.toml"]),
        }
        let said = folder.succeed(&command);
        assert_accepted(&format!("geometry_{shape}.txt"), &said);
        // What the fingertip does to the world is the opposite: the same surface, and another word in its scene.
        let opposite = negated(&folder.read("touches.csv"));
        let scene = folder.read("scene.toml");
        folder.write("touches.csv", &opposite);
        folder.write("known.toml", &KNOWN.replace("on_fingertip", "reaction"));
        command.push("--reaction");
        assert_eq!(folder.succeed(&command), said);
        assert_eq!(folder.read("scene.toml"), scene.replace("on_fingertip", "reaction"));
    }
    folder.write("touches.csv", &noisy(&surface::touches("cylinder"), &["tx", "ty", "tz"], 1e-4));
    let along = ["geometry", "cylinder", "touches.csv", "--axis", "0.46,-0.15,0.87"];
    assert_accepted("geometry_cylinder_along.txt", &folder.succeed(&along));
    // From the other side a plane has the other normal.
    folder.write("touches.csv", &noisy(&surface::touches("plane"), &["tx", "ty", "tz"], 1e-4));
    let said = folder.succeed(&["geometry", "plane", "touches.csv", "--outward", "0,0,-1"]);
    assert!(said.contains("-11.1374 ±") && said.contains("-0.00189 -0.06253 -0.99804"), "{said}");
}

/// The wrenches of a table, turned round.
fn negated(table: &str) -> String {
    let mut lines = table.lines();
    let mut text = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let cells: Vec<String> = line
            .split(',')
            .enumerate()
            .map(
                |(j, cell)| if j < 6 { (-cell.parse::<f64>().unwrap()).to_string() } else { cell.to_owned() },
            )
            .collect();
        text += &format!("{}\n", cells.join(","));
    }
    text
}

fn direction(random: &mut Pcg64Mcg) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)).normalize()
}

/// A table of readings of a sensor under forces of one size, and one of known directions.
fn turned(gauges: usize, arms: &[Vector3<f64>]) -> (String, String) {
    let random = &mut Pcg64Mcg::seed_from_u64(8);
    let axes = if arms.is_empty() { 3 } else { 6 };
    let sensor = DMatrix::from_fn(gauges, axes, |i, j| {
        (if i == j { 2.0 } else { 0.3 * random.random_range(-1.0..1.0) }) * if j < 3 { 1.0 } else { 20.0 }
    });
    let mut reading = |arm: Vector3<f64>, force: Vector3<f64>| {
        let torque = arm.cross(&force);
        let load = DVector::from_iterator(axes, force.iter().chain(torque.iter()).copied().take(axes));
        let noise = DVector::from_fn(gauges, |_, _| random.random_range(-0.004..0.004));
        let volts = &sensor * load + DVector::from_element(gauges, 0.5) + noise;
        volts.iter().map(|volts| format!("{volts:.9}")).collect::<Vec<_>>().join(",")
    };
    let names: Vec<String> = (1..=gauges).map(|gauge| format!("v{gauge}_V")).collect();
    let names = names.join(",");
    let directions = &mut Pcg64Mcg::seed_from_u64(9);
    let mut text =
        if arms.is_empty() { format!("{names}\n") } else { format!("arm_x_m,arm_y_m,arm_z_m,{names}\n") };
    let none = [Vector3::zeros()];
    for arm in if arms.is_empty() { &none[..] } else { arms } {
        for _ in 0..30 {
            let volts = reading(*arm, direction(directions) * 5.0);
            text += &if arms.is_empty() {
                format!("{volts}\n")
            } else {
                format!("{},{},{},{volts}\n", arm.x, arm.y, arm.z)
            };
        }
    }
    let mut known = format!("fx_N,fy_N,fz_N,{names}\n");
    let first = arms.first().copied().unwrap_or_default();
    for force in [Vector3::z(), -Vector3::x(), Vector3::y()] {
        known += &format!("{},{},{},{}\n", force.x, force.y, force.z, reading(first, force * 5.0));
    }
    (text, known)
}

#[test]
fn of_motion() {
    let folder = Folder::new();
    let arms = [[0.05, 0.0, 0.0], [0.0, 0.05, 0.0], [0.0, 0.0, 0.06], [0.04, 0.04, 0.03]].map(Vector3::from);
    for (name, gauges, arms) in [("three", 4, &[][..]), ("six", 7, &arms)] {
        let (readings, known) = turned(gauges, arms);
        folder.write("readings.csv", &readings);
        folder.write("known.csv", &known);
        let motion = ["motion", "readings.csv", "--force", "5", "--starts", "40"];
        assert_accepted(&format!("motion_{name}.txt"), &folder.succeed(&motion));
        let align = [&motion[..], &["--align", "known.csv", "-o", "cal.toml"]].concat();
        assert_accepted(&format!("motion_{name}_aligned.txt"), &folder.succeed(&align));
        // The known directions, read by what was written.
        let calibration = folder.read("cal.toml");
        assert!(
            calibration.contains("shape from motion") && calibration.contains("noise = ["),
            "{calibration}"
        );
    }
    // Gauges of another number than the readings have.
    folder.write("known.csv", &turned(6, &arms).1);
    let error = folder.fail(1, &["motion", "readings.csv", "--force", "5", "--align", "known.csv"]);
    assert!(error.contains("known.csv") && error.contains("other gauges or units"), "{error}");
}

#[test]
fn of_a_plan() {
    let folder = Folder::new();
    let axes = "fx_N,fy_N,fz_N";
    folder
        .write("rig.csv", &format!("{axes}\n5,0,0\n-4.8,0,0\n0,5.1,0\n0,-2.5,0\n0,0,10\n0,3,-9.7\n0,0,0\n"));
    assert_accepted("plan.txt", &folder.succeed(&["plan", "rig.csv", "--accuracy", "0.8"]));
    let scaled = ["plan", "rig.csv", "--accuracy", "0.8", "--no-bias", "--full-scale", "10,6,10.5"];
    assert_accepted("plan_scaled.txt", &folder.succeed(&scaled));
    folder.write("done.csv", &format!("{axes}\n5,0,0\n0,5,0\n0,0,10\n"));
    assert_accepted("plan_after.txt", &folder.succeed(&[&scaled[..], &["--done", "done.csv"]].concat()));
    for scale in ["1,2", "1,2,0", "1,2,nan"] {
        let error = folder.fail(1, &["plan", "rig.csv", "--full-scale", scale]);
        assert!(error.contains("one positive number for each of 3 axes"), "{error}");
    }
    folder.write("done.csv", "fx_N,fy_N,tz_Nm\n5,0,0\n");
    assert!(
        folder.fail(1, &["plan", "rig.csv", "--done", "done.csv"]).contains("done.csv: it has other axes")
    );
    let error = folder.fail(1, &["plan", "rig.csv", "--accuracy", "0.01", "--most", "8"]);
    assert!(error.contains("8 of these loads are not enough for an accuracy of 0.01"), "{error}");
    folder.write("flat.csv", &format!("{axes}\n1,0,0\n0,1,0\n"));
    let error = folder.fail(1, &["plan", "flat.csv"]);
    assert!(error.contains("Fz"), "{error}");
}

/// The drawings without the curves of the landscape, a tag a line.
fn without_curves(page: &str) -> String {
    let curve =
        |line: &&str| !line.starts_with("<path class=\"curve q") && !line.starts_with("<path class=\"dots a");
    body(page).lines().filter(curve).map(|line| format!("{line}\n")).collect()
}

/// What each page of a PDF draws, an operator a line.
fn drawn_on_pages(path: &std::path::Path) -> String {
    let text: String = std::fs::read(path).unwrap().into_iter().map(char::from).collect();
    let pages = text.split("\nstream\n").skip(1).filter_map(|rest| Some(rest.split_once("\nendstream")?.0));
    pages.map(|page| format!("page\n{page}\n")).collect()
}

#[test]
fn of_designs() {
    let folder = Folder::new();
    let paper = ["design", "--layout", "paper", "--starts", "3", "--seed", "2"];
    assert_accepted("design_paper.txt", &folder.succeed(&paper));
    assert_accepted("design_paper.html", &without_curves(&folder.read("design.html")));
    // Where lines and letters stand on paper, too.
    assert_accepted("design_paper_template.svg", &folder.read("template.svg"));
    assert_accepted("design_paper_pages.txt", &drawn_on_pages(&folder.path("bench.pdf")));
    let rosettes =
        ["design", "--gauges", "8", "--starts", "2", "--criterion", "contact-error", "--wall-mm", "0.08"];
    assert_accepted("design_rosettes.txt", &folder.succeed(&rosettes));
    assert_accepted("design_rosettes.html", &without_curves(&folder.read("design.html")));
    assert_accepted("design_rosettes_template.svg", &folder.read("template.svg"));
    let thick =
        ["design", "--starts", "1", "--criterion", "trace", "--wall-mm", "2", "--radius-mm", "4", "5"];
    assert_accepted("design_thick.txt", &folder.succeed(&thick));
    for (gauges, layout, expected) in
        [("5", "rosettes", 6), ("4", "rosettes", 6), ("9", "rosettes", 10), ("7", "paper", 6)]
    {
        let error = folder.fail(1, &["design", "--gauges", gauges, "--layout", layout]);
        assert!(error.contains(&format!("gauges: {gauges} given, {expected} needed")), "{error}");
    }
}

#[test]
fn of_the_demo() {
    let folder = Folder::new();
    let said = folder.succeed(&["demo", "--seed", "5"]);
    assert_accepted("demo.txt", &said);
    let report = folder.read("report.html");
    let figure =
        report.split("<figure>").find(|figure| figure.contains("Position error against load")).unwrap();
    assert_accepted("demo_errors.html", &without_curves(&format!("</style>{figure}")));
}

#[test]
fn of_a_calibration_that_is_mended() {
    let random = &mut Pcg64Mcg::seed_from_u64(12);
    let folder = Folder::new();
    folder.write("loads.csv", &noisy_loads());
    folder.succeed(&[&["calibrate", "loads.csv", "-o", "cal.toml"][..], &FULL].concat());
    // The sensor of `loads`, of which gauge 2 has become 4 % stronger, touched on a sphere of 10 mm.
    let mut touches = String::from("v1_V,v2_V,v3_V,v4_V,v5_V,v6_V\n");
    for _ in 0..80 {
        let (normal, force) = (direction(random), direction(random) * 5.0);
        let torque = (normal * 0.01).cross(&force);
        let share: [f64; 6] =
            core::array::from_fn(|i| if i < 3 { force[i] / 10.0 } else { torque[i - 3] / 0.1 });
        let volts: Vec<String> = (0..6)
            .map(|i| {
                let gain = if i == 1 { 1.04 } else { 1.0 };
                format!("{:.9}", 0.1 + gain * (2.0 * share[i] + 0.2 * share[(i + 1) % 6]))
            })
            .collect();
        touches += &format!("{}\n", volts.join(","));
    }
    folder.write("touches.csv", &noisy(&touches, &["v"], 1e-3));
    // How far the touches disagree with the calibration; what they alone can mend is too little to be printed here.
    let said = folder.succeed(&["refine", "cal.toml", "touches.csv"]);
    let head: String = said.lines().take(2).map(|line| format!("{line}\n")).collect();
    assert_accepted("refine.txt", &head);
    let mend = ["refine", "cal.toml", "touches.csv", "--loads", "loads.csv", "-o", "mended.toml"];
    assert_accepted("refine_with_loads.txt", &folder.succeed(&mend));
    let mended = folder.read("mended.toml");
    assert!(
        mended.contains("; refined by point contacts\"") && mended.contains("verdict = \"unchecked\""),
        "{mended}"
    );
    for (from, to, expected) in
        [("_V", "_counts", "another unit than the calibration"), (",v6_V", ",dummy_V", "gauges")]
    {
        folder.write("other.csv", &touches.replace(from, to));
        let error = folder.fail(1, &["refine", "cal.toml", "other.csv"]);
        assert!(error.contains("other.csv") && error.contains(expected), "{error}");
    }
    for (from, to) in [("_V", "_counts"), ("fx_N", "mood")] {
        folder.write("other.csv", &noisy_loads().replace(from, to));
        let error = folder.fail(1, &["refine", "cal.toml", "touches.csv", "--loads", "other.csv"]);
        assert!(error.contains("other.csv: it has other axes, gauges or units"), "{error}");
    }
    folder.write("forces.csv", "fx_N,fy_N,fz_N,v1_V,v2_V,v3_V\n1,0,0,1,0,0\n0,1,0,0,1,0\n0,0,1,0,0,1\n0,0,0,0,0,0\n-1,0,0,-1,0,0\n0,-1,0,0,-1,0\n");
    folder.succeed(&["calibrate", "forces.csv", "-o", "forces.toml", "--accept-bad"]);
    let error = folder.fail(1, &["refine", "forces.toml", "touches.csv"]);
    assert!(error.contains("only a linear calibration of six components"), "{error}");
}
