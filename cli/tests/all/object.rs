//! `fingertip object`: objects by touches with poses.

use crate::common::Folder;

const TIP: &str = r#"
version = 2
name = "ball tip"
[input]
convention = "on_fingertip"
sample_rate_Hz = 100.0
[surface]
shape = "sphere"
radius_m = 0.013
[contact]
least_force_N = 0.1
[uncertainty]
force_noise_N = 0.01
torque_noise_Nm = 0.0001
"#;

const HEADER: &str =
    "time_s,Fx_N,Fy_N,Fz_N,Tx_Nm,Ty_Nm,Tz_Nm,pose_x_m,pose_y_m,pose_z_m,pose_qw,pose_qx,pose_qy,pose_qz";
const CENTRE: [f64; 3] = [0.2, -0.1, 0.4];
const TIP_RADIUS: f64 = 0.013;

fn cross([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// Turns a vector by the inverse of a quaternion of unit length.
fn turned_back([w, x, y, z]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let axis = [-x, -y, -z];
    let t = cross(axis, v).map(|t| 2.0 * t);
    let u = cross(axis, t);
    core::array::from_fn(|i| v[i] + w * t[i] + u[i])
}

/// Forty touches of an object, five rows each and one between them without force: for each, where its surface is and its outward
/// normal there.
fn touches(of: impl Fn(f64, f64) -> ([f64; 3], [f64; 3]), noise: f64) -> String {
    let mut rows = vec![HEADER.to_owned()];
    for i in 0..40_u8 {
        let i = f64::from(i);
        let (along, round) = ((i + 0.5) / 40.0, 2.399_963 * i);
        let (at, n) = of(along, round);
        // The tip is turned otherwise at every touch.
        let q = [(0.3 * i).cos(), 0.6 * (0.3 * i).sin(), 0.0, 0.8 * (0.3 * i).sin()];
        let origin: [f64; 3] = core::array::from_fn(|k| at[k] + TIP_RADIUS * n[k]);
        let inward = turned_back(q, n);
        for j in 0..5_u8 {
            let wrong = |k: f64| noise * (7.0 * k + 13.0 * i + 29.0 * f64::from(j)).sin();
            let force = inward.map(|x| 2.0 * x);
            let place = inward.map(|x| -TIP_RADIUS * x);
            let torque = cross(place, force);
            let torque: [f64; 3] = core::array::from_fn(|k| torque[k] + wrong([0.0, 1.0, 2.0][k]));
            let time = 0.06 * i + 0.01 * f64::from(j);
            let numbers = [&[time][..], &force, &torque, &origin, &q].concat();
            rows.push(numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(","));
        }
        rows.push(format!(
            "{},0,0,0,0,0,0,{},{},{},1,0,0,0",
            0.06 * i + 0.05,
            origin[0],
            origin[1],
            origin[2]
        ));
    }
    rows.join("\n") + "\n"
}

fn ball(along: f64, round: f64) -> ([f64; 3], [f64; 3]) {
    let z = 1.0 - 2.0 * along;
    let r = (1.0 - z * z).sqrt();
    let n = [r * round.cos(), r * round.sin(), z];
    (core::array::from_fn(|k| CENTRE[k] + 0.03 * n[k]), n)
}

fn rod(along: f64, round: f64) -> ([f64; 3], [f64; 3]) {
    let n = [round.cos(), round.sin(), 0.0];
    ([CENTRE[0] + 0.02 * n[0], CENTRE[1] + 0.02 * n[1], CENTRE[2] + 0.2 * (along - 0.5)], n)
}

fn side(along: f64, round: f64) -> ([f64; 3], [f64; 3]) {
    let r = 0.05 * along.sqrt();
    ([CENTRE[0] + r * round.cos(), CENTRE[1] + r * round.sin(), CENTRE[2]], [0.0, 0.0, 1.0])
}

/// The numbers of the line that begins so: the value and the half width behind `±`.
fn numbers(text: &str, begin: &str) -> Vec<f64> {
    let line = text.lines().find(|line| line.starts_with(begin));
    let line = line.unwrap_or_else(|| panic!("no {begin}: {text}"));
    line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

fn folder(of: impl Fn(f64, f64) -> ([f64; 3], [f64; 3])) -> Folder {
    let folder = Folder::new();
    folder.write("tip.toml", TIP);
    folder.write("touches.csv", &touches(of, 5e-5));
    folder
}

const POSES: &str = "0.0001,0.001";

#[test]
fn a_ball_comes_back_with_its_points() {
    let folder = folder(ball);
    let command = [
        "object",
        "touches.csv",
        "--scene",
        "tip.toml",
        "--fit",
        "sphere",
        "--pose-noise",
        POSES,
        "-o",
        "p.ply",
    ];
    let text = folder.succeed(&command);
    assert!(text.contains("200 samples in contact: 40 touches"), "{text}");
    assert!(text.contains("a ball\n"), "{text}");
    let radius = numbers(&text, "radius");
    assert!((radius[0] - 30.0).abs() < radius[1] && radius[1] < 0.2, "{text}");
    let centre = numbers(&text, "centre");
    for (found, true_) in centre.iter().zip(CENTRE) {
        assert!((found - 1e3 * true_).abs() < 0.1, "{text}");
    }
    let ply = folder.read("p.ply");
    let points = ply.split_once("end_header\n").unwrap().1;
    assert_eq!(points.lines().count(), 40);
    for line in points.lines() {
        let p: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
        let d = [p[0] - CENTRE[0], p[1] - CENTRE[1], p[2] - CENTRE[2]];
        let r = d.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((r - 0.03).abs() < 1e-4, "{line}");
        // The normal is the object's, out of the ball.
        let out = (d[0] * p[3] + d[1] * p[4] + d[2] * p[5]) / r;
        assert!(out > 0.999, "{line}");
    }
    // What is there already is kept.
    let error = folder.fail(1, &command);
    assert!(error.contains("p.ply"), "{error}");
}

#[test]
fn rods_and_flat_sides_come_back() {
    let of_rod = folder(rod);
    let rod = ["object", "touches.csv", "--scene", "tip.toml", "--fit", "cylinder", "--pose-noise", POSES];
    let text = of_rod.succeed(&rod);
    let radius = numbers(&text, "radius");
    assert!(text.contains("a rod\n") && (radius[0] - 20.0).abs() < radius[1] && radius[1] < 0.2, "{text}");
    assert!(numbers(&text, "axis")[2].abs() > 0.9999, "{text}");
    let of_side = folder(side);
    let side = ["object", "touches.csv", "--scene", "tip.toml", "--fit", "plane", "--pose-noise", POSES];
    let text = of_side.succeed(&side);
    assert!(text.contains("a flat side\n") && numbers(&text, "normal")[2] > 0.9999, "{text}");
    let height = numbers(&text, "along it");
    assert!((height[0] - 400.0).abs() < height[1] + 0.1, "{text}");
    // A side is no ball: it is said that one does not fit, or none is found.
    let ball =
        ["object", "touches.csv", "--scene", "tip.toml", "--fit", "sphere", "--pose-noise", "1e-6,1e-5"];
    let output = of_rod.run(&ball);
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said);
    assert!(!output.status.success() || said.contains("another shape"), "{said}");
}

#[test]
fn what_cannot_be_done_is_said() {
    let folder = folder(ball);
    let run = |options: &[&str]| {
        folder.fail(1, &[&["object", "touches.csv", "--scene", "tip.toml"][..], options].concat())
    };
    let error = run(&["--pose", "tool"]);
    assert!(error.contains("tool_x_m") && error.contains("in the frame of the object"), "{error}");
    for noise in ["0,0.001", "0.001", "1e-4,inf", "1e-4,1e-3,1"] {
        let error = run(&["--fit", "sphere", "--pose-noise", noise]);
        assert!(error.contains("--pose-noise"), "{noise}: {error}");
    }
    for apart in ["-1", "NaN", "inf"] {
        let error = run(&[&format!("--apart={apart}")[..]]);
        assert!(error.contains("--apart"), "{apart}: {error}");
    }
    // Without a word of how sure a contact is there are points, and no fit.
    let (unsure, _) = TIP.split_once("[uncertainty]").unwrap();
    folder.write("unsure.toml", unsure);
    let command = ["object", "touches.csv", "--scene", "unsure.toml"];
    assert!(folder.succeed(&command).contains("40 touches"));
    let error = folder.fail(1, &[&command[..], &["--fit", "sphere"]].concat());
    assert!(error.contains("[uncertainty]"), "{error}");
    // Nothing pressed.
    folder.write("light.toml", &TIP.replace("least_force_N = 0.1", "least_force_N = 10.0"));
    let error = folder.fail(1, &["object", "touches.csv", "--scene", "light.toml"]);
    assert!(error.contains("nothing was touched"), "{error}");
    // The output is an input.
    let error = run(&["-o", "touches.csv"]);
    assert!(error.contains("touches.csv"), "{error}");
}

/// Samples share what the pose is off by, and are not as many touches, however they scatter.
#[test]
fn samples_at_one_pose_are_one_touch() {
    let folder = folder(ball);
    folder.write("touches.csv", &touches(ball, 2e-3));
    let text = folder.succeed(&["object", "touches.csv", "--scene", "tip.toml"]);
    assert!(text.contains("200 samples in contact: 40 touches"), "{text}");
    // A fingertip that rolls in place touches anew: 5 degrees at a lever of 13 mm are 1.1 mm.
    let rolled = |degrees: f64| {
        let half = 0.5 * degrees.to_radians();
        format!("0,0,-2,0,0,0,0,0,0,{},{},0,0", half.cos(), half.sin())
    };
    let rows: Vec<_> = (0..3_u8).map(|i| format!("0.0{i},{}", rolled(5.0 * f64::from(i)))).collect();
    folder.write("rolled.csv", &format!("{HEADER}\n{}\n", rows.join("\n")));
    for (apart, touches) in [("0.0011", 3), ("0.0012", 2), ("0.0023", 1)] {
        let command = ["object", "rolled.csv", "--scene", "tip.toml", "--apart", apart];
        let text = folder.succeed(&command);
        assert!(text.contains(&format!("3 samples in contact: {touches} touches")), "{apart}: {text}");
    }
    // Between two recordings the fingertip may have been anywhere.
    let twice = ["object", "rolled.csv", "rolled.csv", "--scene", "tip.toml", "--apart", "0.0023"];
    assert!(folder.succeed(&twice).contains("6 samples in contact: 2 touches"));
}

/// The first recording is longer than the rest that the scene states, the second ends within it.
#[test]
fn a_rest_that_does_not_end_is_told_with_the_rows_of_its_recording() {
    let folder = folder(ball);
    folder.write("tip.toml", &TIP.replace("100.0\n", "100.0\nrest_s = 0.2\n"));
    let still = |rows: u8| -> String {
        let rows = (0..rows).map(|i| format!("0.{i:02},0,0,0,0,0,0,0,0,0,1,0,0,0\n"));
        format!("{HEADER}\n") + &rows.collect::<String>()
    };
    folder.write("long.csv", &format!("{}0.4,0,0,-2,0,0,0,0,0,0,1,0,0,0\n", still(30)));
    folder.write("short.csv", &still(7));
    let command = ["object", "long.csv", "--scene", "tip.toml"];
    assert!(folder.succeed(&command).contains("1 samples in contact: 1 touches"));
    let error = folder.fail(1, &["object", "long.csv", "short.csv", "--scene", "tip.toml"]);
    let says = "short.csv ends within the 0.2 s of rest that the scene states (7 rows); shorten `rest_s`";
    assert!(error.contains(says), "{error}");
    // It is not the recording that ends too early.
    let error = folder.fail(1, &[&command[..], &["--end", "0.1"]].concat());
    assert!(error.contains("--end 0.1 must be behind `rest_s` of the scene"), "{error}");
}

#[test]
fn a_track_tells_the_places_too() {
    let folder = folder(ball);
    let tracked = format!("{TIP}[tracking]\nspeed_m_per_s = 0.01\nturns_within_s = 0.1\n");
    folder.write("tracked.toml", &tracked);
    let command =
        ["object", "touches.csv", "--scene", "tracked.toml", "--fit", "sphere", "--pose-noise", POSES];
    let text = folder.succeed(&command);
    let radius = numbers(&text, "radius");
    assert!((radius[0] - 30.0).abs() < radius[1] && radius[1] < 0.2, "{text}");
}

/// Of what was before samples that are missing a filter knows nothing: the first touch behind them is where it is.
#[test]
fn a_filter_begins_anew_behind_a_gap() {
    let folder = folder(ball);
    let filter = "version = 2\n[filter]\nkind = \"low_pass\"\ncutoff_Hz = 1.0\n";
    let (_, scene) = TIP.split_once("version = 2\n").unwrap();
    folder.write("tip.toml", &format!("{filter}{}", scene.replacen("name = \"ball tip\"\n", "", 1)));
    let last_touch = |pause: f64| -> Vec<f64> {
        // On top of the fingertip, and then at its side, elsewhere.
        let rows = (0..60_u32).map(|k| match k {
            0..50 => format!("{},0,0,-2,0,0,0,0,0,0,1,0,0,0\n", 0.01 * f64::from(k)),
            _ => format!("{},-2,0,0,0,0,0,0.1,0,0,1,0,0,0\n", 0.01 * f64::from(k) + pause),
        });
        folder.write("touches.csv", &format!("{HEADER}\n{}", rows.collect::<String>()));
        folder.succeed(&["object", "touches.csv", "--scene", "tip.toml", "-o", "p.ply", "--overwrite"]);
        let ply = folder.read("p.ply");
        ply.lines().last().unwrap().split(' ').take(3).map(|x| x.parse().unwrap()).collect()
    };
    let off = |place: &[f64]| (place[0] - 0.113).hypot(place[2]);
    assert!(off(&last_touch(0.0)) > 1e-3);
    assert!(off(&last_touch(0.2)) < 1e-8);
}

/// From within, the outward normal of the object is towards its middle.
#[test]
fn bowls_and_bores_are_told_from_balls_and_rods() {
    let within = |of: fn(f64, f64) -> ([f64; 3], [f64; 3])| {
        move |along, round| {
            let (at, n) = of(along, round);
            (at, n.map(|x| -x))
        }
    };
    for (of, fit, inside, outside, expected) in [
        (
            ball as fn(f64, f64) -> ([f64; 3], [f64; 3]),
            "sphere",
            "a bowl, touched from within\n",
            "a ball\n",
            30.0,
        ),
        (rod, "cylinder", "a bore, touched from within\n", "a rod\n", 20.0),
    ] {
        let (convex, concave) = (folder(of), folder(within(of)));
        let command = ["object", "touches.csv", "--scene", "tip.toml", "--fit", fit, "--pose-noise", POSES];
        for (folder, is, is_not) in [(convex, outside, inside), (concave, inside, outside)] {
            let text = folder.succeed(&command);
            assert!(text.contains(is) && !text.contains(is_not), "{text}");
            assert!((numbers(&text, "radius")[0] - expected).abs() < 0.2, "{text}");
            assert!(!text.contains("another shape"), "{text}");
        }
    }
}

/// A ball that is dented by up to a millimetre.
#[test]
fn touches_that_do_not_fit_are_doubted() {
    let folder = folder(|along, round| {
        let (at, n) = ball(along, round);
        let dent = 1e-3 * (7.0 * round).sin();
        (core::array::from_fn(|k| at[k] + dent * n[k]), n)
    });
    let said = |noise: &str| {
        let command = ["object", "touches.csv", "--scene", "tip.toml", "--fit", "sphere"];
        folder.succeed(&[&command[..], &["--pose-noise", noise]].concat())
    };
    let doubt = "the object is of another shape, or --pose-noise is too small";
    let (too_small, enough) = (said(POSES), said("0.001,0.01"));
    assert!(too_small.contains(doubt), "{too_small}");
    assert!(!enough.contains(doubt), "{enough}");
}
