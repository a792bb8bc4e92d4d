//! An OptoForce sensor that is not there.

use alloc::vec::Vec;

use super::wire::{Configuration, Rate, Reading};
use crate::sensors::axis_counts::AxisCounts;
use crate::sensors::line::{SerialDevice, SerialRequest, SerialSample};

/// A sensor that streams until it is told to stop, for a [`SimulatedSerial`](crate::sensors::line::SimulatedSerial). It
/// obeys zero and stop of a configuration; its rate is that at which it is given samples.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_drivers::sensors::line::{LineFaults, LineSensor, SimulatedSerial};
/// use fingertip_drivers::sensors::optoforce::{
///     Configuration, Filter, OptoForceDecoder, Rate, SimulatedOptoForce,
/// };
/// use std::io::Write;
///
/// let counts = AxisCounts::uniform(80.0, 1800.0)?;
/// let port = SimulatedSerial::new(SimulatedOptoForce::new(counts), LineFaults::default());
/// let mut sensor = LineSensor::<_, f64, _>::new(port, OptoForceDecoder::new(counts));
/// // What it feels now becomes its zero.
/// sensor.line_mut().sample([0.0, 0.0, -1.0, 0.0, 0.0, 0.0]);
/// let zeroed = Configuration { rate: Rate::Hz1000, filter: Filter::None, zero: true };
/// sensor.line_mut().write_all(&zeroed.emit())?;
/// sensor.line_mut().sample([0.0, 0.0, -3.0, 0.0, 0.0, 0.0]);
/// assert!((sensor.next_sample()?.unwrap().value.force().z + 1.0).abs() < 1e-12);
/// assert!((sensor.next_sample()?.unwrap().value.force().z + 2.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
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
