//! Recordings played as sources.
#![cfg(feature = "mcap")]

use std::io::Cursor;

use fingertip_drivers::playback::McapPlayback;
use fingertip_drivers::{Source, SourceError, SourceErrorKind};
use fingertip_recordings::mcap::{McapError, McapWriter};
use fingertip_test_support::mcap::{channel, data_end, definitions, file, message, wrench};
use fingertip_wrench::Wrench;
use nalgebra::Vector3;

fn load(number: u32) -> Wrench<f64> {
    let x = f64::from(number);
    Wrench::on_fingertip(Vector3::new(x, -x, 0.1 * x), Vector3::new(1e-3 * x, 0.0, -1.0))
}

fn recording(samples: u32) -> Vec<u8> {
    let mut writer = McapWriter::new(Cursor::new(Vec::new())).unwrap();
    let wrenches = writer.wrenches("/tip/wrench", "tip").unwrap();
    for number in 0..samples {
        writer.write_wrench(wrenches, 1000.0 + f64::from(number) * 1e-3, &load(number)).unwrap();
    }
    writer.write_wrench(wrenches, 2000.0, &(load(1) * f64::NAN)).unwrap();
    writer.finish().unwrap().into_inner()
}

#[test]
fn the_wrenches_of_a_topic_are_played() {
    let file = recording(2000);
    let mut playback = McapPlayback::new(Cursor::new(&file), "").unwrap();
    let mut played = 0;
    while let Some(sample) = playback.next_sample().unwrap() {
        assert_eq!(sample.value, load(played));
        played += 1;
    }
    assert_eq!((played, playback.not_finite()), (2000, 1));
    assert!(McapPlayback::new(Cursor::new(&file), "/tip/wrench").is_ok());
    let error = McapPlayback::new(Cursor::new(&file), "/other").unwrap_err();
    assert!(error.to_string().contains("/tip/wrench"), "{error}");
    assert_eq!(error.kind(), SourceErrorKind::Unsupported);
}

#[test]
fn what_is_whole_of_a_file_that_was_cut_is_played() {
    let file = recording(20_000);
    let mut playback = McapPlayback::new(Cursor::new(&file[..file.len() / 2]), "").unwrap();
    let mut played = 0;
    let error = loop {
        match playback.next_sample() {
            Ok(sample) => assert_eq!(sample.unwrap().value, load(played)),
            Err(error) => break error,
        }
        played += 1;
    };
    assert!(matches!(error, McapError::Cut) && played > 1000, "{played}: {error}");
    assert_eq!(error.kind(), SourceErrorKind::Corrupt);
}

#[test]
fn a_topic_is_chosen_by_name_or_by_being_the_only_one_with_wrenches() {
    let other = channel(2, 1, "/other", "cdr");
    let both = file(&[
        definitions(),
        other,
        message(1, 0, &wrench()),
        message(2, 0, &wrench()),
        message(1, 0, &wrench()),
        data_end(),
    ]);
    let played = |topic| {
        let mut playback = McapPlayback::new(Cursor::new(&both), topic)?;
        let mut played = 0;
        while playback.next_sample()?.is_some() {
            played += 1;
        }
        Ok::<_, McapError>(played)
    };
    assert_eq!((played("/tip").unwrap(), played("/other").unwrap()), (2, 1));
    for topic in ["", "/"] {
        let error = played(topic).unwrap_err();
        assert!(error.to_string().ends_with("there are: /tip, /other"), "{error}");
        assert_eq!(error.kind(), SourceErrorKind::Unsupported);
    }
    // What is wrong with a file is said if it hides all wrenches, and is met in its place if it does not.
    let hidden = file(&[definitions(), vec![5]]);
    assert!(matches!(McapPlayback::new(Cursor::new(&hidden), ""), Err(McapError::Cut)));
    let behind = file(&[definitions(), message(1, 0, &wrench()), vec![5]]);
    let mut playback = McapPlayback::new(Cursor::new(&behind), "").unwrap();
    assert!(playback.next_sample().unwrap().is_some());
    assert!(playback.next_sample().is_err());
}

#[test]
fn a_damaged_message_is_met_in_its_place() {
    let file = file(&[definitions(), message(1, 0, &wrench()[..30]), message(1, 0, &wrench()), data_end()]);
    let mut playback = McapPlayback::new(Cursor::new(&file), "/tip").unwrap();
    let error = playback.next_sample().unwrap_err();
    assert!(matches!(error, McapError::Message { .. }) && error.kind() == SourceErrorKind::Corrupt);
    assert!(playback.next_sample().unwrap().is_some() && playback.next_sample().unwrap().is_none());
}
