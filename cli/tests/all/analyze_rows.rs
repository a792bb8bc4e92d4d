//! `fingertip analyze`, row by row: clocks, rests, and what is told of many slips and contacts.

use fingertip_test_support::read_back::{texts, value};

use crate::common::{Contacts, Folder};

const WRENCH: &str = "fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm";
const SCENE: &str = "version = 1\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"plane\"\n";

fn analyze(scene: &str, recording: &str, more: &[&str]) -> (Folder, std::process::Output) {
    let folder = Folder::new();
    folder.write("scene.toml", scene);
    folder.write("touch.csv", recording);
    let all = [&["analyze", "touch.csv", "--scene", "scene.toml"][..], more].concat();
    let output = folder.run(&all);
    (folder, output)
}

fn contacts(scene: &str, recording: &str) -> Contacts {
    let (folder, output) = analyze(scene, recording, &["--no-report"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Contacts::parse(&folder.read("contacts.csv"))
}

#[test]
fn rows_without_time_have_that_of_their_rate() {
    let rows = format!("{WRENCH}\n{}", "0,0,-1,0,0,0\n0,0,-2,0,0,0\n".repeat(3));
    let found = contacts(&SCENE.replace("[surface]", "sample_rate_Hz = 40.0\n[surface]"), &rows);
    assert_eq!(found.numbers("t_s"), [0.0, 0.025, 0.05, 0.075, 0.1, 0.125]);
    // A column of time goes before the rate.
    let rows = format!("t_s,{WRENCH}\n7,0,0,-1,0,0,0\n7.5,0,0,-2,0,0,0\n");
    let found = contacts(&SCENE.replace("[surface]", "sample_rate_Hz = 40.0\n[surface]"), &rows);
    assert_eq!(found.numbers("t_s"), [7.0, 7.5]);
    let (_, output) = analyze(SCENE, &rows, &["--no-report"]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("2 samples over 0.500 s"), "{said}");
}

/// A rate that the scene states is as good as a column of the same times, whatever watches for slip.
#[test]
fn a_rate_is_as_good_as_times() {
    let force = |i: u32| {
        let sticks = 0.01 * f64::from(i % 60);
        format!("{},{},-4,0,0,0", 4.0 * sticks, 0.01 * f64::from(i * i % 7))
    };
    let timed: String = (0..400).map(|i| format!("{},{}\n", 0.025 * f64::from(i), force(i))).collect();
    let timed = format!("t_s,{WRENCH}\n{timed}");
    let plain = format!("{WRENCH}\n{}", (0..400).map(|i| force(i) + "\n").collect::<String>());
    for detector in ["drop", "threshold", "likelihood_ratio", "stick_slip", "adaptive_drop"] {
        let slip = format!("[slip]\ndetector = \"{detector}\"\nnoise_N = 0.02\n");
        let scene = SCENE.replace("[surface]", "sample_rate_Hz = 40.0\n[surface]")
            + "[friction]\nstatic_coefficient = 0.5\n"
            + &slip;
        let (with, without) = (contacts(&scene, &timed), contacts(&scene, &plain));
        for column in ["t_s", "status", "slip", "normal_N"] {
            assert_eq!(with.words(column), without.words(column), "{detector}: {column}");
        }
        let seen = with.words("slip").into_iter().filter(|word| *word == "slipping").count();
        // The last one learns the falls for noise.
        assert!(seen > 0 || detector == "adaptive_drop", "{detector}");
    }
}

#[test]
fn times_are_written_to_the_nanosecond_as_far_as_they_have_one() {
    let rows: String = ["0.30000000000000004", "1.0000000014", "123456789.123456789", "1e300"]
        .map(|time| format!("{time},0,0,-1,0,0,0\n"))
        .concat();
    let found = contacts(SCENE, &format!("t_s,{WRENCH}\n{rows}"));
    assert_eq!(found.words("t_s"), ["0.3", "1.000000001", "123456789.12345679", "1e+300"]);
}

/// Forty rows of rest, the third force of which rises by `range` in all, then a push, at 100 rows a second from 5 s on.
fn rest(range: f64) -> String {
    let mut rows = format!("t_s,{WRENCH}\n");
    for i in 0..40 {
        // A row without a time neither ends the rest nor belongs to it.
        let time = if i == 20 { String::new() } else { format!("5.{i:02}") };
        rows += &format!("{time},0,0,{},0,0,0\n", range * f64::from(i) / 39.0);
    }
    rows + "5.40,0,0,-7,0,0,0\n5.41,0,0,-8,0,0,0\n"
}

#[test]
fn a_rest_ends_with_the_first_row_behind_it() {
    let scene = SCENE.replace("[surface]", "rest_s = 0.4\n[surface]");
    let found = contacts(&scene, &rest(0.0));
    let words: Vec<&str> = found.words("status");
    assert!(
        words[..40]
            .iter()
            .enumerate()
            .all(|(i, word)| *word == if i == 20 { "unusable_row" } else { "rest" })
    );
    assert_eq!(words[40..], ["contact", "contact"]);
    assert_eq!(found.numbers("normal_N")[40..], [7.0, 8.0]);
    // Less than two rows are no rest.
    let (_, output) = analyze(&scene, &format!("t_s,{WRENCH}\n0,0,0,-1,0,0,0\n5,0,0,-1,0,0,0\n"), &[]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(error.contains("fewer than 2 usable rows within the 0.4 s of rest"), "{error}");
}

#[test]
fn a_rest_is_refused_beyond_a_hundred_thresholds() {
    let run = |range: f64, least: f64| {
        let scene = SCENE.replace("[surface]", "rest_s = 0.4\n[surface]");
        let scene = format!("{scene}[contact]\nleast_force_N = {least:?}\n");
        let (_, output) = analyze(&scene, &rest(range), &["--no-report"]);
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, said) = run(49.9, 0.5);
    assert!(code == Some(0) && said.starts_with("warning: "), "{said}");
    // So far the tare may be off: the box of the forces.
    assert!(said.contains("the force ranged over 49.9 N"), "{said}");
    let (code, said) = run(50.1, 0.5);
    assert!(code == Some(1) && said.starts_with("error: "), "{said}");
    // Where every force is a contact, no range is too large.
    let (code, said) = run(5000.0, 0.0);
    assert!(code == Some(0) && said.starts_with("warning: "), "{said}");
}

#[test]
fn many_slips_and_contacts_are_counted_and_some_are_shown() {
    let mut rows = format!("t_s,{WRENCH}\n");
    for i in 0..1600_u32 {
        // Each eighth row is beyond the friction coefficient: 200 slips, 0.8 s apart.
        let ratio = if i.is_multiple_of(8) { 0.8 } else { 0.2 };
        let (x, y) = (0.001 * f64::from(i % 40), 0.002 * f64::from(i / 40));
        // A push at (x, y, 0).
        rows += &format!(
            "{:.1},{},0,-2,{},{},{}\n",
            0.1 * f64::from(i),
            2.0 * ratio,
            -2.0 * y,
            2.0 * x,
            -2.0 * ratio * y
        );
    }
    let scene = format!(
        "{SCENE}[friction]\nstatic_coefficient = 0.5\n[slip]\ndetector = \"threshold\"\nnoise_N = 0.01\n"
    );
    let (folder, output) = analyze(&scene, &rows, &[]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.contains(
            "200 slips were seen. The limit of the friction coefficient 0.5 is passed in 200 samples."
        ),
        "{said}"
    );
    let (_, table) = said.split_once("Slips (the first 20)\n").unwrap();
    let (table, _) = table.split_once("\n\n").unwrap();
    assert_eq!(table.lines().count(), 21, "{table}");
    let last: Vec<&str> = table.lines().last().unwrap().split_whitespace().collect();
    assert_eq!(last, ["20", "15.200", "2.00", "0.800"]);
    let report = folder.read("report.html");
    assert_eq!(report.matches("<path class=\"mark\"").count(), 200);
    assert!(!report.contains("later slips are not marked"));
    assert!(report.contains("1\u{202f}500 of 1\u{202f}600 contacts, chosen at random."));
    let map = report.split("</figure>").next().unwrap();
    let dots: usize = map
        .split("<path class=\"dots q")
        .skip(1)
        .map(|path| path.split("\"/>").next().unwrap().matches("h0").count())
        .sum();
    assert!((1470..=1500).contains(&dots), "{dots}");
    // One more slip has no mark.
    let (folder, _) = analyze(&scene, &format!("{rows}160,2,0,-2,0,0,0\n"), &[]);
    let report = folder.read("report.html");
    assert_eq!(report.matches("<path class=\"mark\"").count(), 200);
    assert!(report.contains(" 1 later slips are not marked."));
}

#[test]
fn a_ratio_without_bound_is_cut_where_it_hides_the_others() {
    let rows = |greatest: f64| {
        let mut rows = format!("t_s,{WRENCH}\n");
        for i in 0..300 {
            let ratio = if i == 150 { greatest } else { 0.3 };
            rows += &format!("{:.2},{},0,-2,0,0,0\n", 0.01 * f64::from(i), 2.0 * ratio);
        }
        rows
    };
    let figure = |scene: &str, greatest: f64| {
        let (folder, _) = analyze(scene, &rows(greatest), &[]);
        let report = folder.read("report.html");
        report.split("<figure>").find(|figure| figure.contains("Friction ratio</h2>")).unwrap().to_owned()
    };
    let caption = |scene: &str, greatest: f64| {
        let figure = figure(scene, greatest);
        figure.split("<figcaption>").nth(1).unwrap().split("</figcaption>").next().unwrap().to_owned()
    };
    // 1.6 times what 99 in 100 have is 0.48, rounded outward to 0.5.
    assert_eq!(caption(SCENE, 0.3), "Only where there is a contact.");
    assert_eq!(caption(SCENE, 0.45), "Only where there is a contact.");
    assert_eq!(
        caption(SCENE, 40.0),
        "Only where there is a contact. Cut at 0.500; the greatest ratio is 40.0."
    );
    // A friction coefficient stays in sight: 1.3 times it, rounded outward.
    let scene = format!("{SCENE}[friction]\nstatic_coefficient = 0.9\n");
    assert_eq!(
        caption(&scene, 40.0),
        "Only where there is a contact. Cut at 1.50; the greatest ratio is 40.0."
    );
    // And has room above it where no ratio comes near.
    let drawn = figure(&scene, 0.3);
    let svg = drawn.split("</svg>").next().unwrap();
    let ticks = texts(svg).into_iter().filter(|text| text.class == "tick" && text.anchor == "end");
    let highest = ticks.filter_map(|text| value(&text.text)).fold(0.0, f64::max);
    assert!((1.0..=1.5).contains(&highest), "{highest}");
    let scene = scene.replace("0.9", "0.4");
    assert_eq!(
        caption(&scene, 40.0),
        "Only where there is a contact. Cut at 0.600; the greatest ratio is 40.0."
    );
}

#[test]
fn forces_that_mostly_pull_are_a_sign_of_the_wrong_sign() {
    let rows = |pulling: usize, pressing: usize| {
        let mut rows = format!("t_s,{WRENCH}\n");
        for i in 0..pulling + pressing {
            rows += &format!("{i},0,0,{},0,0,0\n", if i < pulling { 1.0 } else { -1.0 });
        }
        rows
    };
    let said = |scene: &str, rows: &str| {
        let (_, output) = analyze(scene, rows, &["--no-report"]);
        String::from_utf8(output.stdout).unwrap()
    };
    let note = "Note: more forces pull outward than press; check `convention` and the pose in the scene";
    let noted = |pulling, pressing| said(SCENE, &rows(pulling, pressing)).contains(&format!("{note}.\n"));
    assert!(noted(3, 2) && !noted(2, 2) && !noted(1, 5));
    // A touch during the rest turns what comes behind it round, too.
    let resting = SCENE.replace("[surface]", "rest_s = 1.5\n[surface]");
    let said = said(&resting, &format!("{}2,0,0,0,0,0,0\n", rows(0, 2)));
    assert!(said.contains(&format!("{note}, and that nothing touched during rest_s.\n")), "{said}");
}

#[test]
fn the_sensor_that_was_chosen_is_named() {
    let names = WRENCH.split(',').map(|name| format!("S2_{name}")).collect::<Vec<_>>().join(",");
    let rows = format!("t_s,{WRENCH},{names}\n0,0,0,-1,0,0,0,0,0,-5,0,0,0\n");
    let named = |more: &[&str], scene: &str| {
        let (folder, output) = analyze(scene, &rows, &[more, &["--no-report"]].concat());
        let said = String::from_utf8(output.stdout).unwrap();
        (
            said.lines().next().unwrap().to_owned(),
            Contacts::parse(&folder.read("contacts.csv")).numbers("normal_N"),
        )
    };
    let by_scene = SCENE.replace("[surface]", "sensor = \"S2\"\n[surface]");
    assert_eq!(named(&["--sensor", "S2"], SCENE), ("Contacts in touch.csv, sensor s2".to_owned(), vec![5.0]));
    assert_eq!(named(&[], &by_scene).1, [5.0]);
    assert_eq!(named(&["--sensor", ""], &by_scene), ("Contacts in touch.csv".to_owned(), vec![1.0]));
}
