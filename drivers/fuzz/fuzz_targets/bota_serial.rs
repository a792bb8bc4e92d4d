//! Bytes of a line with a Bota sensor.
#![no_main]

use fingertip_drivers::Sample;
use fingertip_drivers::sensors::bota_serial::BotaDecoder;
use fingertip_drivers::sensors::line::LineDecoder;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut decoder = BotaDecoder::new();
    for byte in bytes {
        if let Some(Ok(Sample { value, .. })) = LineDecoder::<f64>::push(&mut decoder, *byte) {
            assert!(value.is_finite());
        }
    }
    let statistics = LineDecoder::<f64>::statistics(&decoder);
    assert!(statistics.skipped <= bytes.len() as u64);
});
