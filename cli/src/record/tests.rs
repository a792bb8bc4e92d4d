use core::time::Duration;
use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use clap::Parser;
use fingertip::wrench::Wrench;
use fingertip_bridges::About;
use indicatif::ProgressBar;
use nalgebra::{Vector3, Vector6};

use super::{Event, NEWS, Reading, RecordArguments, Recording, Stream, StreamOptions};
use crate::args::{Arguments, Command};
use crate::felt::SceneFeel;
use crate::output::Outputs;
use crate::scene::load_or_simulated;
use crate::sensor::{Feed, Losses, Next, SensorError};

/// A sensor that has nothing more to say, and has lost seven samples.
struct Over;

impl Feed for Over {
    fn next(&mut self) -> Result<Next, SensorError> {
        Ok(Next::End)
    }
    fn losses(&self) -> Losses {
        Losses { lost: Some(7), ..Losses::default() }
    }
}

fn over() -> Stream {
    let options = StreamOptions { silence: Duration::from_secs(9), reconnect: false };
    Stream::new(Box::new(|| Ok(Box::new(Over) as Box<dyn Feed>)), options).unwrap()
}

/// What is asked on the command line, for a file of this name that is not there.
fn arguments(name: &str, more: &[&str]) -> RecordArguments {
    let file = format!("fingertip-record-{}-{name}.csv", std::process::id());
    let path: PathBuf = std::env::temp_dir().join(file);
    let _ = fs::remove_file(&path);
    let start = ["fingertip", "record", "sim", "-o", path.to_str().unwrap()];
    match Arguments::parse_from(start.iter().chain(more)).command {
        Command::Record(arguments) => arguments,
        _ => panic!("another command"),
    }
}

fn outputs(arguments: &RecordArguments) -> Outputs {
    Outputs::guard(arguments.overwrite, "recording", [], [&arguments.output]).unwrap()
}

fn reading(value: f64) -> Reading {
    let wrench = Wrench::from_components(&Vector6::repeat(value));
    Reading { time: None, wrench, volts: None }
}

/// The rows that were written, and the file gone.
fn written(arguments: &RecordArguments) -> Vec<String> {
    let text = fs::read_to_string(&arguments.output).unwrap();
    fs::remove_file(&arguments.output).unwrap();
    text.lines().skip(1).map(str::to_owned).collect()
}

#[test]
fn what_is_recorded_and_what_is_not_is_counted() {
    let arguments = arguments("counts", &["--samples", "5"]);
    let outputs = outputs(&arguments);
    let mut recording = Recording::new(&arguments, &outputs, About::default());
    for (time, value) in
        [(1.0, 1.0), (1.5, f64::NAN), (2.0, 2.0), (2.0, 3.0), (1.5, 4.0), (3.000_000_000_4, 5.0)]
    {
        assert!(!recording.is_full());
        recording.take(time, &reading(value), None).unwrap();
    }
    assert!(recording.is_full());
    let complaints: Vec<_> = (0..5).map(|_| recording.fault("cut")).collect();
    let said = |text: &str| Some(text.to_owned());
    let last = "cut (further ones are only counted)";
    assert_eq!(complaints, [said("cut"), said("cut"), said(last), None, None]);
    let summary = recording.finish(&over()).unwrap().unwrap();
    let expected = format!(
        "5 samples in 2 s (2 samples/s)\nLink: 7 lost, 0 late, 0 repeated, 0 damaged\n\
         Samples that the sensor marked as bad or that were damaged: 5\n\
         Samples that are not finite, left out: 1\n\
         Samples whose time is not after that of the one before: 2\nWritten: {}\n",
        arguments.output.display()
    );
    assert_eq!(summary, expected);
    let rows = written(&arguments);
    let times: Vec<f64> = rows.iter().map(|row| row.split(',').next().unwrap().parse().unwrap()).collect();
    assert_eq!(times, [1.0, 2.0, 2.0, 1.5, 3.0]);
}

#[test]
fn one_sample_has_no_rate_and_none_no_file() {
    let one = arguments("one", &[]);
    let of_one = outputs(&one);
    let recording = || Recording { is_quiet: true, ..Recording::new(&one, &of_one, About::default()) };
    assert!(recording().finish(&over()).unwrap().is_none());
    let mut recording = recording();
    assert_eq!(recording.fault("cut"), None);
    recording.take(4.0, &reading(1.0), None).unwrap();
    let summary = recording.finish(&over()).unwrap().unwrap();
    assert!(summary.starts_with("1 samples in 0 s\nLink: "), "{summary}");
    assert_eq!(written(&one).len(), 1);
    // Two samples at one time: no rate either.
    let two = arguments("two", &[]);
    let of_two = outputs(&two);
    let mut recording = Recording::new(&two, &of_two, About::default());
    (0..2).for_each(|_| recording.take(4.0, &reading(1.0), None).unwrap());
    assert!(recording.finish(&over()).unwrap().unwrap().starts_with("2 samples in 0 s\n"));
    assert_eq!(written(&two).len(), 2);
}

#[test]
fn a_duration_counts_from_the_first_sample_that_is_recorded() {
    let arguments = arguments("duration", &["--duration", "0.5", "--tare", "1", "--scene", "sim"]);
    let outputs = outputs(&arguments);
    let mut recording = Recording::new(&arguments, &outputs, About { has_scene: true, ..About::default() });
    let scene = load_or_simulated("sim".as_ref()).unwrap();
    let mut feel = SceneFeel::new(&scene, true);
    // A press of 2 N on the tip; its half is the zero of the rest, so that the other half is felt.
    let press = |share: f64| {
        let wrench = Wrench::on_fingertip(Vector3::new(-2.0 * share, 0.0, 0.0), Vector3::zeros());
        Reading { time: None, wrench, volts: None }
    };
    for time in [0.0, 0.25, 0.5, 0.75, 1.0, 1.25] {
        let share = if time < 1.0 { 0.5 } else { 1.0 };
        recording.take(time, &press(share), Some(&mut feel)).unwrap();
        assert!(!recording.is_full());
        let so_far = match time {
            1.0 => "1 samples, 0 s (Ctrl-C ends it)",
            1.25 => "2 samples, 0.25 s (Ctrl-C ends it)",
            _ => "0 samples, 0 s (taking the zero: do not touch)",
        };
        assert_eq!(recording.so_far(), so_far, "{time}");
    }
    recording.take(1.5, &press(0.5), Some(&mut feel)).unwrap();
    assert!(recording.is_full());
    let summary = recording.finish(&over()).unwrap().unwrap();
    assert!(summary.starts_with("3 samples in 0.5 s (4 samples/s), 2 with a contact\n"), "{summary}");
    assert!(summary.contains("Zero taken off [N, N·m]: -1.00, 0, 0, 0, 0, 0\n"), "{summary}");
    let rows = written(&arguments);
    assert!(rows[0].starts_with("1.0,-1.0,") && rows[0].contains(",0.013,0.0,0.0,"), "{rows:?}");
    assert!(rows[2].ends_with(",,,,,,,,,,,,"), "{rows:?}");
}

/// The terminal is told every so often, not with every sample.
#[test]
fn the_line_of_news_says_how_far_it_is() {
    let arguments = arguments("news", &[]);
    let outputs = outputs(&arguments);
    let line = ProgressBar::hidden();
    let news = Some(line.clone());
    let recording = Recording::new(&arguments, &outputs, About::default());
    // The next is due in an hour.
    let mut recording = Recording { news, told: Instant::now() + Duration::from_hours(1), ..recording };
    recording.take(1.0, &reading(1.0), None).unwrap();
    recording.news();
    assert_eq!(line.message(), "");
    recording.told = Instant::now().checked_sub(2 * NEWS).unwrap();
    let before = recording.told;
    recording.news();
    assert_eq!(line.message(), "1 samples, 0 s (Ctrl-C ends it)");
    assert!(recording.told > before + NEWS, "the next is due at once");
    recording.finish(&over()).unwrap();
    assert_eq!(written(&arguments).len(), 1);
}

/// A sensor that sends no times, and goes after each sample.
struct Once(bool);

impl Feed for Once {
    fn next(&mut self) -> Result<Next, SensorError> {
        let first = core::mem::replace(&mut self.0, false);
        Ok(if first { Next::Reading(reading(1.0)) } else { Next::End })
    }
    fn losses(&self) -> Losses {
        Losses::default()
    }
}

#[test]
fn what_became_of_the_connection_is_said() {
    let arguments = arguments("connection", &[]);
    let outputs = outputs(&arguments);
    let options = StreamOptions { silence: Duration::from_secs(9), reconnect: true };
    let mut stream = Stream::new(Box::new(|| Ok(Box::new(Once(true)) as Box<dyn Feed>)), options).unwrap();
    let mut recording = Recording::new(&arguments, &outputs, About::default());
    while recording.samples < 3 {
        if let Event::Sample(time, reading) = stream.next().unwrap() {
            recording.take(time, &reading, None).unwrap();
        }
    }
    let summary = recording.finish(&stream).unwrap().unwrap();
    let expected =
        "\nConnected anew 2 times\nTimes are those of arrival at this computer: the sensor sends none\n";
    assert!(summary.contains(expected), "{summary}");
    assert_eq!(written(&arguments).len(), 3);
}

/// Why it ended stands alone, unless something was recorded.
#[test]
fn an_end_says_how_far_the_recording_is() {
    let arguments = arguments("end", &[]);
    let outputs = outputs(&arguments);
    let mut recording = Recording::new(&arguments, &outputs, About::default());
    assert!(matches!(recording.ended(SensorError::Closed), SensorError::Closed));
    for time in [1.0, 3.5] {
        recording.take(time, &reading(1.0), None).unwrap();
    }
    let said = recording.ended(SensorError::Closed).to_string();
    assert_eq!(
        said,
        "the line was closed 2.5 s after the first sample, behind 2 samples, which are recorded"
    );
    recording.finish(&over()).unwrap();
    assert_eq!(written(&arguments).len(), 2);
}
