//! `fingertip record` and `fingertip simulate`, as far as they need no other process.

use std::fs::File;
use std::io::BufReader;
use std::time::{SystemTime, UNIX_EPOCH};

use fingertip_recordings::mcap::{McapReader, Recorded};
use fingertip_simulation::{Options, SimulatedFingertip, standard_session};

use crate::common::{Contacts, Folder, scene};

/// The simulated fingertip; a second of it takes a second.
const FAST: &str = "sim?rate_Hz=1000&seed=3";

#[test]
fn the_volts_of_the_simulation_are_recorded_as_they_are() {
    let folder = Folder::new();
    let said = folder.succeed(&["record", FAST, "-o", "a.csv", "--samples", "120"]);
    let rate = "120 samples in 0.119 s (1000 samples/s)\nLink: 0 lost, 0 late, 0 repeated, 0 damaged\nWritten: a.csv\n";
    assert_eq!(said, rate);
    let rows = Contacts::parse(&folder.read("a.csv"));
    assert_eq!(rows.len(), 120);
    let options = Options { seed: 3, ..Options::default() };
    let truth: Vec<_> = SimulatedFingertip::new(&standard_session(), options).unwrap().take(120).collect();
    for (column, index) in ["v1_V", "v2_V", "v3_V", "v4_V", "v5_V", "v6_V", "dummy_V"].iter().zip(0..) {
        for (found, sample) in rows.numbers(column).iter().zip(&truth) {
            assert_eq!(*found, sample.raw[index], "{column}");
        }
    }
    for (found, sample) in rows.numbers("t_s").iter().zip(&truth) {
        assert!((found - sample.time).abs() < 1e-9);
    }
    // At rest, and less its zero, no component is far from nothing.
    for column in ["fx_N", "fy_N", "fz_N"] {
        assert!(rows.numbers(column).iter().all(|force| force.abs() < 0.5), "{column}");
    }
}

#[test]
fn both_formats_hold_the_same_contacts_too() {
    let folder = Folder::new();
    // By --duration, with the contacts of a scene; the session presses first after a second.
    let arguments = |file: &'static str| {
        ["record", "sim?rate_Hz=500", "-o", file, "--duration", "1.5", "--scene", "sim", "--force"]
    };
    let said = folder.succeed(&arguments("a.csv"));
    assert!(said.starts_with("751 samples in 1.5 s (500 samples/s), "), "{said}");
    let said_again = folder.succeed(&arguments("a.mcap"));
    assert_eq!(said_again.replace("a.mcap", "a.csv"), said);
    let rows = Contacts::parse(&folder.read("a.csv"));
    let contacts = rows.numbers("contact_x_m").iter().filter(|x| x.is_finite()).count();
    assert!(contacts > 50 && said.contains(&format!(", {contacts} with a contact\n")), "{said}");
    // Each contact lies on the sphere, its normal points from the centre, and its force is the wrench's.
    let column = |name: &str| rows.numbers(name);
    let vector = |names: [&str; 3], row: usize| names.map(|name| column(name)[row]);
    for row in (0..rows.len()).filter(|row| column("contact_x_m")[*row].is_finite()).step_by(7) {
        let at = vector(["contact_x_m", "contact_y_m", "contact_z_m"], row);
        let normal = vector(["contact_nx", "contact_ny", "contact_nz"], row);
        let (load, force) = (
            vector(["contact_load_x_N", "contact_load_y_N", "contact_load_z_N"], row),
            vector(["fx_N", "fy_N", "fz_N"], row),
        );
        for axis in 0..3 {
            assert!((at[axis] - 0.013 * normal[axis]).abs() < 1e-9 && load[axis] == force[axis], "row {row}");
        }
    }
    let mut reader = McapReader::new(BufReader::new(File::open(folder.path("a.mcap")).unwrap())).unwrap();
    let (mut wrenches, mut touched, mut gauges, mut dummies, mut touches) = (0, Vec::new(), 0, 0, 0);
    while let Some(entry) = reader.next_entry().unwrap() {
        match entry.recorded {
            Recorded::Wrench(wrench) => {
                assert_eq!(wrench.force().x, column("fx_N")[wrenches]);
                assert_eq!(entry.time, column("t_s")[wrenches]);
                wrenches += 1;
            }
            Recorded::Contact(contact) => touched.push(contact.position.x),
            Recorded::Touch(touch) => {
                // All of it in one message: the load, and the contact or none.
                let row = touches;
                assert_eq!((touch.number, touch.time), (row as u64, column("t_s")[row]));
                assert_eq!(touch.load.force().x, column("fx_N")[row]);
                let at = column("contact_x_m")[row];
                assert_eq!(touch.status == "contact", at.is_finite());
                assert!(touch.point.x == at || (touch.point.x.is_nan() && at.is_nan()), "row {row}");
                assert_eq!(touch.normal_force.is_finite(), at.is_finite());
                touches += 1;
            }
            Recorded::Signals(signals) if signals.values.len() == 6 => {
                assert_eq!((signals.values[5], signals.unit.as_str()), (column("v6_V")[gauges], "V"));
                gauges += 1;
            }
            Recorded::Signals(signals) => {
                assert_eq!(signals.values, [column("dummy_V")[dummies]]);
                dummies += 1;
            }
            // The scene that Foxglove draws, where the command was built with that.
            Recorded::Other => {}
            _ => panic!("what is this?"),
        }
    }
    assert_eq!((wrenches, gauges, dummies, touches), (751, 751, 751, 751));
    let expected: Vec<f64> = column("contact_x_m").into_iter().filter(|x| x.is_finite()).collect();
    assert_eq!(touched, expected);
}

#[test]
fn a_zero_is_the_mean_of_what_is_not_recorded() {
    let folder = Folder::new();
    folder.succeed(&["record", FAST, "-o", "plain.csv", "--samples", "150"]);
    let said = folder.succeed(&["record", FAST, "-o", "tared.csv", "--samples", "50", "--tare", "0.1"]);
    let plain = Contacts::parse(&folder.read("plain.csv"));
    let tared = Contacts::parse(&folder.read("tared.csv"));
    let zeros = said.split("Zero taken off [N, N·m]: ").nth(1).unwrap().lines().next().unwrap();
    let zeros: Vec<f64> = zeros.split(", ").map(|zero| zero.parse().unwrap()).collect();
    for (index, name) in ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"].iter().enumerate() {
        let (before, after) = (plain.numbers(name), tared.numbers(name));
        let mean = before[..100].iter().sum::<f64>() / 100.0;
        assert!((zeros[index] - mean).abs() <= 5e-3 * mean.abs(), "{name}: {} for {mean}", zeros[index]);
        for (found, expected) in after.iter().zip(&before[100..]) {
            assert!((found - (expected - mean)).abs() < 1e-12, "{name}");
        }
    }
    assert_eq!(tared.numbers("t_s")[0], 0.1);
}

#[test]
fn what_is_asked_of_a_recording_is_done_or_refused() {
    let folder = Folder::new();
    let now = || SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_secs_f64();
    let before = now();
    let said = folder.succeed(&[
        "record",
        FAST,
        "-o",
        "day.csv",
        "--samples",
        "20",
        "--unix-time",
        "--quiet",
        "--tare",
        "1",
    ]);
    assert_eq!(said, "");
    let times = Contacts::parse(&folder.read("day.csv")).numbers("t_s");
    let one = folder.succeed(&["record", FAST, "-o", "one.csv", "--samples", "1"]);
    assert!(one.starts_with("1 samples in 0 s\n"), "{one}");
    assert!(times[0] >= before + 0.9 && times[0] <= now() + 1e-6, "{times:?}");
    assert!((times[19] - times[0] - 0.019).abs() < 1e-6);
    for (option, value) in [
        ("duration", "0"),
        ("duration", "-1"),
        ("duration", "1e9"),
        ("duration", "nan"),
        ("tare", "0"),
        ("silence", "0"),
        ("silence", "inf"),
    ] {
        let error = folder.fail(1, &["record", FAST, "-o", "none.csv", &format!("--{option}={value}")]);
        assert!(error.contains(&format!("--{option} must be a number of seconds above 0")), "{error}");
    }
    let error = folder.fail(1, &["record", "sim?rate_Hz=0", "-o", "none.csv"]);
    assert!(error.contains("rate_Hz=0 must be above 0"), "{error}");
    assert!(!folder.path("none.csv").exists());
}

#[test]
fn a_simulation_tells_where_it_is_and_what_it_did() {
    let folder = Folder::new();
    for (arguments, device, address, done) in [
        (
            &["ati", "--port", "0"][..],
            "ati",
            "ati://127.0.0.1:",
            " samples, 0 sent; 0 lost on purpose, 0 repeated, 0 late, 0 cut",
        ),
        (
            &["schunk"],
            "schunk",
            "schunk://127.0.0.1:",
            " samples, 0 sent; 0 lost on purpose, 0 repeated, 0 late, 0 cut",
        ),
        (
            &["bota", "--over", "tcp"],
            "bota",
            "bota+tcp://127.0.0.1:",
            "0 samples, 0 sent; 0 damaged or lost on purpose",
        ),
        (
            &["resense", "--over", "tcp"],
            "resense",
            "resense+tcp://127.0.0.1:",
            "0 samples, 0 sent; 0 damaged or lost on purpose",
        ),
    ] {
        let all = [
            &["simulate", "--duration", "0.2", "--scenario", "press", "--rate", "250", "--serve"],
            arguments,
        ]
        .concat();
        let said = folder.succeed(&all);
        // Five presses of 0.3 + 1 + 0.2 + 0.5 s behind 1 s of rest.
        let head = format!(
            "Simulated sensor {device}: 250 samples/s, press (11 s, begun anew by each client, then repeated)\nAddress: {address}"
        );
        assert!(said.starts_with(&head), "{said}");
        let (_, end) = said.split_once("\nCtrl-C ends it.\n\n").unwrap();
        // An Ethernet sensor samples without a client, too.
        assert!(
            end.trim_start_matches(|c: char| c.is_ascii_digit())
                == format!("{}\n", done.trim_start_matches('0')),
            "{said}"
        );
    }
    folder.write("script.toml", "[[segments]]\ndo = 'rest'\nduration = 0.7\n");
    let script =
        ["simulate", "--duration", "0.1", "--serve", "bota", "--over", "tcp", "--script", "script.toml"];
    assert!(folder.succeed(&script).contains("script.toml (0.7 s, "));
    for (text, expected) in [
        ("segments = []", "no segments"),
        ("[[segments]]\ndo = 'fly'\n", "script.toml"),
        ("x = = 1", "script.toml"),
    ] {
        folder.write("script.toml", text);
        let error = folder.fail(1, &script);
        assert!(error.contains(expected), "{error}");
    }
    folder.succeed(&[
        "simulate",
        "--serve",
        "bota",
        "--over",
        "tcp",
        "--rate",
        "100000",
        "--duration",
        "0.05",
    ]);
    for (option, expected) in [
        ("--rate=-1", "--rate -1 must be above 0"),
        ("--rate=100001", "up to 100000"),
        ("--rate=nan", "--rate"),
        ("--noise=-1", "--noise -1 must be finite and not negative"),
        ("--noise=nan", "--noise"),
        ("--duration=-1", "--duration"),
        ("--loss=2", "--loss 2 is no probability"),
    ] {
        let error = folder.fail(1, &["simulate", "--serve", "bota", "--over", "tcp", option]);
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn a_scene_that_is_no_file_is_an_error() {
    let folder = Folder::new();
    let error = folder.fail(1, &["record", FAST, "--scene", "none.toml"]);
    assert!(error.contains("none.toml"), "{error}");
    // A file of this name goes before the scene of the simulation.
    std::fs::copy(scene("paper_sphere.toml"), folder.path("sim")).unwrap();
    let record = ["record", FAST, "--scene", "sim", "--samples", "50", "-o", "a.csv"];
    // Its rest of a second swallows the fifty samples of contacts, which are recorded all the same.
    assert!(folder.succeed(&record).contains(", 0 with a contact"));
}

/// At any rate an interruption ends it, and what was recorded is whole.
#[test]
#[cfg(unix)]
fn a_fast_simulation_is_interrupted() {
    let folder = Folder::new();
    let record = ["record", "sim?rate_Hz=1e7", "-o", "a.csv"];
    let child = folder.command(&record).stdout(std::process::Stdio::piped()).spawn().unwrap();
    while !folder.has_begun("a.csv") {
        std::thread::sleep(core::time::Duration::from_millis(2));
    }
    let asked = std::time::Instant::now();
    std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    let output = child.wait_with_output().unwrap();
    // Far longer than it takes, and far shorter than for ever.
    assert!(asked.elapsed() < core::time::Duration::from_secs(30));
    let said = String::from_utf8(output.stdout).unwrap().replace('\u{202f}', "");
    let (samples, _) = said.split_once(" samples in ").unwrap();
    assert!(output.status.success(), "{said}");
    assert_eq!(Contacts::parse(&folder.read("a.csv")).len(), samples.parse::<usize>().unwrap());
}

/// However high the rate, it begins at once.
#[test]
fn a_fast_simulation_begins() {
    let folder = Folder::new();
    let said = folder.succeed(&["record", "sim?rate_Hz=1e7", "-o", "a.csv", "--samples", "10"]);
    assert!(said.starts_with("10 samples in "), "{said}");
}

/// What a file says cannot steer the terminal.
#[test]
fn control_characters_are_shown_as_what_they_are() {
    let folder = Folder::new();
    folder.write("a.csv", "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,m\u{1b}]0;mine\u{7}d\n0,1,0,0,0,0,0,0\n");
    let said = folder.succeed(&["info", "a.csv"]);
    assert!(said.contains("\\u{1b}]0;mine\\u{7}") && !said.contains('\u{1b}'), "{said}");
    let said = folder.succeed(&["convert", "a.csv", "a.mcap"]);
    assert!(said.contains("\\u{1b}") && !said.contains('\u{1b}'), "{said}");
    folder.write("b.csv", "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,1,0,0,0,0,\u{1b}[2J\n");
    let error = folder.fail(1, &["info", "b.csv"]);
    assert!(error.contains("\\u{1b}[2J") && !error.contains('\u{1b}'), "{error}");
}

/// An address that this machine does not have is called that, whatever was to be served.
#[test]
fn an_address_of_others_cannot_be_served_on() {
    let folder = Folder::new();
    for more in [&["ati"][..], &["bota", "--over", "tcp"]] {
        // Set aside for examples (RFC 5737): nobody has it.
        let arguments = [&["simulate", "--listen", "192.0.2.1", "--port", "0", "--serve"][..], more].concat();
        let error = folder.fail(1, &arguments);
        assert!(error.contains("none of this machine's: give --listen one that is"), "{error}");
    }
}
