//! A DynPick sensor that is not there.

use alloc::format;
use alloc::vec::Vec;

use super::wire::{REQUEST, REQUEST_SENSITIVITIES, REQUEST_ZERO, Reading};
use crate::axis_counts::AxisCounts;
use crate::line::{SerialDevice, SerialRequest, SerialSample};

/// A sensor that answers each request, for a [`SimulatedSerial`](crate::line::SimulatedSerial).
#[derive(Clone, Copy, Debug)]
pub struct SimulatedDynPick {
    counts: AxisCounts,
}

impl SimulatedDynPick {
    /// With these counts per unit, which it tells when it is asked.
    #[must_use]
    pub const fn new(counts: AxisCounts) -> Self {
        Self { counts }
    }
}

impl SerialDevice for SimulatedDynPick {
    fn streams(&self) -> bool {
        false
    }

    fn request(&self, heard: &[u8]) -> Option<(SerialRequest, usize)> {
        let request = match *heard.first()? {
            REQUEST => SerialRequest::Single,
            REQUEST_ZERO => SerialRequest::Zero { set: true },
            REQUEST_SENSITIVITIES => {
                let [fx, fy, fz, tx, ty, tz] = self.counts.per_unit();
                let text = format!("{fx:06.2},{fy:06.2},{fz:06.2},{tx:06.1},{ty:06.1},{tz:06.1}\r\n");
                SerialRequest::Tell(text.into_bytes())
            }
            _ => return None,
        };
        Some((request, 1))
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in range")]
    fn frame(&self, sample: &SerialSample) -> Vec<u8> {
        let (zero, greatest) = (i32::from(Reading::ZERO), i32::from(Reading::GREATEST));
        let raw =
            self.counts.of(&sample.load).map(|count| (i32::from(count) + zero).clamp(0, greatest) as u16);
        Reading { tick: (sample.number % 10) as u8, raw }.emit().to_vec()
    }
}
