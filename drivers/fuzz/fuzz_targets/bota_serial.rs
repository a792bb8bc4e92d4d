//! Bytes of a line with a Bota sensor.
#![no_main]

use crc::{CRC_16_IBM_SDLC, Crc};
use fingertip_drivers::Sample;
use fingertip_drivers::sensors::bota_serial::{BotaDecoder, Frame};
use fingertip_drivers::sensors::line::LineDecoder;
use libfuzzer_sys::fuzz_target;

/// CRC-16/X-25 is the IBM-SDLC one by another name.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_SDLC);
/// Bytes between the header and the checksum.
const DATA: usize = Frame::LENGTH - 3;

/// How many bytes of a line belong to no frame.
fn skipped(bytes: &[u8]) -> u64 {
    let mut decoder = BotaDecoder::new();
    for byte in bytes {
        if let Some(Ok(Sample { value, .. })) = LineDecoder::<f64>::push(&mut decoder, *byte) {
            assert!(value.is_finite());
        }
    }
    LineDecoder::<f64>::statistics(&decoder).skipped
}

fuzz_target!(|bytes: &[u8]| {
    assert!(skipped(bytes) <= bytes.len() as u64);
    // As frames whose checksums are right, which chance does not find.
    let frames = bytes.chunks_exact(DATA).flat_map(|data| {
        let checksum = CRC.checksum(data).to_le_bytes();
        [&[Frame::HEADER][..], data, &checksum].concat()
    });
    let frames: Vec<u8> = frames.collect();
    for frame in frames.chunks_exact(Frame::LENGTH) {
        let parsed = Frame::parse(frame).unwrap();
        // A NaN need not keep its bits on the way through a number.
        assert!(
            parsed.components.iter().any(|x| x.is_nan())
                || parsed.temperature.is_nan()
                || parsed.emit() == frame
        );
    }
    assert_eq!(skipped(&frames), 0);
});
