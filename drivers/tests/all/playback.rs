//! Recordings played as sources.
#![cfg(feature = "mcap")]

use std::io::Cursor;

use fingertip_drivers::playback::McapPlayback;
use fingertip_drivers::{SourceError, SourceErrorKind, WrenchSource};
use fingertip_recordings::mcap::{McapError, McapWriter};
use fingertip_wrench::Wrench;
use nalgebra::Vector3;

fn wrench(number: u32) -> Wrench<f64> {
    let x = f64::from(number);
    Wrench::on_fingertip(Vector3::new(x, -x, 0.1 * x), Vector3::new(1e-3 * x, 0.0, -1.0))
}

fn file(samples: u32) -> Vec<u8> {
    let mut writer = McapWriter::new(Cursor::new(Vec::new())).unwrap();
    let wrenches = writer.wrenches("/tip/wrench", "tip").unwrap();
    for number in 0..samples {
        writer.write_wrench(wrenches, 1000.0 + f64::from(number) * 1e-3, &wrench(number)).unwrap();
    }
    writer.write_wrench(wrenches, 2000.0, &(wrench(1) * f64::NAN)).unwrap();
    writer.finish().unwrap().into_inner()
}

#[test]
fn the_wrenches_of_a_topic_are_played() {
    let file = file(2000);
    let mut playback = McapPlayback::new(Cursor::new(&file), "").unwrap();
    let mut played = 0;
    while let Some(sample) = playback.next_wrench().unwrap() {
        assert_eq!(sample.value, wrench(played));
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
    let file = file(20_000);
    let mut playback = McapPlayback::new(Cursor::new(&file[..file.len() / 2]), "").unwrap();
    let mut played = 0;
    let error = loop {
        match playback.next_wrench() {
            Ok(sample) => assert_eq!(sample.unwrap().value, wrench(played)),
            Err(error) => break error,
        }
        played += 1;
    };
    assert!(matches!(error, McapError::File(_)) && played > 1000, "{played}: {error}");
    assert_eq!(error.kind(), SourceErrorKind::Corrupt);
}
