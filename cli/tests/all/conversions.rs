//! `fingertip convert`: what comes over, what is lost, and what is said of it.

use std::fs::File;
use std::io::BufReader;

use fingertip::wrench::Wrench;
use fingertip_recordings::mcap::{McapReader, McapWriter, Recorded, RecordedContact, RecordedSignals};
use nalgebra::{Vector3, Vector6};

use crate::common::{Contacts, Folder};

const WRENCH: &str = "fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm";

/// All entries of a file: topic, frame, time, and the numbers.
fn entries(folder: &Folder, name: &str) -> Vec<(String, String, f64, Vec<f64>)> {
    let mut reader = McapReader::new(BufReader::new(File::open(folder.path(name)).unwrap())).unwrap();
    let mut all = Vec::new();
    while let Some(entry) = reader.next_entry().unwrap() {
        let numbers = match entry.recorded {
            Recorded::Wrench(wrench) => wrench.components().as_slice().to_vec(),
            Recorded::Signals(signals) => {
                assert_eq!(signals.unit, "V");
                signals.values
            }
            Recorded::Contact(contact) => contact.position.as_slice().to_vec(),
            _ => Vec::new(),
        };
        all.push((entry.topic, entry.frame, entry.time, numbers));
    }
    all
}

#[test]
fn every_column_becomes_its_message() {
    let folder = Folder::new();
    folder.write(
        "a.csv",
        &format!(
            "t_s,{WRENCH},S2_{},v1_V,v2_V,dummy_V\n\
             0.5,1,2,3,4,5,6,-1,-2,-3,-4,-5,-6,0.1,0.2,0.3\n\
             0.75,7,8,9,10,11,12,,,,,,,0.4,,0.6\n",
            WRENCH.replace(',', ",S2_")
        ),
    );
    let said = folder.succeed(&["convert", "a.csv", "a.mcap"]);
    assert_eq!(
        said,
        "a.csv → a.mcap: 3 wrenches, 1 signals\nLost: 2 samples of which a number is missing or not finite\n"
    );
    let entry = |topic: &str, frame: &str, time: f64, numbers: &[f64]| {
        (format!("/fingertip/{topic}"), frame.to_owned(), time, numbers.to_vec())
    };
    let expected = [
        entry("wrench", "fingertip_sensor", 0.5, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
        entry("s2/wrench", "fingertip_sensor_s2", 0.5, &[-1.0, -2.0, -3.0, -4.0, -5.0, -6.0]),
        entry("dummy", "fingertip_sensor", 0.5, &[0.3]),
        entry("signals", "fingertip_sensor", 0.5, &[0.1, 0.2]),
        entry("wrench", "fingertip_sensor", 0.75, &[7.0, 8.0, 9.0, 10.0, 11.0, 12.0]),
    ];
    assert_eq!(entries(&folder, "a.mcap"), expected);
}

#[test]
fn times_are_those_of_the_rows_or_of_the_rate() {
    let folder = Folder::new();
    let rows = "1,0,0,0,0,0\n2,0,0,0,0,0\n3,0,0,0,0,0\n";
    folder.write("bare.csv", &format!("{WRENCH}\n{rows}"));
    let error = folder.fail(1, &["convert", "bare.csv", "a.mcap"]);
    assert!(error.contains("no column of time") && error.contains("--rate"), "{error}");
    assert!(!folder.path("a.mcap").exists());
    for rate in ["0", "-1", "inf", "nan"] {
        let error = folder.fail(1, &["convert", "bare.csv", "a.mcap", &format!("--rate={rate}")]);
        assert!(error.to_lowercase().contains(&format!("--rate {rate} must be above 0")), "{error}");
    }
    let times = |name: &str| entries(&folder, name).iter().map(|entry| entry.2).collect::<Vec<_>>();
    let said = folder.succeed(&["convert", "bare.csv", "a.mcap", "--rate", "8"]);
    assert_eq!(said, "bare.csv → a.mcap: 3 wrenches\nNothing was lost.\n");
    assert_eq!(times("a.mcap"), [0.0, 0.125, 0.25]);
    // A column of time goes before the rate; a row without its time, and what a nanosecond is too long for, are told.
    folder.write(
        "timed.csv",
        &format!("t_s,{WRENCH}\n0.1,1,0,0,0,0,0\n,2,0,0,0,0,0\n0.3000000004,3,0,0,0,0,0\n"),
    );
    let said = folder.succeed(&["convert", "timed.csv", "b.mcap", "--rate", "8"]);
    assert!(said.contains("Lost: 1 rows without a usable time; 1 times rounded to nanoseconds\n"), "{said}");
    assert_eq!(times("b.mcap"), [0.1, 0.3]);
    folder.write("early.csv", &format!("t_s,{WRENCH}\n-1,1,0,0,0,0,0\n"));
    let error = folder.fail(1, &["convert", "early.csv", "c.mcap"]);
    assert!(error.contains("line 2: a time of -1 s cannot be written to MCAP"), "{error}");
    assert!(!folder.path("c.mcap").exists(), "half a file was left");
    folder.write("empty.csv", &format!("t_s,{WRENCH}\n"));
    folder.fail(1, &["convert", "empty.csv", "c.mcap"]);
    assert!(!folder.path("c.mcap").exists(), "a file without rows was left");
}

#[test]
fn a_file_is_written_over_only_if_that_is_wanted() {
    let folder = Folder::new();
    folder.write("a.csv", &format!("t_s,{WRENCH}\n0,1,0,0,0,0,0\n"));
    folder.write("a.mcap", "mine");
    let error = folder.fail(1, &["convert", "a.csv", "a.mcap"]);
    assert!(error.contains("it exists already") && error.contains("--overwrite"), "{error}");
    assert_eq!(folder.read("a.mcap"), "mine");
    // What fails after it was asked to write over leaves nothing of its own to be taken away.
    folder.write("bad.csv", &format!("t_s,{WRENCH}\n-1,1,0,0,0,0,0\n"));
    folder.fail(1, &["convert", "bad.csv", "a.mcap", "--overwrite"]);
    assert!(folder.path("a.mcap").exists());
    folder.succeed(&["convert", "a.csv", "a.mcap", "--overwrite"]);
    assert_eq!(entries(&folder, "a.mcap").len(), 1);
    let error = folder.fail(1, &["convert", "a.mcap", "a.csv"]);
    assert!(error.contains("it exists already"), "{error}");
    folder.write(
        "c.csv",
        "a longer text that must be gone entirely, since it is of another time altogether: xxxxx",
    );
    folder.succeed(&["convert", "a.mcap", "c.csv", "--overwrite"]);
    assert_eq!(folder.read("c.csv").lines().count(), 2);
}

fn wrench(first: f64) -> Wrench<f64> {
    Wrench::from_components(&Vector6::new(first, 0.0, -1.0, 0.0, 0.5, 0.0))
}

/// A file of others: two sensors, gauges of another number, contacts of two fingers, and a time that goes back.
fn foreign(folder: &Folder) {
    let mut writer = McapWriter::new(File::create(folder.path("a.mcap")).unwrap()).unwrap();
    let left = writer.wrenches("/robot/left wrist/ft", "left").unwrap();
    let right = writer.wrenches("/robot/right/ft", "right").unwrap();
    let gauges = writer.signals("/daq", "left").unwrap();
    let one = writer.contacts("/one", "left").unwrap();
    let two = writer.contacts("/two", "left").unwrap();
    let contact = |name: &str| RecordedContact {
        name: name.to_owned(),
        position: Vector3::new(0.001, 0.002, 0.003),
        normal: Vector3::z(),
        wrench: wrench(2.0),
    };
    let signals = |values: &[f64]| RecordedSignals { unit: "V".to_owned(), values: values.to_vec() };
    writer.write_wrench(left, 1.0, &wrench(1.0)).unwrap();
    writer.write_wrench(right, 1.0, &wrench(2.0)).unwrap();
    writer.write_signals(gauges, 1.0, signals(&[0.5, f64::NAN, 0.25])).unwrap();
    writer.write_contact(one, 1.0, contact("fingertip")).unwrap();
    writer.write_contact(two, 1.0, contact("thumb")).unwrap();
    writer.write_wrench(left, 2.0, &wrench(3.0)).unwrap();
    let crooked = RecordedContact { normal: Vector3::new(f64::NAN, 0.0, 1.0), ..contact("thumb") };
    writer.write_contact(one, 2.0, crooked).unwrap();
    // The same time twice, and one that goes back.
    writer.write_wrench(left, 2.0, &wrench(4.0)).unwrap();
    let crooked = Wrench::from_components(&Vector6::new(5.0, f64::NAN, -1.0, 0.0, f64::INFINITY, 0.0));
    writer.write_wrench(right, 1.5, &crooked).unwrap();
    writer.finish().unwrap();
}

#[test]
fn rows_are_put_together_by_their_times() {
    let folder = Folder::new();
    foreign(&folder);
    let said = folder.succeed(&["convert", "a.mcap", "a.csv"]);
    let expected = "a.mcap → a.csv: 5 wrenches, 1 signals, 2 contacts, 4 rows\n\
        Note: topic /robot/left wrist/ft has the columns robot-left-wrist-ft_…\n\
        Note: topic /robot/right/ft has the columns robot-right-ft_…\n\
        Note: topic /daq has the columns without a name\n\
        Note: topic /one has the columns without a name\n\
        Note: 2 rows have a time that is not after that of the row before; other commands pass over them\n\
        Lost: 1 messages of /two, which CSV has no columns for; 4 numbers that are not finite (NaN becomes an empty \
        cell); 1 names of contacts\n";
    assert_eq!(said, expected);
    let rows = Contacts::parse(&folder.read("a.csv"));
    assert_eq!(rows.numbers("t_s"), [1.0, 2.0, 2.0, 1.5]);
    let cells =
        |name: &str| rows.words(name).iter().map(|cell| cell.parse().ok()).collect::<Vec<Option<f64>>>();
    assert_eq!(cells("robot-left-wrist-ft_fx_N"), [Some(1.0), Some(3.0), Some(4.0), None]);
    assert_eq!(cells("robot-right-ft_fx_N"), [Some(2.0), None, None, Some(5.0)]);
    assert_eq!(cells("robot-right-ft_fy_N"), [Some(0.0), None, None, None]);
    assert_eq!(cells("v1_V"), [Some(0.5), None, None, None]);
    assert_eq!(cells("v2_V"), [None; 4]);
    assert_eq!(cells("v3_V"), [Some(0.25), None, None, None]);
    assert_eq!(cells("contact_nx"), [Some(0.0), None, None, None]);
    assert_eq!(cells("contact_y_m"), [Some(0.002), Some(0.002), None, None]);
}

/// A sensor has one frame in a file of columns: the other's name is told, one that is the same is not lost.
#[test]
fn of_two_frames_of_a_sensor_the_second_is_told() {
    let folder = Folder::new();
    for (frame, lost) in [("gauges", "Lost: 1 names of frames: gauges\n"), ("palm", "Nothing was lost.\n")] {
        let mut writer = McapWriter::new(File::create(folder.path("a.mcap")).unwrap()).unwrap();
        let wrenches = writer.wrenches("/fingertip/wrench", "palm").unwrap();
        let gauges = writer.signals("/fingertip/signals", frame).unwrap();
        writer.write_wrench(wrenches, 1.0, &wrench(1.0)).unwrap();
        let signals = RecordedSignals { unit: "V".to_owned(), values: vec![0.5; 6] };
        writer.write_signals(gauges, 1.0, signals).unwrap();
        writer.finish().unwrap();
        let said = folder.succeed(&["convert", "a.mcap", "a.csv", "--overwrite"]);
        assert!(said.ends_with(lost), "{said}");
        assert!(folder.read("a.csv").starts_with("# frame_id: palm\nt_s,"));
    }
}

#[test]
fn what_cannot_be_columns_is_refused() {
    let folder = Folder::new();
    let write = |topics: &[(&str, f64, usize)]| {
        let mut writer = McapWriter::new(File::create(folder.path("a.mcap")).unwrap()).unwrap();
        let mut known: Vec<(&str, _)> = Vec::new();
        for (name, time, width) in topics {
            let topic = match known.iter().find(|(other, _)| other == name) {
                Some((_, topic)) => *topic,
                None => writer.signals(name, "tip").unwrap(),
            };
            known.push((name, topic));
            let signals = RecordedSignals { unit: "V".to_owned(), values: vec![0.5; *width] };
            writer.write_signals(topic, *time, signals).unwrap();
        }
        writer.finish().unwrap();
    };
    let convert = ["convert", "a.mcap", "a.csv", "--overwrite"];
    write(&[("/daq", 1.0, 6), ("/daq", 2.0, 5)]);
    let error = folder.fail(1, &convert);
    assert!(error.contains("topic /daq changes its number of values or their unit at 2 s"), "{error}");
    write(&[]);
    assert!(folder.fail(1, &convert).contains("it holds no wrenches, signals or contacts"));
    write(&[("/a b", 1.0, 2), ("/a-b", 1.0, 2)]);
    assert!(folder.fail(1, &convert).contains("two topics would both be the column a-b_v1_V"));
    assert!(!folder.path("a.csv").exists());
    // A dummy gauge is one only if it is one.
    write(&[("/fingertip/signals", 1.0, 2), ("/fingertip/dummy", 1.0, 1), ("/fingertip/x/dummy", 1.0, 2)]);
    folder.succeed(&convert);
    assert!(
        folder.read("a.csv").contains("\nt_s,v1_V,v2_V,dummy_V,x_v1_V,x_v2_V\n"),
        "{}",
        folder.read("a.csv")
    );
}

#[test]
fn analysis_of_mcap_reads_what_conversion_writes() {
    let folder = Folder::new();
    foreign(&folder);
    folder.write(
        "scene.toml",
        "version = 1\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.5\n",
    );
    folder.succeed(&["convert", "a.mcap", "a.csv"]);
    let analyze = |recording: &'static str| {
        let more = ["--sensor", "robot-left-wrist-ft", "--no-report"];
        let said = folder.succeed(&[&["analyze", recording, "--scene", "scene.toml"][..], &more].concat());
        (said, folder.read("contacts.csv"))
    };
    let (said, contacts) = analyze("a.mcap");
    assert_eq!(contacts, analyze("a.csv").1);
    assert!(said.contains("topic /robot/left wrist/ft has the columns robot-left-wrist-ft_…"), "{said}");
}

/// Half a second of a sensor, a row every 100 ms from 5 s on.
const HALF_A_SECOND: &str = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n5,0,0,0,0,0,0\n5.125,1,0,0,0,0,0\n5.25,2,0,0,0,0,0\n\
    5.375,3,0,0,0,0,0\n5.5,4,0,0,0,0,0\n";

/// What lies between two times behind the first row is taken, counted and told, of either format.
#[test]
fn a_part_of_a_recording_is_converted_told_and_looked_at() {
    let folder = Folder::new();
    folder.write("a.csv", HALF_A_SECOND);
    let part = ["--start", "0.125", "--end", "0.375"];
    let with = |command: &[&'static str]| [command, &part].concat();
    let note = "only what was recorded from 0.125 s to 0.375 s behind the first row";
    let said = folder.succeed(&with(&["convert", "a.csv", "a.mcap"]));
    assert_eq!(said, format!("a.csv → a.mcap: 3 wrenches\nNote: {note}\nNothing was lost.\n"));
    let found: Vec<_> = entries(&folder, "a.mcap").iter().map(|entry| entry.2).collect();
    assert_eq!(found, [5.125, 5.25, 5.375]);
    folder.succeed(&["convert", "a.csv", "whole.mcap"]);
    let said = folder.succeed(&with(&["convert", "whole.mcap", "part.csv"]));
    assert_eq!(said, format!("whole.mcap → part.csv: 3 wrenches, 3 rows\nNote: {note}\nNothing was lost.\n"));
    let rows = Contacts::parse(&folder.read("part.csv"));
    assert_eq!((rows.numbers("t_s"), rows.numbers("fx_N")), (vec![5.125, 5.25, 5.375], vec![1.0, 2.0, 3.0]));
    for file in ["a.csv", "whole.mcap"] {
        let said = folder.succeed(&with(&["info", file]));
        assert!(
            said.contains(note) && said.contains("0.125 s to 0.375 s") | said.contains("5.125 s to 5.375 s"),
            "{said}"
        );
        let output = folder.run(&with(&["health", file]));
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(said.contains("3 samples at 8 a second") && said.contains(note), "{said}");
    }
    // Where nothing is left, nothing is written, and it is said why.
    let gap = HALF_A_SECOND.replace("5.25,2,0,0,0,0,0\n", "");
    folder.write("gap.csv", &gap);
    folder.succeed(&["convert", "gap.csv", "gap.mcap"]);
    for arguments in [
        &["convert", "gap.csv", "none.mcap"][..],
        &["convert", "gap.mcap", "none.csv"],
        &["health", "gap.csv"],
    ] {
        let behind = folder.fail(1, &[arguments, &["--start", "9"]].concat());
        assert!(
            behind.contains("--start 9 must be before the end of the recording"),
            "{arguments:?}: {behind}"
        );
        let between = folder.fail(1, &[arguments, &["--start", "0.2", "--end", "0.3"]].concat());
        assert!(
            between.contains("--start 0.2 has no row between itself and --end"),
            "{arguments:?}: {between}"
        );
        let turned = folder.fail(1, &[arguments, &["--start", "2", "--end", "1"]].concat());
        assert!(turned.contains("--end 1 must not be before --start"), "{arguments:?}: {turned}");
    }
    assert!(!folder.path("none.mcap").exists() && !folder.path("none.csv").exists());
}

/// Several recordings go into a folder, each under its own name; two of one name are told apart by being refused, before
/// anything is written.
#[test]
fn several_recordings_are_converted_into_a_folder() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("out")).unwrap();
    std::fs::create_dir(folder.path("sub")).unwrap();
    folder.write("a.csv", HALF_A_SECOND);
    folder.write("sub/a.csv", HALF_A_SECOND);
    folder.write("b.csv", &HALF_A_SECOND.replace("5.5,4", "6,4"));
    let error = folder.fail(1, &["convert", "a.csv", "sub/a.csv", "out"]);
    assert!(error.contains("out/a.mcap") && error.contains("give two outputs two names"), "{error}");
    let error = folder.fail(1, &["convert", "a.csv", "b.csv", "none"]);
    assert!(error.contains("must be a folder that is there, which none is not"), "{error}");
    let error = folder.fail(1, &["convert", "a.csv", "none.csv", "out"]);
    assert!(error.contains("cannot read recording none.csv"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path("out")).unwrap().count(), 0);
    let said = folder.succeed(&["convert", "a.csv", "b.csv", "out"]);
    assert!(said.contains("a.csv → out/a.mcap: 5 wrenches\n"), "{said}");
    let last = |name: &str| entries(&folder, name).last().unwrap().2;
    assert_eq!((last("out/a.mcap"), last("out/b.mcap")), (5.5, 6.0));
    // Back again: of one, too, the folder takes it under its own name, and what is there is kept.
    folder.succeed(&["convert", "out/b.mcap", "sub"]);
    assert_eq!(folder.read("sub/b.csv").lines().count(), 6);
    let error = folder.fail(1, &["convert", "out/a.mcap", "out/b.mcap", "sub"]);
    assert!(error.contains("it exists already"), "{error}");
    assert_eq!(folder.read("sub/a.csv"), HALF_A_SECOND);
}
