//! Recordings of others: packed, cut, by topic, through pipes; and what is said of them.

use std::fs::{self, File};
use std::process::{Output, Stdio};

use fingertip::wrench::Wrench;
use fingertip_recordings::mcap::{Compression, McapWriter};
use fingertip_test_support::mcap;
use nalgebra::Vector6;

use crate::common::{Contacts, Folder};

const HEADER: &str = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n";
const SCENE: &str =
    "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.5\n";

/// Two topics of wrenches in frames of their own, so many messages each.
pub(crate) fn two_wrists(folder: &Folder, name: &str, messages: u32, compression: Compression) {
    let file = File::create(folder.path(name)).unwrap();
    let mut writer = McapWriter::with_compression(file, compression).unwrap();
    let left = writer.wrenches("/left/ft", "left wrist").unwrap();
    let right = writer.wrenches("/right/ft", "right wrist").unwrap();
    for k in 0..messages {
        for (topic, force) in [(left, -2.0), (right, -3.0)] {
            let wrench =
                Wrench::from_components(&Vector6::new(force, 0.0, 0.0, 0.0, 0.0, f64::from(k) * 1e-5));
            writer.write_wrench(topic, f64::from(k) / 256.0, &wrench).unwrap();
        }
    }
    writer.finish().unwrap();
}

/// A message that is shorter than its definition says is left out and told, and the others are counted.
#[test]
fn messages_that_are_damaged_are_counted_apart() {
    let folder = Folder::new();
    two_wrists(&folder, "whole.mcap", 50, Compression::None);
    let info = |name: &str| folder.succeed(&["info", name]);
    assert!(!info("whole.mcap").contains("not what their definition says"));
    let whole = fs::read(folder.path("whole.mcap")).unwrap();
    // The length of the name of the frame, a number behind the header of CDR and the time, becomes four thousand million.
    let name = b"left wrist\0";
    let places: Vec<usize> = (4..whole.len() - name.len())
        .filter(|at| whole[*at..].starts_with(name) && whole[at - 4..*at] == 11_u32.to_le_bytes())
        .collect();
    assert_eq!(places.len(), 50);
    let mut damaged = whole;
    for at in &places[..3] {
        damaged[at - 4..*at].fill(0xff);
    }
    // Records: what kind, how long, and what; sums of chunks and of the data that are 0 are not checked.
    let mut at = 8;
    while at + 9 < damaged.len() - 8 {
        let length =
            usize::try_from(u64::from_le_bytes(damaged[at + 1..at + 9].try_into().unwrap())).unwrap();
        match damaged[at] {
            6 => damaged[at + 9 + 24..][..4].fill(0),
            15 => damaged[at + 9..][..4].fill(0),
            _ => {}
        }
        at += 9 + length;
    }
    fs::write(folder.path("damaged.mcap"), &damaged).unwrap();
    let said = info("damaged.mcap");
    assert!(said.contains("3 messages are not what their definition says"), "{said}");
    assert!(said.contains("damaged.mcap: MCAP, 100 messages"), "{said}");
}

/// Runs a command whose standard input is this file.
fn with_stdin(folder: &Folder, arguments: &[&str], file: &str) -> Output {
    let file = File::open(folder.path(file)).unwrap();
    let output = folder.command(arguments).stdin(Stdio::from(file)).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    output
}

#[test]
fn packed_files_give_what_plain_ones_give() {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    let mut seen = Vec::new();
    for compression in [Compression::None, Compression::Lz4, Compression::Zstd] {
        two_wrists(&folder, "a.mcap", 300, compression);
        folder.succeed(&["convert", "a.mcap", "a.csv", "--overwrite"]);
        let analyze = ["analyze", "a.mcap", "--scene", "scene.toml", "--no-report", "--topic", "/left/ft"];
        folder.succeed(&analyze);
        seen.push((folder.read("a.csv"), folder.read("contacts.csv")));
    }
    assert!(seen[0] == seen[1] && seen[0] == seen[2]);
    assert_eq!(Contacts::parse(&seen[0].1).len(), 300);
    // And what is written packed is smaller.
    for packing in ["none", "lz4", "zstd"] {
        folder.succeed(&["convert", "a.csv", &format!("{packing}.mcap"), "--compression", packing]);
    }
    let size = |name: &str| fs::metadata(folder.path(name)).unwrap().len();
    assert!(size("lz4.mcap") < size("none.mcap") && size("zstd.mcap") < size("lz4.mcap"));
}

#[test]
fn a_cut_recording_is_read_and_recovered() {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    two_wrists(&folder, "whole.mcap", 2000, Compression::None);
    let whole = fs::read(folder.path("whole.mcap")).unwrap();
    fs::write(folder.path("cut.mcap"), &whole[..whole.len() / 2]).unwrap();
    let analyze = ["analyze", "cut.mcap", "--scene", "scene.toml", "--no-report", "--topic", "/left/ft"];
    let said = folder.succeed(&analyze);
    assert!(said.contains("cut.mcap ends in the middle") && said.contains("fingertip recover"), "{said}");
    let rows = Contacts::parse(&folder.read("contacts.csv")).len();
    assert!((800..1400).contains(&rows), "{rows}");
    let said = folder.succeed(&["recover", "cut.mcap", "new.mcap"]);
    assert!(said.contains("/left/ft: ") && said.contains("Lost: what came behind them"), "{said}");
    assert_eq!(said.matches("Lost: ").count(), 1, "{said}");
    let said = folder.succeed(&["info", "new.mcap"]);
    assert!(
        said.replace('\u{202f}', "").contains(&format!("/left/ft: {rows} messages"))
            && !said.contains("ends in the"),
        "{said}"
    );
    assert_eq!(
        folder.succeed(&["recover", "new.mcap", "again.mcap"]).lines().last(),
        Some("Written: again.mcap")
    );
    // Behind the header, which comes behind eight bytes: a message of a channel that nothing describes.
    let header = 17 + usize::try_from(u64::from_le_bytes(whole[9..17].try_into().unwrap())).unwrap();
    let message = mcap::message(99, 0, &[]);
    fs::write(folder.path("strange.mcap"), [&whole[..header], &message, &whole[header..]].concat()).unwrap();
    let said = folder.succeed(&["recover", "strange.mcap", "known.mcap"]);
    let lost: Vec<&str> = said.lines().filter(|line| line.starts_with("Lost: ")).collect();
    assert_eq!(lost, ["Lost: 1 records that are damaged"], "{said}");
    // Nothing in it: nothing is written.
    fs::write(folder.path("head.mcap"), &whole[..60]).unwrap();
    let error = folder.fail(1, &["recover", "head.mcap", "none.mcap"]);
    assert!(error.contains("nothing to recover") && !folder.path("none.mcap").exists(), "{error}");
}

#[test]
fn a_cut_text_loses_its_last_line() {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    folder.write("cut.csv", &format!("{HEADER}0,-2,0,0,0,0,0\n1,-2,0,0,0,0,0\n2,-2,0"));
    let said = folder.succeed(&["analyze", "cut.csv", "--scene", "scene.toml", "--no-report"]);
    assert!(said.contains("last lines that were cut"), "{said}");
    assert_eq!(Contacts::parse(&folder.read("contacts.csv")).len(), 2);
    let said = folder.succeed(&["recover", "cut.csv", "whole.csv"]);
    assert!(
        said.starts_with("2 rows recovered\nLost: line 4, the last, in which the file was cut\n"),
        "{said}"
    );
    assert_eq!(folder.read("whole.csv"), format!("{HEADER}0,-2,0,0,0,0,0\n1,-2,0,0,0,0,0\n"));
    folder.write("short.csv", &format!("{HEADER}0,-2,0,0,0,0,0\n1,-2,0,0,0,0,0\n2,-2,0,0,0,0,0"));
    let said = folder.succeed(&["recover", "short.csv", "ended.csv"]);
    assert!(said.starts_with("3 rows recovered\nThe file was whole.\n"), "{said}");
    assert!(folder.read("ended.csv").ends_with("\n2,-2,0,0,0,0,0\n"));
    let said = folder.succeed(&["convert", "cut.csv", "cut.mcap"]);
    assert!(said.contains("2 wrenches") && said.contains("line 4, the last"), "{said}");
    folder.write("loads.csv", "fx_N;v1_V\n0;0\n1;1\n2;2.01\n\n3;2.99\n4;4\n5;");
    for more in [&[][..], &["--stream"]] {
        let said = folder.succeed(&[&["calibrate", "loads.csv", "-o", "tip.toml"][..], more].concat());
        assert!(said.contains("loads.csv: the file was cut in line 8"), "{said}");
    }
    let said = folder.run(&["check", "tip.toml", "loads.csv"]);
    let said = String::from_utf8(said.stdout).unwrap();
    assert!(said.contains("loads.csv: the file was cut in line 8"), "{said}");
}

#[test]
fn a_topic_is_chosen_by_its_name_and_its_frame_survives() {
    let folder = Folder::new();
    two_wrists(&folder, "a.mcap", 9, Compression::None);
    folder.succeed(&["convert", "a.mcap", "a.csv", "--topic", "/right/ft"]);
    let text = folder.read("a.csv");
    assert!(text.starts_with("# frame_id: right wrist\nt_s,fx_N,") && text.contains("\n0.0,-3.0,"), "{text}");
    folder.succeed(&["convert", "a.csv", "b.mcap"]);
    let said = folder.succeed(&["info", "b.mcap"]);
    assert!(said.contains("/fingertip/wrench: 9 messages, wrenches [N, N·m], frame right wrist"), "{said}");
    folder.succeed(&["convert", "a.mcap", "both.csv", "--topic", "/left/ft", "--topic", "/right/ft"]);
    let text = folder.read("both.csv");
    assert!(
        text.starts_with("# frame_id of left-ft: left wrist\n# frame_id of right-ft: right wrist\n"),
        "{text}"
    );
    folder.succeed(&["convert", "both.csv", "c.mcap"]);
    let said = folder.succeed(&["info", "c.mcap"]);
    assert!(said.contains("frame left wrist") && said.contains("frame right wrist"), "{said}");
    let error = folder.fail(1, &["convert", "a.mcap", "x.csv", "--topic", "/wrong"]);
    assert!(error.contains("no topic /wrong; there are: /left/ft, /right/ft"), "{error}");
}

#[test]
fn bags_in_databases_are_recognised() {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    for name in ["bag.db3", "bag.csv", "bag.mcap"] {
        folder.write(name, "SQLite format 3\0 and so on");
        for arguments in
            [&["analyze", name, "--scene", "scene.toml"][..], &["convert", name, "x.csv"], &["info", name]]
        {
            let error = folder.fail(1, arguments);
            assert!(error.contains("ROS 2 bag in SQLite") && error.contains("ros2 bag convert"), "{error}");
        }
    }
    fs::create_dir(folder.path("bag")).unwrap();
    folder.write("bag/metadata.yaml", "");
    assert!(folder.fail(1, &["info", "bag"]).contains("give the .mcap file in it"));
    folder.write("text.mcap", HEADER);
    assert!(folder.fail(1, &["info", "text.mcap"]).contains("is no MCAP file"));
}

#[test]
fn recordings_come_and_go_through_pipes() {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    two_wrists(&folder, "a.mcap", 200, Compression::Zstd);
    folder.succeed(&["convert", "a.mcap", "a.csv", "--topic", "/left/ft"]);
    folder.succeed(&["analyze", "a.csv", "--scene", "scene.toml", "--no-report"]);
    let expected = folder.read("contacts.csv");
    let analyze =
        ["analyze", "-", "--scene", "scene.toml", "--no-report", "--output", "-", "--topic", "/left/ft"];
    for file in ["a.csv", "a.mcap"] {
        let output = with_stdin(&folder, &analyze, file);
        assert_eq!(String::from_utf8(output.stdout).unwrap(), expected, "{file}");
        assert!(String::from_utf8(output.stderr).unwrap().contains("200"));
    }
    let convert = ["convert", "-", "-", "--topic", "/left/ft"];
    let text = with_stdin(&folder, &convert, "a.mcap").stdout;
    assert_eq!(String::from_utf8(text).unwrap(), folder.read("a.csv"));
    let info = with_stdin(&folder, &["info", "-"], "a.mcap").stdout;
    assert!(String::from_utf8(info).unwrap().starts_with("standard input: MCAP, 400 messages\n"));
    folder.write("loads.csv", "fx_N,v1_V\n0,0\n1,1\n2,2.01\n3,2.99\n4,4\n");
    let toml = with_stdin(&folder, &["calibrate", "-", "-o", "-"], "loads.csv").stdout;
    folder.write("tip.toml", &String::from_utf8(toml).unwrap());
    with_stdin(&folder, &["tare", "tip.toml", "-", "-o", "tared.toml"], "loads.csv");
    let output = folder.run(&["record", "sim", "-o", "-", "--samples", "5"]);
    assert_eq!(Contacts::parse(&String::from_utf8(output.stdout).unwrap()).len(), 5);
    let error = folder.fail(1, &["convert", "a.csv", "-"]);
    assert!(error.contains("the same kind"), "{error}");
    let whole = with_stdin(&folder, &["recover", "-", "-"], "a.mcap").stdout;
    fs::write(folder.path("b.mcap"), whole).unwrap();
    assert!(folder.succeed(&["info", "b.mcap"]).starts_with("b.mcap: MCAP, 400 messages\n"));
    let whole = with_stdin(&folder, &["recover", "-", "-"], "a.csv").stdout;
    assert_eq!(String::from_utf8(whole).unwrap(), folder.read("a.csv"));
    let json = with_stdin(&folder, &["export", "-", "--json", "-"], "scene.toml").stdout;
    assert_eq!(String::from_utf8(json).unwrap(), folder.succeed(&["export", "scene.toml", "--json", "-"]));
    let said = with_stdin(&folder, &["scene", "check", "-"], "scene.toml").stdout;
    assert!(String::from_utf8(said).unwrap().starts_with("standard input: "));
    folder.write(
        "matrix.csv",
        "1,0,0,0,0,0\n0,1,0,0,0,0\n0,0,1,0,0,0\n0,0,0,1,0,0\n0,0,0,0,1,0\n0,0,0,0,0,1\n",
    );
    let units = ["--signal", "V", "--force", "N", "--torque", "Nm", "--full-scale", "30,0.3"];
    let import: Vec<&str> =
        ["import", "-", "--matrix", "load-per-signal", "-o", "-"].into_iter().chain(units).collect();
    let toml = String::from_utf8(with_stdin(&folder, &import, "matrix.csv").stdout).unwrap();
    assert!(toml.contains("source = \"standard input\""), "{toml}");
    let error = folder.fail(1, &["analyze", "-", "--scene", "-"]);
    assert!(error.contains("the standard input can be read once"), "{error}");
}

/// The lengths in an MCAP file are known when its parts are whole: a pipe, which cannot go back, gets all at the end.
#[cfg(unix)]
#[test]
fn an_mcap_file_goes_into_a_named_pipe() {
    let folder = Folder::new();
    two_wrists(&folder, "a.mcap", 200, Compression::None);
    folder.succeed(&["convert", "a.mcap", "a.csv", "--topic", "/left/ft"]);
    folder.succeed(&["convert", "a.csv", "b.mcap"]);
    folder.succeed(&["recover", "a.mcap", "c.mcap"]);
    folder.succeed(&["record", "sim", "-o", "d.mcap", "--samples", "50"]);
    let made = std::process::Command::new("mkfifo").arg(folder.path("pipe.mcap")).status().unwrap();
    assert!(made.success());
    let through = |arguments: &[&str]| {
        std::thread::scope(|scope| {
            let reader = scope.spawn(|| fs::read(folder.path("pipe.mcap")).unwrap());
            folder.succeed(arguments);
            reader.join().unwrap()
        })
    };
    let file = |name: &str| fs::read(folder.path(name)).unwrap();
    assert_eq!(through(&["convert", "a.csv", "pipe.mcap"]), file("b.mcap"));
    assert_eq!(through(&["recover", "a.mcap", "pipe.mcap"]), file("c.mcap"));
    fs::write(folder.path("e.mcap"), through(&["record", "sim", "-o", "pipe.mcap", "--samples", "50"]))
        .unwrap();
    let said = |name: &str| folder.succeed(&["info", name]).split_once('\n').unwrap().0.replace(name, "");
    assert_eq!(said("e.mcap"), said("d.mcap"));
}

/// Each has files of its own, and one that is bad does not keep the others from being done.
#[test]
fn several_recordings_are_analysed_one_by_one() {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    two_wrists(&folder, "a.mcap", 200, Compression::None);
    folder.succeed(&["convert", "a.mcap", "first.csv", "--topic", "/left/ft"]);
    folder.succeed(&["convert", "a.mcap", "second.csv", "--topic", "/right/ft"]);
    folder.write("bad.csv", "nothing\n");
    let scene = ["--scene", "scene.toml"];
    let all = ["analyze", "first.csv", "bad.csv", "second.csv"];
    let error = folder.fail(1, &[&all[..], &scene].concat());
    assert!(
        error.contains("bad.csv")
            && error.ends_with("error: 1 of 3 recordings failed; the others were done\n")
    );
    for name in ["first", "second"] {
        let recording = format!("{name}.csv");
        folder.succeed(&[&["analyze", &recording, "--overwrite"], &scene[..]].concat());
        assert_eq!(folder.read(&format!("{name}.contacts.csv")), folder.read("contacts.csv"), "{name}");
        assert_eq!(folder.read(&format!("{name}.report.html")), folder.read("report.html"), "{name}");
    }
    assert!(!folder.path("bad.contacts.csv").exists() && !folder.path("bad.report.html").exists());
    let lines = folder
        .succeed(&[&["analyze", "first.csv", "second.csv", "--json", "--overwrite"], &scene[..]].concat());
    assert_eq!(lines.lines().filter(|line| line.starts_with('{') && line.ends_with('}')).count(), 2);
    let error =
        folder.fail(1, &[&["analyze", "first.csv", "second.csv", "--output", "-"], &scene[..]].concat());
    assert!(error.contains("cannot share the standard output"), "{error}");
    let error =
        folder.fail(1, &[&["analyze", "first.csv", "./first.csv", "--overwrite"], &scene[..]].concat());
    assert!(error.contains("are the same file"), "{error}");
    // The same of `health`.
    folder.run(&["health", "first.csv", "second.csv", "--html", "page.html", "--json", "all.json"]);
    for name in ["first", "second"] {
        assert!(folder.read(&format!("{name}.page.html")).contains(&format!("{name}.csv")));
        assert!(folder.read(&format!("{name}.all.json")).contains("\"samples\": 200"));
    }
}

#[test]
fn a_run_says_as_much_as_is_asked_for() {
    let folder = Folder::new();
    folder.write("scene.toml", SCENE);
    two_wrists(&folder, "a.mcap", 50, Compression::None);
    folder.succeed(&["convert", "a.mcap", "a.csv", "--topic", "/left/ft"]);
    let analyze = ["analyze", "a.csv", "--scene", "scene.toml", "--overwrite"];
    let quiet = folder.run(&[&analyze[..], &["-q"]].concat());
    assert!(quiet.status.success() && quiet.stdout.is_empty() && quiet.stderr.is_empty(), "{quiet:?}");
    assert!(!folder.read("contacts.csv").is_empty());
    let to_stdout = folder.run(&[&["--quiet"], &analyze[..], &["--no-report", "--output", "-"]].concat());
    assert_eq!(String::from_utf8(to_stdout.stdout).unwrap(), folder.read("contacts.csv"));
    assert!(to_stdout.stderr.is_empty());
    // What a command is asked for is said all the same.
    assert_eq!(folder.succeed(&["info", "a.csv", "-q"]), folder.succeed(&["info", "a.csv"]));
    assert!(folder.fail(1, &["info", "none.csv", "-q"]).contains("none.csv"));
    let verbose = folder.run(&[&analyze[..], &["-v"]].concat());
    assert_eq!(verbose.stdout, folder.run(&analyze).stdout);
    let said = String::from_utf8(verbose.stderr).unwrap();
    let lines: Vec<&str> = said.lines().collect();
    let bytes = |name: &str| fs::metadata(folder.path(name)).unwrap().len();
    let [scene, recording, contacts, report, took] = lines[..] else { panic!("{said}") };
    assert_eq!(scene, "reads scene scene.toml");
    assert_eq!(recording, format!("reads recording a.csv: {} bytes", bytes("a.csv")));
    assert_eq!(contacts, format!("wrote contacts contacts.csv: {} bytes", bytes("contacts.csv")));
    assert_eq!(report, format!("wrote report report.html: {} bytes", bytes("report.html")));
    assert!(took.starts_with("took ") && took.ends_with(" s"), "{took}");
    // What else is read whole, of which nothing may come.
    folder.write("matrix.csv", "1,2\n");
    let said = folder.fail(1, &["import", "matrix.csv", "-o", "matrix.toml", "--full-scale", "10,0.1", "-v"]);
    assert!(said.starts_with("reads matrix matrix.csv: 4 bytes\n"), "{said}");
    assert!(folder.fail(2, &["info", "a.csv", "-q", "-v"]).contains("cannot be used with"));
}

#[test]
fn a_recording_is_described_as_it_is_understood() {
    let folder = Folder::new();
    let mut text = "t_ms,S1_Fx_mN,S1_Fy_mN,S1_Fz_mN,S1_Tx_Nmm,S1_Ty_Nmm,S1_Tz_Nmm,v1_mV,mood\n".to_owned();
    for k in 0..50 {
        text.push_str(&format!("{},{k},0,0,0,0,0,1,2\n", if k < 40 { 4 * k } else { 4 * k + 100 }));
    }
    folder.write("a.csv", &text);
    let said = folder.succeed(&["info", "a.csv"]);
    for expected in [
        "a.csv: CSV, 50 rows\n  from 0 s to 0.296 s, 250 samples/s, jitter ",
        "\n  1 gaps, the longest of 0.104 s\n",
        "t_ms       time [0.001 s]",
        "S1_Fx_mN   force x of sensor s1 [0.001 N]",
        "S1_Tz_Nmm  torque z of sensor s1 [0.001 N·m]",
        "v1_mV      signal 1 [0.001 V]",
        "mood       not used",
    ] {
        assert!(said.contains(expected), "{expected:?} is not in\n{said}");
    }
    let json = folder.succeed(&["info", "--json", "a.csv", "a.csv"]);
    let lines: Vec<&str> = json.lines().collect();
    assert!(lines.len() == 2 && lines[0] == lines[1], "{json}");
    for expected in ["\"file\":\"a.csv\"", "\"samples\":50", "\"gaps\":1", "\"name\":\"mood\""] {
        assert!(json.contains(expected), "{expected} is not in {json}");
    }
}

#[test]
fn shells_and_readers_are_helped() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = folder.succeed(&["completions", shell]);
        assert!(text.contains("calibrate") && text.contains("overwrite"), "{shell}");
    }
    fs::create_dir(folder.path("pages")).unwrap();
    folder.succeed(&["man", "pages"]);
    let page = folder.read("pages/fingertip-analyze.1");
    assert!(page.starts_with(".ie") || page.contains(".TH"), "{page}");
    assert!(page.contains("contacts") && folder.path("pages/fingertip-scene-init.1").exists());
    // With the options of every command, and called as it is.
    let page = folder.read("pages/fingertip-scene.1");
    for expected in ["\\fB\\-q\\fR, \\fB\\-\\-quiet\\fR\n", "\n\\fBfingertip scene\\fR "] {
        assert!(page.contains(expected), "{expected} is not in {page}");
    }
}

/// What has no end, or more of something than is meant, is refused with the limit, not held in memory.
#[cfg(target_os = "linux")]
#[test]
fn what_has_no_end_is_refused() {
    let folder = Folder::new();
    folder.write("loads.csv", "fx_N,v1_V\n0,0\n1,1\n2,2.01\n3,2.99\n4,4\n");
    folder.write("deep.cal", &format!("{}{}", "<a>".repeat(20_000), "</a>".repeat(20_000)));
    let error = folder.fail(1, &["check", "deep.cal", "loads.csv"]);
    assert!(error.contains("more than 1000 elements"), "{error}");
    let error = folder.fail(1, &["check", "/dev/zero", "loads.csv"]);
    assert!(error.contains("longer than 16 MiB"), "{error}");
    let error = folder.fail(1, &["scene", "check", "/dev/zero"]);
    assert!(error.contains("longer than 16 MiB"), "{error}");
    let mesh = "[surface]\nshape = \"mesh\"\nfile = \"/dev/zero\"\nmetres_per_unit = 1e-3\n";
    folder.write("mesh.toml", &format!("version = 2\n[input]\nconvention = \"on_fingertip\"\n{mesh}"));
    let error = folder.fail(1, &["scene", "check", "mesh.toml"]);
    assert!(error.contains("a file of 512 MiB at most, and this is none, but a device"), "{error}");
    let error = folder.fail(1, &["analyze", "loads.csv", "--scene", "/dev/zero"]);
    assert!(error.contains("longer than 16 MiB"), "{error}");
    let error = folder.fail(1, &["simulate", "--serve", "ati", "--script", "/dev/zero"]);
    assert!(error.contains("longer than 16 MiB"), "{error}");
    let error = folder.fail(2, &["design", "--gauges", "1000000"]);
    assert!(error.contains("is not in 0..=64"), "{error}");
    let error = folder.fail(1, &["calibrate", "/dev/zero"]);
    assert!(error.contains("longer than 1048576 bytes"), "{error}");
}
