//! An OptoForce sensor that is not there.

use alloc::vec::Vec;

use super::wire::{Configuration, Rate, Reading};
use crate::sensors::axis_counts::AxisCounts;
use crate::sensors::line::{SerialDevice, SerialRequest, SerialSample};

/// A sensor that streams until it is told to stop, for a [`SimulatedSerial`](crate::sensors::line::SimulatedSerial). It
/// obeys zero and stop of a configuration; its rate is that at which it is given samples.
#[derive(Clone, Copy, Debug)]
pub struct SimulatedOptoForce {
    counts: AxisCounts,
}

impl SimulatedOptoForce {
    /// With these counts per unit.
    #[must_use]
    pub const fn new(counts: AxisCounts) -> Self {
        Self { counts }
    }
}

impl From<SimulatedOptoForce> for SerialDevice {
    fn from(device: SimulatedOptoForce) -> Self {
        Self::new(true, SimulatedOptoForce::request, move |sample| device.frame(sample))
    }
}

impl SimulatedOptoForce {
    fn request(heard: &[u8]) -> Option<(SerialRequest, usize)> {
        let Configuration { rate, zero, .. } = Configuration::parse(heard.first_chunk()?)?;
        Some((SerialRequest::Configure { stream: rate != Rate::Stop, zero }, Configuration::LENGTH))
    }

    #[expect(clippy::cast_possible_truncation, reason = "its count wraps around")]
    fn frame(&self, sample: &SerialSample) -> Vec<u8> {
        let counts = self.counts.of(&sample.load);
        Reading { count: sample.number as u16, status: 0, counts }.emit().to_vec()
    }
}
