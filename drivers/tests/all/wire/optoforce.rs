//! OptoForce's DAQ protocol, big-endian: AA 07 08 10, count, status, six counts, the sum of all before it.

use fingertip_drivers::sensors::AxisCounts;
use fingertip_drivers::sensors::optoforce::{
    Configuration, Filter, OptoForceDecoder, OptoForceFault, Rate, Reading,
};
use fingertip_drivers::{SourceError, SourceErrorKind};

use super::{Decoded, components, decoded, sum};

fn frame(count: [u8; 2], status: [u8; 2], counts: [u8; 12]) -> [u8; 22] {
    let mut bytes = [0; 22];
    bytes[..4].copy_from_slice(&[0xAA, 7, 8, 16]);
    bytes[4..6].copy_from_slice(&count);
    bytes[6..8].copy_from_slice(&status);
    bytes[8..20].copy_from_slice(&counts);
    let sum = sum(&bytes[..20]);
    bytes[20..].copy_from_slice(&[(sum >> 8) as u8, sum as u8]);
    bytes
}

/// 1, −2, 256, −256, 32767, −32768.
const COUNTS: [u8; 12] = [0, 1, 0xFF, 0xFE, 1, 0, 0xFF, 0, 0x7F, 0xFF, 0x80, 0];

fn counts() -> AxisCounts {
    AxisCounts::uniform(2.0, 4.0).unwrap()
}

#[test]
fn a_reading_has_its_fields_in_their_places() {
    let bytes = frame([0x12, 0x34], [0x56, 0x78], COUNTS);
    let expected = Reading { count: 0x1234, status: 0x5678, counts: [1, -2, 256, -256, 32_767, -32_768] };
    assert_eq!(Reading::parse(&bytes), Some(expected));
    assert_eq!(expected.emit(), bytes);
    let sample =
        decoded(&mut OptoForceDecoder::new(counts()), &frame([0, 0], [0, 0], COUNTS)).unwrap().unwrap();
    assert_eq!(components(&sample), [0.5, -1.0, 128.0, -64.0, 8191.75, -8192.0]);
    assert_eq!(sample.time, None);
}

#[test]
fn header_and_sum_must_be_right() {
    let sound = frame([0, 1], [0, 0], COUNTS);
    for at in 0..4 {
        // With a sum that fits, the header alone is wrong.
        let mut bytes = sound;
        bytes[at] ^= 1;
        let sum = sum(&bytes[..20]);
        bytes[20..].copy_from_slice(&[(sum >> 8) as u8, sum as u8]);
        assert_eq!(Reading::parse(&bytes), None, "{at}");
    }
    for at in [20, 21] {
        let mut bytes = sound;
        bytes[at] ^= 1;
        assert_eq!(Reading::parse(&bytes), None, "{at}");
    }
}

#[test]
fn bits_4_to_9_are_overloads_and_the_others_faults() {
    for bit in 0..16_u32 {
        let status = 1_u16 << bit;
        let bytes = frame([0, 0], [(status >> 8) as u8, status as u8], COUNTS);
        let result: Decoded<_> = decoded(&mut OptoForceDecoder::new(counts()), &bytes).unwrap();
        let (expected, kind) = if (4..=9).contains(&bit) {
            (OptoForceFault::Overload { status }, SourceErrorKind::Overload)
        } else {
            (OptoForceFault::Fault { status }, SourceErrorKind::DeviceFault)
        };
        assert_eq!(result, Err(expected));
        assert_eq!(expected.kind(), kind);
    }
    let both = frame([0, 0], [0x80, 0x10], COUNTS);
    let result: Decoded<_> = decoded(&mut OptoForceDecoder::new(counts()), &both).unwrap();
    assert_eq!(result, Err(OptoForceFault::Fault { status: 0x8010 }));
}

#[test]
fn the_count_tells_what_is_missing() {
    let mut decoder = OptoForceDecoder::new(counts());
    let mut missing = Vec::new();
    for count in [0xFFFE_u16, 0xFFFF, 0, 3, 4] {
        decoded(&mut decoder, &frame(count.to_be_bytes(), [0, 0], COUNTS)).unwrap().unwrap();
        missing.push(decoder.missing());
    }
    assert_eq!(missing, [0, 0, 0, 2, 2]);
}

#[test]
fn each_rate_and_filter_has_its_code() {
    let rates = [
        (Rate::Stop, 0),
        (Rate::Hz1000, 1),
        (Rate::Hz333, 3),
        (Rate::Hz100, 10),
        (Rate::Hz30, 33),
        (Rate::Hz10, 100),
    ];
    let filters = [
        (Filter::None, 0),
        (Filter::Hz500, 1),
        (Filter::Hz150, 2),
        (Filter::Hz50, 3),
        (Filter::Hz15, 4),
        (Filter::Hz5, 5),
        (Filter::Hz1_5, 6),
    ];
    for (rate, rate_code) in rates {
        for (filter, filter_code) in filters {
            for (zero, zero_code) in [(false, 0), (true, 255)] {
                let mut bytes = [0xAA, 0, 50, 3, rate_code, filter_code, zero_code, 0, 0];
                let sum = sum(&bytes[..7]);
                [bytes[7], bytes[8]] = [(sum >> 8) as u8, sum as u8];
                let configuration = Configuration { rate, filter, zero };
                assert_eq!(configuration.emit(), bytes);
                assert_eq!(Configuration::parse(&bytes), Some(configuration));
            }
        }
    }
}

#[test]
fn a_configuration_with_a_wrong_byte_is_none() {
    let with_sum = |mut bytes: [u8; 9]| {
        let sum = sum(&bytes[..7]);
        [bytes[7], bytes[8]] = [(sum >> 8) as u8, sum as u8];
        bytes
    };
    let sound = with_sum([0xAA, 0, 50, 3, 10, 4, 255, 0, 0]);
    assert!(Configuration::parse(&sound).is_some());
    // Header, a rate, a filter and a zero that do not exist, each with a sum that fits.
    for (at, byte) in [(0, 0xAB), (1, 1), (2, 51), (3, 2), (4, 2), (5, 7), (6, 1), (6, 254)] {
        let mut bytes = sound;
        bytes[at] = byte;
        assert_eq!(Configuration::parse(&with_sum(bytes)), None, "{at}");
    }
    for at in [7, 8] {
        let mut bytes = sound;
        bytes[at] ^= 1;
        assert_eq!(Configuration::parse(&bytes), None, "{at}");
    }
}
