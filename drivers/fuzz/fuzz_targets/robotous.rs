//! Bytes of a line with a Robotous sensor.
#![no_main]

use fingertip_drivers::Sample;
use fingertip_drivers::sensors::AxisCounts;
use fingertip_drivers::sensors::line::LineDecoder;
use fingertip_drivers::sensors::robotous::RobotousDecoder;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(counts) = AxisCounts::uniform(50.0, 2000.0) else { return };
    let mut decoder = RobotousDecoder::new(counts);
    for byte in bytes {
        if let Some(Ok(Sample { value, .. })) = LineDecoder::<f64>::push(&mut decoder, *byte) {
            assert!(value.is_finite());
        }
    }
    let statistics = LineDecoder::<f64>::statistics(&decoder);
    assert!(statistics.skipped <= bytes.len() as u64);
});
