//! A DynPick sensor that is not there.

use alloc::format;
use alloc::vec::Vec;

use super::wire::{REQUEST, REQUEST_SENSITIVITIES, REQUEST_ZERO, Reading};
use crate::sensors::axis_counts::AxisCounts;
use crate::sensors::line::{SerialDevice, SerialRequest, SerialSample};

/// A sensor that answers each request, for a [`SimulatedSerial`](crate::sensors::line::SimulatedSerial).
///
/// ```
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_drivers::sensors::dynpick::{REQUEST_SENSITIVITIES, SimulatedDynPick};
/// use fingertip_drivers::sensors::line::{LineFaults, SimulatedSerial};
/// use std::io::{Read, Write};
///
/// let device = SimulatedDynPick::new(AxisCounts::uniform(24.9, 1664.0)?);
/// let mut port = SimulatedSerial::new(device, LineFaults::default());
/// port.write_all(&[REQUEST_SENSITIVITIES])?;
/// let mut answer = String::new();
/// port.read_to_string(&mut answer)?;
/// assert_eq!(answer, "024.90,024.90,024.90,1664.0,1664.0,1664.0\r\n");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
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

impl From<SimulatedDynPick> for SerialDevice {
    fn from(device: SimulatedDynPick) -> Self {
        Self::new(false, move |heard| device.request(heard), move |sample| device.frame(sample))
    }
}

impl SimulatedDynPick {
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

#[cfg(test)]
mod tests {
    use std::io::{Read, Write};

    use super::*;
    use crate::sensors::dynpick::Sensitivities;
    use crate::sensors::line::{LineFaults, SimulatedSerial};

    #[test]
    fn it_tells_the_counts_of_its_readings_and_gives_each_that_is_asked_for() {
        let counts = AxisCounts::new([24.9, 24.6, 24.5, 1664.7, 1639.7, 1638.0]).unwrap();
        let mut sensor = SimulatedSerial::new(SimulatedDynPick::new(counts), LineFaults::default());
        let said = |sensor: &mut SimulatedSerial, requests: &[u8], load: [f64; 6]| {
            sensor.write_all(requests).unwrap();
            sensor.sample(load);
            let mut bytes = Vec::new();
            sensor.read_to_end(&mut bytes).unwrap();
            bytes
        };
        let load = [10.0, 0.0, -10.0, 0.0, 0.0, 1.0];
        // Of itself it says nothing.
        assert_eq!(said(&mut sensor, b"", load), []);
        let answer = said(&mut sensor, &[REQUEST_SENSITIVITIES], load);
        assert_eq!(answer, *b"024.90,024.60,024.50,1664.7,1639.7,1638.0\r\n");
        assert_eq!(Sensitivities::parse(&answer).unwrap().counts(), counts);
        // It answers at once; a reading comes with the sample.
        let both = said(&mut sensor, &[REQUEST, REQUEST_SENSITIVITIES], load);
        let (first, second) = both.split_at(answer.len());
        assert_eq!(first, answer);
        let reading = |bytes: &[u8]| Reading::parse(bytes.as_array().unwrap()).unwrap();
        assert_eq!(reading(second), Reading { tick: 3, raw: [8441, 8192, 7947, 8192, 8192, 9830] });
        // The zero is taken of the load that it felt last.
        let zeroed = said(&mut sensor, &[REQUEST_ZERO, REQUEST], load);
        assert_eq!(reading(&zeroed), Reading { tick: 4, raw: [8192; 6] });
    }
}
