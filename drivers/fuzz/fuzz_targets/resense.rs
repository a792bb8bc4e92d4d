//! Bytes of a line with a Resense sensor.
#![no_main]

use fingertip_drivers::Sample;
use fingertip_drivers::sensors::line::LineDecoder;
use fingertip_drivers::sensors::resense::{Limits, ResenseDecoder};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let limits = Limits { force: 1e3, torque: 1e2, temperature: [-40.0, 125.0], temperature_step: 1.0 };
    let mut decoder = ResenseDecoder::new(limits);
    for byte in bytes {
        if let Some(Ok(Sample { value, .. })) = LineDecoder::<f64>::push(&mut decoder, *byte) {
            assert!(value.is_finite());
        }
    }
    let statistics = LineDecoder::<f64>::statistics(&decoder);
    assert!(statistics.skipped <= bytes.len() as u64);
});
