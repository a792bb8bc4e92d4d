//! Frames of a CAN bus with a Robotous sensor.
#![no_main]

use embedded_can::{Frame, Id, StandardId};
use fingertip_drivers::sensors::AxisCounts;
use fingertip_drivers::sensors::robotous::CanAssembler;
use fingertip_wrench::Wrench;
use libfuzzer_sys::fuzz_target;

/// A frame with data, or a remote one.
struct Bytes<'a> {
    id: StandardId,
    data: &'a [u8],
    remote: bool,
}

impl Frame for Bytes<'_> {
    fn new(_: impl Into<Id>, _: &[u8]) -> Option<Self> {
        None
    }
    fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
        None
    }
    fn is_extended(&self) -> bool {
        false
    }
    fn is_remote_frame(&self) -> bool {
        self.remote
    }
    fn id(&self) -> Id {
        self.id.into()
    }
    fn dlc(&self) -> usize {
        self.data.len()
    }
    fn data(&self) -> &[u8] {
        self.data
    }
}

fuzz_target!(|bytes: &[u8]| {
    let Ok(counts) = AxisCounts::uniform(50.0, 2000.0) else { return };
    let [Some(first), Some(second), Some(other)] = [1, 2, 3].map(StandardId::new) else { return };
    let mut can = CanAssembler::new(counts, first, second);
    let (mut rest, mut frames, mut readings) = (bytes, 0, 0);
    // A byte says whose frame it is and how long, unless it is as long as those of a reading.
    while let Some((head, behind)) = rest.split_first() {
        let length = if head & 0x80 == 0 { 8 } else { usize::from(head >> 3 & 15) };
        let (data, behind) = behind.split_at(length.min(behind.len()));
        rest = behind;
        let id = [first, second, first, second, first, second, other, second][usize::from(head & 7)];
        let remote = head & 0x40 != 0 && head & 0x80 != 0;
        frames += 1;
        if let Some(result) = can.push_wrench::<f64>(&Bytes { id, data, remote }) {
            readings += 1;
            assert!(result.is_err() || result.is_ok_and(|wrench: Wrench<f64>| wrench.is_finite()));
        }
    }
    let statistics = can.statistics();
    assert_eq!(statistics.readings, readings);
    // Each frame is counted once at most.
    assert!(2 * statistics.readings + statistics.halves + statistics.others <= frames);
});
