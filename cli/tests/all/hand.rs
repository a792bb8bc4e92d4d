//! `fingertip analyze` with a hand scene.

use fingertip_test_support::recording;

use crate::common::{Contacts, Folder, assert_accepted, body, scene};

const SPHERE: &str = r#"
version = 1
[input]
convention = "on_fingertip"
sample_rate_Hz = 100.0
[surface]
shape = "sphere"
radius_m = 0.01
[contact]
least_force_N = 0.05
"#;

/// Two fingertips, of which the left one presses along +x and the right one along −x, each in its own frame along +z.
const HAND: &str = r#"
version = 1
name = "Two tips"
[hand]
safety = 1.25
[[finger]]
name = "left"
scene = "tip.toml"
sensor = "L"
translation_m = [-0.03, 0.0, 0.0]
rotation_deg = [0.0, 90.0, 0.0]
friction = 0.5
greatest_normal_N = 10.0
[[finger]]
name = "right"
scene = "tip.toml"
sensor = "R"
translation_m = [0.03, 0.0, 0.0]
rotation_deg = [0.0, -90.0, 0.0]
friction = 0.5
greatest_normal_N = 10.0
"#;

const HEADER: &str =
    "L_Fx_N,L_Fy_N,L_Fz_N,L_Tx_Nm,L_Ty_Nm,L_Tz_Nm,R_Fx_N,R_Fy_N,R_Fz_N,R_Tx_Nm,R_Ty_Nm,R_Tz_Nm";

/// The object presses each tip by `normal` at its top, and hangs on them by `weight` along y (both frames keep y).
fn row(normal: f64, weight: f64) -> String {
    let half = -0.5 * weight;
    // At (0, 0, 1 cm): the torque is point × force.
    let one = format!("0,{half},{},{},0,0", -normal, -0.01 * half);
    format!("{one},{one}")
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("tip.toml", SPHERE);
    folder.write("hand.toml", HAND);
    folder
}

/// A mesh of a million triangles is not built for each finger.
#[test]
fn a_scene_of_several_fingers_is_read_once() {
    let folder = folder();
    folder.write("grip.csv", &format!("{HEADER}\n{}\n", row(4.0, 2.0)));
    let output = folder.run(&[
        "analyze",
        "grip.csv",
        "--scene",
        "hand.toml",
        "--output",
        "grasp.csv",
        "--no-report",
        "-v",
    ]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(said.matches("reads scene").count(), 1, "{said}");
    assert_eq!(Contacts::parse(&folder.read("grasp.csv")).words("right_status"), ["contact"]);
}

#[test]
fn two_fingertips_are_one_grasp() {
    let folder = folder();
    let rows = [row(4.0, 2.0), row(1.5, 2.0), row(6.0, 30.0), row(0.0, 0.0), row(9.5, 9.0)];
    folder.write("grip.csv", &format!("{HEADER}\n{}\n", rows.join("\n")));
    let text = folder.succeed(&["analyze", "grip.csv", "--scene", "hand.toml", "--output", "grasp.csv"]);
    assert!(text.contains("Two tips in grip.csv"), "{text}");
    let grasp = Contacts::parse(&folder.read("grasp.csv"));
    assert_eq!(grasp.len(), 5);
    let at = |name: &str| grasp.numbers(name);
    let close = |a: f64, b: f64| (a - b).abs() < 1e-4 * (1.0 + b.abs());
    assert_eq!(grasp.words("left_status"), ["contact", "contact", "contact", "below_threshold", "contact"]);
    // The contacts are 2 cm from the middle, on either side.
    assert!(close(at("left_x_m")[0], -0.02) && close(at("right_x_m")[0], 0.02), "{:?}", at("left_x_m"));
    // The load is the weight alone: what squeezes cancels.
    assert!(
        close(at("load_fx_N")[0], 0.0) && close(at("load_fy_N")[0], -2.0) && close(at("load_fz_N")[0], 0.0)
    );
    assert!(close(at("load_tx_Nm")[0], 0.0) && close(at("load_tz_Nm")[0], 0.0));
    assert!(close(at("grip_N")[0], 8.0) && close(at("squeeze_N")[0], 8.0));
    // One newton at each, friction 0.5 with a safety of 1.25: 2.5 N each.
    assert!(close(at("least_grip_N")[0], 5.0) && close(at("left_least_normal_N")[0], 2.5));
    // Coulomb's margin, the distance from the cone: (μ n − t)/√(1 + μ²).
    let margin = |normal: f64| (0.5 * normal - 1.0) / 1.25_f64.sqrt();
    assert!(
        close(at("margin_N")[0], margin(4.0)) && close(at("margin_N")[1], margin(1.5)),
        "{:?}",
        at("margin_N")
    );
    // Fingers of ten newtons carry 8 N with this safety, and 10 N without.
    assert_eq!(grasp.words("held"), ["held", "held", "cannot_hold", "", "without_safety"]);
    assert!(close(at("least_grip_N")[4], 18.0) && close(at("left_least_normal_N")[4], 9.0));
    assert!(
        text.contains("in 1 of the rows that hold, the load is held without the factor of safety"),
        "{text}"
    );
    let report = folder.read("report.html");
    assert!(report.contains("Grip, and the least that holds") && !report.contains("NaN"));
}

#[test]
fn rows_that_lack_a_sensor_are_counted_on_the_page() {
    let folder = folder();
    let blank = row(4.0, 2.0).rsplit_once(',').unwrap().0.to_owned() + ",";
    for (rows, said) in [
        (
            vec![row(4.0, 2.0), blank.clone(), blank],
            Some("2 rows are rest or repeat the row before, or lack a sensor"),
        ),
        (vec![row(4.0, 2.0), row(4.1, 2.0), row(4.2, 2.0)], None),
    ] {
        folder.write("grip.csv", &format!("{HEADER}\n{}\n", rows.join("\n")));
        folder.succeed(&["analyze", "grip.csv", "--scene", "hand.toml", "--output", "grasp.csv"]);
        let report = folder.read("report.html");
        assert_eq!(report.contains("lack a sensor or a pose"), said.is_some());
        assert!(said.is_none_or(|said| report.contains(said)));
    }
}

/// A finger that shall press by no less than so much does in the least grip, and one that cannot is told.
#[test]
fn the_least_grip_keeps_the_limits_of_the_fingers() {
    let folder = folder();
    let most = "greatest_normal_N = 10.0";
    let with = |limits: &str| HAND.replace(most, limits);
    folder.write("firm.toml", &with(&format!("{most}\nleast_normal_N = 4.0")));
    folder.write("grip.csv", &format!("{HEADER}\n{}\n", row(4.0, 2.0)));
    folder.succeed(&["analyze", "grip.csv", "--scene", "firm.toml", "--output", "grasp.csv"]);
    let grasp = Contacts::parse(&folder.read("grasp.csv"));
    // 2.5 N each would do for the load.
    for (column, expected) in
        [("least_grip_N", 8.0), ("left_least_normal_N", 4.0), ("right_least_normal_N", 4.0)]
    {
        assert!((grasp.numbers(column)[0] - expected).abs() < 1e-3, "{column}: {:?}", grasp.numbers(column));
    }
    for (limits, key) in [
        ("least_normal_N = -1.0".to_owned(), "least_normal_N"),
        ("greatest_normal_N = 0.0".to_owned(), "greatest_normal_N"),
        (format!("{most}\nleast_normal_N = 11.0"), "least_normal_N"),
    ] {
        folder.write("bad.toml", &with(&limits));
        let text = folder.fail(1, &["analyze", "grip.csv", "--scene", "bad.toml", "--overwrite"]);
        assert!(text.contains(&format!("`{key}`: ")), "{text}");
    }
}

/// The right finger reads 15 N that cannot be: more friction than there is, or a force that passes it by. What the left one
/// is to bear is not known then; what is felt is told all the same.
#[test]
fn a_finger_that_reads_what_cannot_be_makes_a_row_doubtful() {
    let folder = folder();
    let left = row(4.0, 2.0).split(',').take(6).collect::<Vec<_>>().join(",");
    let rows = [
        row(4.0, 2.0),
        // At its top, 15 N across and 4 N down: a ratio of 3.75.
        format!("{left},0,15,-4,-0.15,0,0"),
        // 5 cm beside it.
        format!("{left},0,0,-15,0.75,0,0"),
    ];
    folder.write("grip.csv", &format!("{HEADER}\n{}\n", rows.join("\n")));
    let text = folder.succeed(&["analyze", "grip.csv", "--scene", "hand.toml", "--output", "grasp.csv"]);
    let grasp = Contacts::parse(&folder.read("grasp.csv"));
    assert_eq!(grasp.words("held"), ["held", "doubtful", "doubtful"]);
    assert!(grasp.numbers("least_grip_N").iter().skip(1).all(|least| least.is_nan()));
    assert!((grasp.numbers("load_fx_N")[2] - (15.0 - 4.0)).abs() < 1e-4, "{:?}", grasp.numbers("load_fx_N"));
    assert!(text.contains("2 rows are doubtful"), "{text}");
    // As much friction as a scene allows is believed.
    folder.write("rough.toml", &HAND.replace("[hand]", "[hand]\ngreatest_ratio = 4.0"));
    folder.succeed(&["analyze", "grip.csv", "--scene", "rough.toml", "--output", "rough.csv", "--overwrite"]);
    let rough = Contacts::parse(&folder.read("rough.csv"));
    assert_eq!(rough.words("held"), ["held", "cannot_hold", "doubtful"]);
}

/// Hinges along z, 8 cm beside the fingers, so that a newton of normal force is 0.08 N·m: fixed, and in columns. What hangs
/// on the fingers along y passes their axes at 2 cm.
#[test]
fn joints_limit_the_least_grip_and_costs_share_it() {
    let folder = folder();
    let most = "greatest_normal_N = 10.0";
    let jointed = |torque: f64, jacobian: &str| {
        HAND.replace(most, &format!("greatest_torques_Nm = [{torque}, 1.0]\n{jacobian}"))
    };
    let fixed = "jacobian = [[0.08, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]]";
    // A newton at each with friction 0.4: 2.5 N, of which the weight bears a part.
    let needed = 0.08 * 2.5 - 0.02;
    let names =
        |joint: u32| ["vx", "vy", "vz", "wx", "wy", "wz"].map(|part| format!("J_{joint}_{part}")).join(",");
    let numbers = "0.08,0,0,0,0,1,0,0,0,1,0,0";
    // The second row lacks a number of the Jacobian.
    let rows = [
        format!("{},{numbers}", row(4.0, 2.0)),
        format!("{},{}", row(4.1, 2.0), numbers.replacen("0.08", "", 1)),
    ];
    folder.write("grip.csv", &format!("{HEADER},{},{}\n{}\n", names(1), names(2), rows.join("\n")));
    for (torque, held) in
        [(needed * 1.02, "held"), (needed * 0.9, "without_safety"), (needed * 0.7, "cannot_hold")]
    {
        for (jacobian, second) in [(fixed, held), ("jacobian_columns = \"J\"", "")] {
            folder.write("jointed.toml", &jointed(torque, jacobian));
            folder.succeed(&[
                "analyze",
                "grip.csv",
                "--scene",
                "jointed.toml",
                "--output",
                "grasp.csv",
                "--overwrite",
            ]);
            let grasp = Contacts::parse(&folder.read("grasp.csv"));
            assert_eq!(grasp.words("held"), [held, second], "{torque} {jacobian}");
            if held == "held" {
                assert!((grasp.numbers("least_grip_N")[0] - 5.0).abs() < 1e-3);
            }
        }
    }
    // A third finger at the place of the left one, which is dear, is spared: the two others bear it all.
    let third = HAND.replace("name = \"Two tips\"", "name = \"Three tips\"")
        + "\n[[finger]]\nname = \"dear\"\nscene = \"tip.toml\"\nsensor = \"L\"\ntranslation_m = [-0.03, 0.0, 0.0]\n\
           rotation_deg = [0.0, 90.0, 0.0]\nfriction = 0.5\ncost = 3.0\n";
    folder.write("dear.toml", &third);
    folder.succeed(&["analyze", "grip.csv", "--scene", "dear.toml", "--output", "dear.csv", "--overwrite"]);
    let dear = Contacts::parse(&folder.read("dear.csv"));
    let (left, spared) = (dear.numbers("left_least_normal_N")[0], dear.numbers("dear_least_normal_N")[0]);
    assert!(spared < 0.2 * left, "{spared} beside {left}");

    for (jacobian, torques, said) in [
        (fixed, "[1.0]", "`jacobian` has 2 columns, and `greatest_torques_Nm` 1 numbers"),
        (fixed, "[1.0, -1.0]", "`jacobian`: the greatest torque of a joint must be positive"),
        ("jacobian_columns = \"J\"", "[1.0, 0.0]", "`greatest_torques_Nm`: the greatest torque of a joint"),
        ("jacobian_columns = \"J\"", "[]", "go together"),
        ("", "[1.0]", "go together"),
        ("jacobian_columns = \"J\"", "[1, 1, 1, 1, 1, 1, 1]", "has 7 numbers; a finger has 6 joints at most"),
        ("jacobian_columns = \"K\"", "[1.0]", "has no columns K_1_vx, K_1_vy"),
        (&format!("{fixed}\njacobian_columns = \"J\""), "[1.0, 1.0]", "either fixed or in columns"),
        ("cost = -1.0", "[]", "`cost`: the cost of a finger must be positive"),
    ] {
        folder
            .write("bad.toml", &HAND.replace(most, &format!("greatest_torques_Nm = {torques}\n{jacobian}")));
        let text = folder.fail(1, &["analyze", "grip.csv", "--scene", "bad.toml", "--overwrite"]);
        assert!(text.contains(said), "{said}:\n{text}");
    }
}

/// The object of 0.1 kg hangs on the fingers along y of the hand, as gravity does here; a table then bears half of it at a
/// place, and a push twists it.
#[test]
fn what_else_touches_disturbances_and_quality_are_told_where_they_are_asked_for() {
    let folder = folder();
    let asked = "[object]\nmass_kg = 0.1\ngravity_m_per_s2 = [0.0, -10.0, 0.0]\n\
        [[disturbance]]\nname = \"more\"\nforce_N = [0.0, -1.0, 0.0]\n\
        [[disturbance]]\nname = \"squeezed\"\nforce_N = [0.0, 0.0, 2.0]\ntorque_Nm = [0.0, 0.0, 0.0]\nat_m = [0.0, 0.0, 0.0]\n\
        [quality]\nlength_m = 0.02\neffort = \"each\"\nevery_s = 0.015\n";
    // Soft fingers, which bear a torque about their line.
    let soft = HAND.replace("friction = 0.5\n", "friction = 0.5\ntorque_arm_m = 0.003\n");
    folder.write("asked.toml", &format!("{soft}{asked}"));
    let line = |time: f64, row: String| format!("{time},{row},0,-10,0");
    let rows = [
        line(0.0, row(4.0, 1.0)),
        // What bears half of it: 0.5 N less.
        line(0.01, row(4.0, 0.5)),
        // Nothing is felt at all, so that all of the weight is borne by others.
        line(0.02, row(0.0, 0.0)),
    ];
    let header = format!("t_s,{HEADER},g_x_m_per_s2,g_y_m_per_s2,g_z_m_per_s2");
    folder.write("grip.csv", &format!("{header}\n{}\n", rows.join("\n")));
    let said = folder.succeed(&["analyze", "grip.csv", "--scene", "asked.toml", "--output", "grasp.csv"]);
    for words in ["what else touches: its force", "reach: times more", "ball that 1 N of effort surely bears"]
    {
        assert!(said.contains(words), "{said}");
    }
    let grasp = Contacts::parse(&folder.read("grasp.csv"));
    let at = |name: &str| grasp.numbers(name);
    let close = |a: f64, b: f64| (a - b).abs() < 1e-4 * (1.0 + b.abs());
    for (row, expected) in [0.0, 0.5, 1.0].into_iter().enumerate() {
        assert!(close(at("other_fy_N")[row], expected), "{:?}", at("other_fy_N"));
        assert!(close(at("other_fx_N")[row], 0.0) && close(at("other_tz_Nm")[row], 0.0));
    }
    // Half of the weight at the middle: a line along y through the origin.
    for (name, expected) in [("x_m", 0.0), ("z_m", 0.0), ("dy", 1.0), ("dx", 0.0), ("pitch_m", 0.0)] {
        assert!(
            close(at(&format!("other_{name}"))[1], expected),
            "{name}: {:?}",
            at(&format!("other_{name}"))
        );
    }
    // Fingers of 10 N with friction 0.5 over 1.25 carry 8 N.
    assert!(close(at("reach_more")[0], 7.0) && close(at("reach_more")[1], 7.5), "{:?}", at("reach_more"));
    let aside = (64.0_f64 - 1.0).sqrt() / 2.0;
    assert!(close(at("reach_squeezed")[0], aside), "{:?}", at("reach_squeezed"));
    assert!(at("reach_more")[2].is_nan() && at("reach_squeezed")[2].is_nan());
    // What is borne least is a torque about the line of the fingers, 2·μ·e/length; 10 ms later it is not looked at.
    assert_eq!(grasp.words("closure"), ["yes", "", ""]);
    let expected = 2.0 * 0.4 * 0.003 / 0.02;
    assert!((at("ball_found_N")[0] - expected).abs() < 1e-3 && at("ball_N")[0] <= at("ball_found_N")[0]);
    assert!(at("ball_N")[0] > 0.0 && at("ball_N")[1].is_nan());
    assert!((at("weakest_tx_Nm")[0].abs() - 0.02).abs() < 1e-3, "{:?}", at("weakest_tx_Nm"));

    // Gravity in columns says the same; without limits there is no end of what squeezes.
    let columns = asked.replace("gravity_m_per_s2 = [0.0, -10.0, 0.0]", "gravity_columns = \"g\"");
    // As often as there are samples: each is looked at.
    let columns = columns.replace("every_s = 0.015", "every_s = 0.01");
    folder.write("columns.toml", &format!("{}{columns}", soft.replace("greatest_normal_N = 10.0\n", "")));
    folder.succeed(&[
        "analyze",
        "grip.csv",
        "--scene",
        "columns.toml",
        "--output",
        "columns.csv",
        "--overwrite",
    ]);
    let columns = Contacts::parse(&folder.read("columns.csv"));
    assert_eq!(columns.words("closure"), ["yes", "yes", ""]);
    assert_eq!(columns.numbers("other_fy_N")[..2], at("other_fy_N")[..2]);
    assert_eq!(columns.words("reach_more"), ["inf", "inf", ""]);
    // A twisted push: torque along the line over force.
    let more = row(4.0, 1.0).split(',').map(|x| x.parse::<f64>().unwrap()).collect::<Vec<_>>();
    let mut twisted = more.clone();
    twisted[1] -= 1.0;
    twisted[3] += 0.01;
    twisted[4] -= 0.004;
    let text = twisted.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    folder.write("twisted.csv", &format!("{header}\n{}\n", line(0.0, text)));
    folder.succeed(&[
        "analyze",
        "twisted.csv",
        "--scene",
        "asked.toml",
        "--output",
        "twisted_grasp.csv",
        "--overwrite",
    ]);
    let twisted = Contacts::parse(&folder.read("twisted_grasp.csv"));
    assert!(close(twisted.numbers("other_fy_N")[0], -1.0), "{:?}", twisted.numbers("other_fy_N"));
    assert!(close(twisted.numbers("other_pitch_m")[0], 0.004), "{:?}", twisted.numbers("other_pitch_m"));

    for (from, to, said) in [
        ("mass_kg = 0.1", "mass_kg = -1.0", "mass_kg = -1 of [object] must be positive"),
        ("mass_kg = 0.1", "mass_kg = 0.1\ngravity_columns = \"g\"", "either fixed or in columns"),
        ("gravity_m_per_s2 = [0.0, -10.0, 0.0]", "gravity_columns = \"h\"", "has no columns h_x_m_per_s2"),
        ("name = \"squeezed\"", "name = \"more\"", "another one has this name"),
        ("name = \"more\"", "name = \"a,b\"", "letters, digits and _"),
        ("force_N = [0.0, 0.0, 2.0]", "", "must be other than zero"),
        ("length_m = 0.02", "length_m = 0.0", "length_m = 0 of [quality] must be positive"),
        ("every_s = 0.015", "every_s = -1.0", "every_s = -1 of [quality] must be finite"),
        ("effort = \"each\"", "effort = \"none\"", "effort"),
        ("mass_kg = 0.1", "mass_kg = 0.1\ncolour = 1", "colour"),
        ("mass_kg = 0.1", "mass_kg = inf", "mass_kg = inf of [object] must be positive and finite"),
        ("mass_kg = 0.1", "mass_kg = 0.1\ncentre_m = [0.0, nan, 0.0]", "of [object] must be finite"),
        ("[0.0, -10.0, 0.0]", "[0.0, -inf, 0.0]", "of [object] must be finite"),
        ("force_N = [0.0, -1.0, 0.0]", "force_N = [0.0, nan, 0.0]", "and all finite"),
        ("length_m = 0.02", "length_m = inf", "length_m = inf of [quality] must be positive and finite"),
        ("every_s = 0.015", "every_s = inf", "every_s = inf of [quality] must be finite"),
    ] {
        folder.write("bad.toml", &format!("{soft}{}", asked.replacen(from, to, 1)));
        let text = folder.fail(1, &["analyze", "grip.csv", "--scene", "bad.toml", "--overwrite"]);
        assert!(text.contains(said), "{said}:\n{text}");
    }
}

/// What lies between two times is told, and where nothing does, why.
#[test]
fn a_part_of_a_grasp_is_analysed() {
    let folder = folder();
    let rows =
        |of: &[f64]| -> String { of.iter().map(|time| format!("{time},{}\n", row(4.0, 2.0))).collect() };
    let times = [5.0, 6.0, 7.0, 8.0, 9.0];
    folder.write("grip.csv", &format!("t_s,{HEADER}\n{}", rows(&times)));
    let analyze = ["analyze", "grip.csv", "--scene", "hand.toml", "--output", "grasp.csv", "--overwrite"];
    for (part, expected) in [
        (&[][..], &times[..]),
        (&["--start", "1", "--end", "3"], &times[1..4]),
        (&["--start", "3"], &times[3..]),
        (&["--end", "0"], &times[..1]),
    ] {
        let said = folder.succeed(&[&analyze[..], part].concat());
        let grasp = Contacts::parse(&folder.read("grasp.csv"));
        assert_eq!(grasp.numbers("t_s"), expected, "{part:?}");
        assert_eq!(said.contains("only what was recorded"), !part.is_empty(), "{said}");
    }
    let rest = SPHERE.replace("[input]\n", "[input]\nrest_s = 2.5\n");
    for (scene, rows, part, says) in [
        (SPHERE, rows(&times), &["--start", "9"][..], "--start 9 must be before the end of the recording"),
        (
            SPHERE,
            rows(&times),
            &["--start", "1.2", "--end", "1.8"],
            "--start 1.2 has no row between itself and",
        ),
        (SPHERE, String::new(), &["--start", "1"], "grip.csv has a header but no rows"),
        (SPHERE, String::new(), &[], "grip.csv has a header but no rows"),
        (&rest, rows(&times), &["--end", "1"], "--end 1 must be behind `rest_s` of the scene"),
        (
            &rest,
            rows(&times[..2]),
            &[],
            "grip.csv ends within the 2.5 s of rest that the scene states (2 rows)",
        ),
    ] {
        folder.write("tip.toml", scene);
        folder.write("grip.csv", &format!("t_s,{HEADER}\n{rows}"));
        let error = folder.fail(1, &[&analyze[..], part].concat());
        assert!(error.contains(says), "{says}:\n{error}");
    }
}

/// Of what was before samples that are missing a filter knows nothing, at each finger.
#[test]
fn the_filters_of_the_fingers_begin_anew_behind_a_gap() {
    let folder = folder();
    let filtered = SPHERE
        .replace("version = 1", "version = 2")
        .replace("[surface]", "[filter]\nkind = \"low_pass\"\ncutoff_Hz = 1.0\n[surface]");
    folder.write("tip.toml", &filtered);
    let grip_behind = |pause: f64| {
        let rows = (0..60_u32).map(|k| {
            let (normal, late) = if k < 50 { (6.0, 0.0) } else { (2.0, pause) };
            format!("{},{}\n", 0.01 * f64::from(k) + late, row(normal, 1.0))
        });
        folder.write("grip.csv", &format!("t_s,{HEADER}\n{}", rows.collect::<String>()));
        folder.succeed(&[
            "analyze",
            "grip.csv",
            "--scene",
            "hand.toml",
            "--output",
            "grasp.csv",
            "--no-report",
        ]);
        Contacts::parse(&folder.read("grasp.csv")).numbers("grip_N")[50]
    };
    assert!(grip_behind(0.0) > 8.0);
    assert!((grip_behind(0.2) - 4.0).abs() < 1e-6);
}

#[test]
fn poses_can_be_in_columns_and_sensors_in_the_object() {
    let folder = folder();
    let half = core::f64::consts::FRAC_1_SQRT_2;
    let fixed = "translation_m = [-0.03, 0.0, 0.0]\nrotation_deg = [0.0, 90.0, 0.0]";
    folder.write("moving.toml", &HAND.replace(fixed, "pose_columns = \"left\""));
    let pose = "left_x_m,left_y_m,left_z_m,left_qw,left_qx,left_qy,left_qz";
    // The second row has no pose of the left one.
    let rows = [
        format!("{},-0.03,0,0,{half},0,{half},0", row(4.0, 2.0)),
        format!("{},-0.03,0,0,0,0,0,0", row(4.0, 2.0)),
    ];
    folder.write("grip.csv", &format!("{HEADER},{pose}\n{}\n", rows.join("\n")));
    folder.succeed(&["analyze", "grip.csv", "--scene", "moving.toml", "--output", "moving.csv"]);
    folder.succeed(&["analyze", "grip.csv", "--scene", "hand.toml", "--output", "fixed.csv", "--overwrite"]);
    let (moving, fixed) =
        (Contacts::parse(&folder.read("moving.csv")), Contacts::parse(&folder.read("fixed.csv")));
    // The quaternion and the rotation vector are the same turn, to rounding.
    for column in ["left_x_m", "left_z_m", "load_fx_N", "load_fy_N", "load_tx_Nm", "least_grip_N", "margin_N"]
    {
        let (moving, fixed) = (moving.numbers(column)[0], fixed.numbers(column)[0]);
        assert!((moving - fixed).abs() < 1e-6, "{column}: {moving} and {fixed}");
    }
    assert_eq!(moving.words("left_status"), ["contact", "unusable_row"]);
    assert_eq!(moving.words("held"), ["held", ""]);

    // The same wrenches on pads of an object that is held from outside: the load is the opposite.
    let object = HAND.replace("[hand]", "[hand]\nsensors_in = \"object\"");
    folder.write("object.toml", &object);
    folder.succeed(&[
        "analyze",
        "grip.csv",
        "--scene",
        "object.toml",
        "--output",
        "object.csv",
        "--overwrite",
    ]);
    let object = Contacts::parse(&folder.read("object.csv"));
    assert!((object.numbers("load_fy_N")[0] - 2.0).abs() < 1e-5);
    assert!((object.numbers("squeeze_N")[0] - 8.0).abs() < 1e-4);
    assert_eq!(object.words("held")[0], "held");
}

#[test]
fn what_is_wrong_with_a_hand_scene_is_said_with_its_mend() {
    let folder = folder();
    folder.write("grip.csv", &format!("{HEADER}\n{}\n", row(4.0, 2.0)));
    for (from, to, said) in [
        ("version = 1\n", "version = 7\n", "hand scenes of version 1"),
        ("safety = 1.25", "safety = 0.5", "safety = 0.5 of [hand] must be at least 1"),
        ("safety = 1.25", "greatest_ratio = 0.0", "greatest_ratio = 0 of [hand] must be positive"),
        ("name = \"right\"", "name = \"left\"", "another finger has this name"),
        ("name = \"right\"", "name = \"a,b\"", "letters, digits and _"),
        ("friction = 0.5\n", "", "neither `friction` here nor [friction]"),
        ("friction = 0.5", "friction = -1.0", "`friction` must be positive"),
        ("sensor = \"R\"", "sensor = \"R\"\npose_columns = \"right\"", "either fixed or in columns"),
        ("sensor = \"L\"", "sensor = \"L\"\ncolour = \"red\"", "colour"),
        ("sensor = \"R\"", "sensor = \"Q\"", "Q"),
        ("scene = \"tip.toml\"", "scene = \"none.toml\"", "none.toml"),
    ] {
        folder.write("bad.toml", &HAND.replace(from, to));
        let text = folder.fail(1, &["analyze", "grip.csv", "--scene", "bad.toml"]);
        assert!(text.contains(said), "{said}:\n{text}");
    }
    for (option, said) in [
        (
            &["--sensor", "L"][..],
            "--sensor L is said for each finger by a hand scene: set `sensor` of [[finger]]",
        ),
        (
            &["--calibration", "c.toml"],
            "--calibration c.toml is said for each finger by a hand scene: put it into",
        ),
        (&["--payload", "p.toml"], "--payload p.toml is said for each finger by a hand scene: put it into"),
        (&["--json"], "is not there for a hand scene yet: read the table that --output names"),
        (&["--start", "2", "--end", "1"], "--end 1 must not be before --start"),
    ] {
        let text = folder.fail(1, &[&["analyze", "grip.csv", "--scene", "hand.toml"][..], option].concat());
        assert!(text.contains(said), "{said}:\n{text}");
    }
    assert!(!folder.path("contacts.csv").exists());
}

/// A session of a hand of which all numbers are known: the summary as somebody has looked at it, its counts and
/// quantiles from the formula, and the page.
#[test]
fn a_grasp_is_summed_up_in_words_tables_and_pictures() {
    let folder = folder();
    // Normal forces of 2.02 N to 4 N, and a weight of 1 N; then one row without a touch, and one of 6 N that hangs too much.
    let mut rows: Vec<String> = (1..=100)
        .map(|k| format!("{},{}", 0.01 * f64::from(k), row(2.0 + 0.02 * f64::from(k), 1.0)))
        .collect();
    rows.push(format!("1.01,{}", row(0.0, 0.0)));
    rows.push(format!("1.02,{}", row(6.0, 30.0)));
    folder.write("grip.csv", &format!("t_s,{HEADER}\n{}\n", rows.join("\n")));
    let said = folder.succeed(&["analyze", "grip.csv", "--scene", "hand.toml", "--output", "grasp.csv"]);
    assert_accepted("hand_summary.txt", &said);
    assert_accepted("hand_report.html", &body(&folder.read("report.html")));
    let line = |start: &str| {
        let line = said
            .lines()
            .find(|line| line.trim_start().starts_with(start))
            .unwrap_or_else(|| panic!("{said}"));
        line.split_whitespace().filter_map(|word| word.parse::<f64>().ok()).collect::<Vec<_>>()
    };
    // Grips are twice the normal forces, and their quantiles; of both the last row is the greatest.
    for (found, expected) in line("grip").iter().zip([4.2, 6.0, 7.9, 12.0]) {
        assert!((found - expected).abs() < 0.05 * expected, "{said}");
    }
    // 0.5 N at each, friction 0.5 with a safety of 1.25: 1.25 N each.
    assert!(line("least grip").iter().all(|least| (least - 2.5).abs() < 0.05), "{said}");
    assert!(line("load").iter().zip([1.0, 1.0, 1.0, 30.0]).all(|(a, b)| (a - b).abs() < 0.02 * b), "{said}");
}

#[test]
fn two_real_pads_are_one_grasp() {
    let Some(recording) = recording("nano17_three_finger/roll.csv") else { return };
    let recording = recording.display().to_string();
    let folder = Folder::new();
    let hand = scene("../hands/two_pads.toml");
    folder.succeed(&["analyze", &recording, "--scene", &hand, "--output", "grasp.csv"]);
    let grasp = Contacts::parse(&folder.read("grasp.csv"));
    assert_eq!(grasp.len(), 1602);
    let (thumb, ring) = (grasp.words("thumb_status"), grasp.words("ring_status"));
    let both: Vec<usize> =
        (0..grasp.len()).filter(|row| thumb[*row] == "contact" && ring[*row] == "contact").collect();
    assert!(both.len() > 1200, "{}", both.len());
    let at = |name: &str| grasp.numbers(name);
    let (grip, squeeze, first, second) =
        (at("grip_N"), at("squeeze_N"), at("thumb_normal_N"), at("ring_normal_N"));
    for row in &both {
        assert!((grip[*row] - first[*row] - second[*row]).abs() < 1e-4, "row {row}");
        // Pads that are opposite squeeze by no more than they press.
        assert!(squeeze[*row] <= grip[*row] * 1.05 + 0.05, "row {row}: {} of {}", squeeze[*row], grip[*row]);
    }
    // The places are on the cylinder of 40 mm, opposite to each other.
    let radius = |x: &str, z: &str, row: usize| at(x)[row].hypot(at(z)[row]);
    for row in both.iter().step_by(100) {
        assert!((radius("thumb_x_m", "thumb_z_m", *row) - 0.04).abs() < 1e-6);
        assert!(at("thumb_z_m")[*row] > 0.0 && at("ring_z_m")[*row] < 0.0);
    }
}
