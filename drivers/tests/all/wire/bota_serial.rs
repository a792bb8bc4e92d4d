//! Bota's binary stream, little-endian: AA, status, six floats, microseconds, degrees, CRC-16/X-25.

use fingertip_drivers::sensors::bota_serial::{BotaDecoder, BotaFault, Frame, FrameError};
use fingertip_drivers::sensors::line::LineDecoder;
use fingertip_drivers::{SourceError, SourceErrorKind};

use super::{Decoded, components, decoded};

/// CRC-16/X-25 bit by bit: reflected, polynomial 0x1021, all ones before and flipped behind.
fn x25(bytes: &[u8]) -> u16 {
    let mut crc = 0xFFFF_u16;
    for byte in bytes {
        crc ^= u16::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { crc >> 1 ^ 0x8408 } else { crc >> 1 };
        }
    }
    !crc
}

/// Forces 1, −2, 0.5 N, torques 0.25, −0.125, 8 N·m at 21.5 °C.
fn frame(status: [u8; 2], microseconds: [u8; 4]) -> [u8; 37] {
    let mut bytes = [0; 37];
    bytes[0] = 0xAA;
    bytes[1..3].copy_from_slice(&status);
    bytes[3..27].copy_from_slice(&[
        0, 0, 0x80, 0x3F, 0, 0, 0, 0xC0, 0, 0, 0, 0x3F, 0, 0, 0x80, 0x3E, 0, 0, 0, 0xBE, 0, 0, 0, 0x41,
    ]);
    bytes[27..31].copy_from_slice(&microseconds);
    bytes[31..35].copy_from_slice(&[0, 0, 0xAC, 0x41]);
    let crc = x25(&bytes[1..35]);
    bytes[35..].copy_from_slice(&[crc as u8, (crc >> 8) as u8]);
    bytes
}

const COMPONENTS: [f32; 6] = [1.0, -2.0, 0.5, 0.25, -0.125, 8.0];

#[test]
fn a_frame_has_its_fields_in_their_places() {
    // The check value that the catalogue of CRCs gives.
    assert_eq!(x25(b"123456789"), 0x906E);
    let bytes = frame([0x34, 0x12], [0x78, 0x56, 0x34, 0x12]);
    let expected =
        Frame { status: 0x1234, components: COMPONENTS, microseconds: 0x1234_5678, temperature: 21.5 };
    assert_eq!(Frame::parse(&bytes), Ok(expected));
    assert_eq!(expected.emit(), bytes);
}

#[test]
fn what_is_not_a_frame_says_why() {
    let bytes = frame([0, 0], [0; 4]);
    for found in [0, 1, 2, 34, 35, 36] {
        assert_eq!(Frame::parse(&bytes[..found]), Err(FrameError::Length { found }));
    }
    assert_eq!(Frame::parse(&[bytes.as_slice(), &[0]].concat()), Err(FrameError::Length { found: 38 }));
    let mut wrong = bytes;
    wrong[0] = 0xAB;
    assert_eq!(Frame::parse(&wrong), Err(FrameError::Header { found: 0xAB }));
    let crc = x25(&bytes[1..35]);
    let mut wrong = bytes;
    wrong[36] ^= 0x80;
    assert_eq!(Frame::parse(&wrong), Err(FrameError::Checksum { expected: crc, found: crc ^ 0x8000 }));
}

#[test]
fn each_status_bit_means_what_the_manual_says() {
    for bit in 0..16_u32 {
        let status = 1_u16 << bit;
        let bytes = frame([status as u8, (status >> 8) as u8], [7, 0, 0, 0]);
        let result = decoded(&mut BotaDecoder::new(), &bytes).unwrap();
        match bit {
            0 => {
                let fault = result.unwrap_err();
                assert_eq!(fault, BotaFault::Overrange { microseconds: 7 });
                assert_eq!(fault.kind(), SourceErrorKind::Overload);
            }
            1 => {
                let fault = result.unwrap_err();
                assert_eq!(fault, BotaFault::Invalid { microseconds: 7, status: 2 });
                assert_eq!(fault.kind(), SourceErrorKind::DeviceFault);
            }
            // Reserved.
            _ => assert_eq!(components(&result.unwrap()), COMPONENTS.map(f64::from)),
        }
    }
    // Overloaded and invalid: the load is what is wrong.
    let both: Decoded<_> = decoded(&mut BotaDecoder::new(), &frame([3, 0], [9, 0, 0, 0])).unwrap();
    assert_eq!(both, Err(BotaFault::Overrange { microseconds: 9 }));
}

/// What comes of frames at these times on the sensor's clock: seconds for each that is given.
fn times(clock: &[u32]) -> (Vec<Option<f64>>, u64, u64) {
    let mut decoder = BotaDecoder::new();
    let given = clock.iter().map(|microseconds| {
        let bytes = frame([0, 0], microseconds.to_le_bytes());
        let sample = decoded(&mut decoder, &bytes).map(Result::unwrap);
        sample.map(|sample| sample.time.unwrap())
    });
    let given = given.collect();
    (given, decoder.not_news(), decoder.restarts())
}

#[test]
fn time_counts_from_the_first_frame_over_the_wrap_around() {
    let (given, not_news, _) = times(&[0xFFFF_FFFE, 0xFFFF_FFFF, 0, 1_000_000]);
    assert_eq!(given, [Some(0.0), Some(1e-6), Some(2e-6), Some(1.000_002)]);
    assert_eq!(not_news, 0);
    // The same time again, an earlier one, and one that is half of the clock away are not news.
    let (given, not_news, restarts) = times(&[100, 100, 99, 100 + (1 << 31), 101, 100 + (1 << 31)]);
    assert_eq!(given, [Some(0.0), None, None, None, Some(1e-6), Some(2_147_483_648e-6)]);
    assert_eq!((not_news, restarts), (3, 0));
}

#[test]
fn a_clock_that_began_anew_is_believed_after_sixteen_frames_that_follow_on_each_other() {
    assert_eq!(BotaDecoder::RESTARTED, 16);
    // Half of the clock behind, a millisecond apart.
    let anew = |number: u32| 5_000_000 + 1000 * number;
    let clock: Vec<u32> = [3_000_000_000].into_iter().chain((0..18).map(anew)).collect();
    // 5 s is ahead of 3000 s on a clock of 4295 s by 1300 s: news at once.
    assert_eq!(times(&clock).1, 0);
    let clock: Vec<u32> = [100_000_000].into_iter().chain((0..18).map(anew)).collect();
    let (given, not_news, restarts) = times(&clock);
    assert!(given[1..16].iter().all(Option::is_none));
    // Time goes on by what passed since the frame before.
    assert_eq!(given[16..], [Some(1e-3), Some(2e-3), Some(3e-3)]);
    assert_eq!((not_news, restarts), (16, 1));
    // A second apart they do not follow on each other; a microsecond less, and they do.
    for (apart, expected) in [(1_000_000, 0), (999_999, 1)] {
        let late = |number: u32| 1000 + apart * number;
        let clock: Vec<u32> = [100_000_000].into_iter().chain((0..16).map(late)).collect();
        assert_eq!(times(&clock).2, expected);
    }
    // Nor do repetitions, however many.
    let clock: Vec<u32> = [100_000_000].into_iter().chain((0..40).map(|_| 1000)).collect();
    let (_, not_news, restarts) = times(&clock);
    assert_eq!((not_news, restarts), (40, 0));
    // News in between begin the count anew.
    let clock: Vec<u32> = [100_000_000]
        .into_iter()
        .chain((0..15).map(anew))
        .chain([100_001_000])
        .chain((15..30).map(anew))
        .collect();
    assert_eq!(times(&clock).2, 0);
}

#[test]
fn bytes_that_are_left_of_a_frame_are_forgotten_on_restart() {
    let bytes = frame([0, 0], [0; 4]);
    let mut decoder = BotaDecoder::new();
    assert!(bytes[..20].iter().all(|byte| LineDecoder::<f64>::push(&mut decoder, *byte).is_none()));
    LineDecoder::<f64>::restart(&mut decoder);
    assert!(decoded(&mut decoder, &bytes).unwrap().is_ok());
    let statistics = LineDecoder::<f64>::statistics(&decoder);
    assert_eq!((statistics.frames, statistics.failed, statistics.skipped), (1, 0, 20));
}
