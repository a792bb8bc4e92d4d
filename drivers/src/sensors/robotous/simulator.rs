//! A Robotous sensor on a serial line that is not there.

use alloc::vec::Vec;

use super::wire::{Reading, Request};
use crate::sensors::axis_counts::AxisCounts;
use crate::sensors::line::{SerialDevice, SerialRequest, SerialSample};

/// A sensor that waits for requests, for a [`SimulatedSerial`](crate::sensors::line::SimulatedSerial).
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_drivers::sensors::line::{LineFaults, LineSensor, SimulatedSerial};
/// use fingertip_drivers::sensors::robotous::{Request, RobotousDecoder, SimulatedRft};
/// use std::io::Write;
///
/// let counts = AxisCounts::uniform(50.0, 2000.0)?;
/// let mut device = SimulatedRft::new(counts);
/// device.overload = 1;
/// let port = SimulatedSerial::new(device, LineFaults::default());
/// let mut sensor = LineSensor::<_, f64, _>::new(port, RobotousDecoder::new(counts));
/// sensor.line_mut().write_all(&Request::Single.emit_serial())?;
/// sensor.line_mut().sample([0.0, 0.0, -300.0, 0.0, 0.0, 0.0]);
/// assert!(sensor.next_sample().is_err());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SimulatedRft {
    counts: AxisCounts,
    /// The overload byte of readings from now on.
    pub overload: u8,
}

impl SimulatedRft {
    /// With these counts per unit.
    #[must_use]
    pub const fn new(counts: AxisCounts) -> Self {
        Self { counts, overload: 0 }
    }
}

impl From<SimulatedRft> for SerialDevice {
    fn from(device: SimulatedRft) -> Self {
        Self::new(false, SimulatedRft::request, move |sample| device.frame(sample))
    }
}

impl SimulatedRft {
    fn request(heard: &[u8]) -> Option<(SerialRequest, usize)> {
        let request = match Request::parse_serial(heard.first_chunk()?)? {
            Request::Stream => SerialRequest::Stream,
            Request::Stop => SerialRequest::Stop,
            Request::Single => SerialRequest::Single,
            Request::Bias { set } => SerialRequest::Zero { set },
        };
        Some((request, Request::SERIAL_LENGTH))
    }

    fn frame(&self, sample: &SerialSample) -> Vec<u8> {
        let counts = self.counts.of(&sample.load);
        Reading { streamed: sample.streamed, counts, overload: self.overload }.emit_serial().to_vec()
    }
}
