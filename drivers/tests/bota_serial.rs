//! Bota's sensor driver against the simulated sensor.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]
#![cfg(all(feature = "bota-serial", feature = "simulation"))]

use fingertip_drivers::bota_serial::{BotaDecoder, BotaFault, Frame};
use fingertip_drivers::line::{LineDecoder, LineError, LineFaults, LineSensor, SimulatedLine};
use fingertip_drivers::{Sample, SourceError, SourceErrorKind, WrenchSource};
use fingertip_wrench::Wrench;

fn frame(number: u32) -> Frame {
    let x = number as f32;
    Frame {
        components: [x, -x, 1.0, 2.0, 3.0, -0.5 * x],
        // Wraps around on the way.
        microseconds: (u32::MAX - 5_000_000).wrapping_add(number * 1250),
        ..Frame::default()
    }
}

type Next = Result<Option<Sample<f64, Wrench<f64>>>, LineError<std::io::Error, BotaFault>>;

#[test]
fn a_bad_line_costs_the_damaged_frames_and_no_other() {
    let faults = LineFaults { bit_flip: 0.01, lost_byte: 0.01, lost_frame: 0.01, noise: 0.02, seed: 3 };
    let mut line = SimulatedLine::new(faults);
    let count = 200_000;
    for number in 0..count {
        line.send(&frame(number).emit());
    }
    let damaged = line.damaged();
    let mut sensor = LineSensor::new(line, BotaDecoder::new());
    let (mut given, mut last, mut start) = (0, -1.0, None);
    while let Some(sample) = {
        let next: Next = sensor.next_wrench();
        next.unwrap()
    } {
        let (number, time) = (sample.value.force().x, sample.time.unwrap());
        assert_eq!(sample.value, frame_wrench(number));
        assert!(number > last);
        let start = *start.get_or_insert(number);
        assert!((time - (number - start) * 1.25e-3).abs() < 1e-9);
        (given, last) = (given + 1, number);
    }
    println!(
        "{count} frames, {damaged} damaged, {given} given, {} bytes skipped",
        LineDecoder::<f64>::statistics(sensor.decoder()).skipped
    );
    assert_eq!(given, u64::from(count) - damaged);
}

fn frame_wrench(number: f64) -> Wrench<f64> {
    Wrench::from_components(&nalgebra::Vector6::new(number, -number, 1.0, 2.0, 3.0, -0.5 * number))
}

#[test]
fn what_the_sensor_says_of_itself_is_an_error() {
    let mut line = SimulatedLine::new(LineFaults::default());
    line.send(&Frame { status: Frame::OVERRANGE, ..frame(1) }.emit());
    line.send(&Frame { status: Frame::INVALID, ..frame(2) }.emit());
    line.send(&Frame { components: [f32::NAN; 6], ..frame(3) }.emit());
    line.send(&frame(4).emit());
    let mut sensor = LineSensor::new(line, BotaDecoder::new());
    for kind in [SourceErrorKind::Overload, SourceErrorKind::DeviceFault, SourceErrorKind::DeviceFault] {
        let next: Next = sensor.next_wrench();
        assert_eq!(next.unwrap_err().kind(), kind);
    }
    let next: Next = sensor.next_wrench();
    // Time runs on over the samples that were not given.
    assert!((next.unwrap().unwrap().time.unwrap() - 3.75e-3).abs() < 1e-12);
    let next: Next = sensor.next_wrench();
    assert!(next.unwrap().is_none());
}

#[test]
fn a_wrong_baud_rate_and_a_silent_line_are_told() {
    let mut sensor = LineSensor::new(std::io::repeat(0x55), BotaDecoder::new());
    let next: Next = sensor.next_wrench();
    assert!(matches!(next, Err(LineError::NoFrame { .. })));
    struct Silent;
    impl std::io::Read for Silent {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::TimedOut.into())
        }
    }
    let next: Next = LineSensor::new(Silent, BotaDecoder::new()).next_wrench();
    assert_eq!(next.unwrap_err().kind(), SourceErrorKind::Timeout);
}
