//! A Resense sensor that is not there.

use alloc::vec::Vec;

use super::wire::Reading;
use crate::sensors::line::{SerialDevice, SerialRequest, SerialSample};

/// A sensor that streams, or answers requests, for a [`SimulatedSerial`](crate::sensors::line::SimulatedSerial).
///
/// ```
/// use fingertip_drivers::sensors::line::{LineFaults, SimulatedSerial};
/// use fingertip_drivers::sensors::resense::{Reading, SimulatedResense};
/// use std::io::{Read, Write};
///
/// // A sensor that is set to answer a question mark.
/// let device = SimulatedResense::asked_by(b"?".to_vec());
/// let mut port = SimulatedSerial::new(device, LineFaults::default());
/// port.write_all(b"?")?;
/// port.sample([0.0, 0.0, -2.0, 0.0, 0.01, 0.0]);
/// let mut bytes = [0; Reading::LENGTH];
/// port.read_exact(&mut bytes)?;
/// let reading = Reading::parse(&bytes);
/// assert_eq!((reading.force[2], reading.torque_millinewton_metres[1]), (-2.0, 10.0));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SimulatedResense {
    request: Vec<u8>,
}

impl SimulatedResense {
    /// One that streams.
    #[must_use]
    pub fn streaming() -> Self {
        Self::default()
    }

    /// One that gives a reading each time it hears these bytes.
    #[must_use]
    pub const fn asked_by(request: Vec<u8>) -> Self {
        Self { request }
    }
}

impl From<SimulatedResense> for SerialDevice {
    fn from(device: SimulatedResense) -> Self {
        let (streams, same) = (device.request.is_empty(), device.clone());
        Self::new(streams, move |heard| same.request(heard), move |sample| device.frame(sample))
    }
}

impl SimulatedResense {
    fn request(&self, heard: &[u8]) -> Option<(SerialRequest, usize)> {
        let length = self.request.len();
        (length > 0 && heard.starts_with(&self.request)).then_some((SerialRequest::Single, length))
    }

    #[expect(clippy::cast_possible_truncation, reason = "the sensor sends single precision")]
    fn frame(&self, sample: &SerialSample) -> Vec<u8> {
        let [fx, fy, fz, tx, ty, tz] = sample.load.map(|component| component as f32);
        let torque_millinewton_metres = [tx, ty, tz].map(|torque| torque * 1e3);
        Reading { force: [fx, fy, fz], torque_millinewton_metres, temperature: 25.0 }.emit().to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::line::{LineFaults, SimulatedSerial};
    use std::io::{Read, Write};

    #[test]
    fn one_that_is_asked_answers_its_own_request_only_and_one_that_streams_hears_nothing() {
        let sent = |device: SimulatedResense, request: &[u8]| {
            let mut port = SimulatedSerial::new(device, LineFaults::default());
            port.write_all(request).unwrap();
            port.sample([1.0; 6]);
            let mut bytes = Vec::new();
            port.read_to_end(&mut bytes).unwrap();
            bytes.len() / Reading::LENGTH
        };
        let requests: [&[u8]; 5] = [b"", b"R", b"rd", b"xRd", b"RdRd"];
        let asked = || SimulatedResense::asked_by(b"Rd".to_vec());
        assert_eq!(requests.map(|request| sent(asked(), request)), [0, 0, 0, 1, 2]);
        assert_eq!(requests.map(|request| sent(SimulatedResense::streaming(), request)), [1; 5]);
    }
}
