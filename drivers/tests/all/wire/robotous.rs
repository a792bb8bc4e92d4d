//! Robotous' serial frames, numbers big-endian: 55, data, the sum of the data, AA.

use fingertip_drivers::sensors::AxisCounts;
use fingertip_drivers::sensors::line::LineDecoder;
use fingertip_drivers::sensors::robotous::{FORMAT, Reading, Request, RobotousDecoder, RobotousFault};
use fingertip_drivers::{SourceError, SourceErrorKind};

use super::{Decoded, components, decoded, sum};

/// Answer 0x0B, counts 50, −100, 25, 2000, −1000, 256, and the overload byte; two bytes are reserved.
fn frame(id: u8, overload: u8) -> [u8; 19] {
    let mut bytes =
        [0x55, id, 0, 50, 0xFF, 0x9C, 0, 25, 0x07, 0xD0, 0xFC, 0x18, 1, 0, overload, 0x77, 0x88, 0, 0xAA];
    bytes[17] = sum(&bytes[1..17]) as u8;
    bytes
}

#[test]
fn a_reading_has_its_fields_in_their_places() {
    let counts = [50, -100, 25, 2000, -1000, 256];
    for (id, streamed) in [(0x0A, false), (0x0B, true)] {
        let expected = Reading { streamed, counts, overload: 0x21 };
        assert_eq!((FORMAT.frame)(&frame(id, 0x21)), Some(expected));
        let mut emitted = frame(id, 0x21);
        // What is reserved is sent as zero.
        [emitted[15], emitted[16]] = [0, 0];
        emitted[17] = sum(&emitted[1..17]) as u8;
        assert_eq!(expected.emit_serial(), emitted);
    }
    let sample = decoded(&mut RobotousDecoder::rft60().unwrap(), &frame(0x0B, 0)).unwrap().unwrap();
    for (found, expected) in components(&sample).into_iter().zip([1.0, -2.0, 0.5, 1.0, -0.5, 0.128_f64]) {
        assert!((found - expected).abs() <= 2.0 * f64::EPSILON * expected.abs());
    }
    assert_eq!(sample.time, None);
}

#[test]
fn every_bit_of_the_overload_byte_is_an_overload() {
    let counts = AxisCounts::uniform(50.0, 2000.0).unwrap();
    for bit in 0..8 {
        let result: Decoded<_> = decoded(&mut RobotousDecoder::new(counts), &frame(0x0B, 1 << bit)).unwrap();
        let fault = result.unwrap_err();
        assert_eq!(fault, RobotousFault::Overload { bits: 1 << bit });
        assert_eq!(fault.kind(), SourceErrorKind::Overload);
    }
}

#[test]
fn marks_sum_and_answer_must_be_right() {
    for at in [0, 17, 18] {
        let mut bytes = frame(0x0B, 0);
        bytes[at] ^= 1;
        assert_eq!((FORMAT.frame)(&bytes), None, "{at}");
    }
    for id in [0, 0x09, 0x0C, 0x11, 0xFF] {
        assert_eq!((FORMAT.frame)(&frame(id, 0)), None, "{id}");
        // The decoder passes over them, and goes on.
        let mut decoder = RobotousDecoder::rft60().unwrap();
        assert!(decoded(&mut decoder, &frame(id, 0)).is_none());
        assert!(decoded(&mut decoder, &frame(0x0A, 0)).unwrap().is_ok());
        assert_eq!(LineDecoder::<f64>::statistics(&decoder).frames, 1);
    }
}

#[test]
fn a_frame_begins_with_its_mark_and_a_reading() {
    let may_begin = FORMAT.may_begin;
    assert!(may_begin(&[]) && may_begin(&[0x55]) && may_begin(&[0x55, 0x0A, 3]) && may_begin(&[0x55, 0x0B]));
    assert!(!may_begin(&[0xAA]) && !may_begin(&[0x54, 0x0B]) && !may_begin(&[0x55, 0x0C]));
}

#[test]
fn each_request_has_its_code() {
    let requests = [
        (Request::Single, 0x0A, 0),
        (Request::Stream, 0x0B, 0),
        (Request::Stop, 0x0C, 0),
        (Request::Bias { set: false }, 0x11, 0),
        (Request::Bias { set: true }, 0x11, 1),
    ];
    for (request, code, option) in requests {
        let data = [code, option, 0, 0, 0, 0, 0, 0];
        assert_eq!(request.emit(), data);
        assert_eq!(Request::parse(&data), Some(request));
        let serial = [0x55, code, option, 0, 0, 0, 0, 0, 0, code + option, 0xAA];
        assert_eq!(request.emit_serial(), serial);
        assert_eq!(Request::parse_serial(&serial), Some(request));
        for at in [0, 9, 10] {
            let mut wrong = serial;
            wrong[at] ^= 1;
            assert_eq!(Request::parse_serial(&wrong), None, "{at}");
        }
    }
    for unknown in [0, 0x09, 0x0D, 0x10, 0x12] {
        assert_eq!(Request::parse(&[unknown, 0, 0, 0, 0, 0, 0, 0]), None);
    }
}
