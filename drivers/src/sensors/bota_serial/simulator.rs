//! A Bota sensor that is not there.

use alloc::vec::Vec;

use super::wire::Frame;
use crate::sensors::line::{SerialDevice, SerialSample};

/// A sensor that streams, for a [`SimulatedSerial`](crate::sensors::line::SimulatedSerial). It does not hear: configuration
/// is not here.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::bota_serial::{BotaDecoder, SimulatedBota};
/// use fingertip_drivers::sensors::line::{LineFaults, LineSensor, SimulatedSerial};
///
/// let port = SimulatedSerial::new(SimulatedBota::new(1000.0), LineFaults::default());
/// let mut sensor = LineSensor::<_, f64, _>::new(port, BotaDecoder::new());
/// sensor.line_mut().sample([0.0, 0.0, -2.0, 0.0, 0.0, 0.0]);
/// assert_eq!(sensor.next_sample()?.unwrap().value.force().z, -2.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulatedBota {
    /// Time from one frame to the next, by which its clock goes on \[s\].
    pub period: f64,
    /// Status of all frames.
    pub status: u16,
}

impl SimulatedBota {
    /// A sensor at so many frames a second.
    #[must_use]
    pub fn new(rate: f64) -> Self {
        Self { period: rate.recip(), status: 0 }
    }
}

impl From<SimulatedBota> for SerialDevice {
    fn from(device: SimulatedBota) -> Self {
        Self::new(true, |_| None, move |sample| device.frame(sample))
    }
}

impl SimulatedBota {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the sensor sends single precision, and its clock wraps around"
    )]
    fn frame(&self, sample: &SerialSample) -> Vec<u8> {
        let frame = Frame {
            status: self.status,
            components: sample.load.map(|component| component as f32),
            // The remainder first: what is above the range of 32 bits would stay at its end.
            microseconds: (sample.number as f64 * self.period * 1e6).rem_euclid(4_294_967_296.0) as u32,
            temperature: 25.0,
        };
        frame.emit().to_vec()
    }
}
