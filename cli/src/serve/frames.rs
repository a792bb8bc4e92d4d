//! What a simulated sensor on a serial line sends and hears.

use fingertip::wrench::Wrench;
use fingertip_drivers::robotous::Request;
use fingertip_drivers::{bota_serial, dynpick, optoforce, resense, robotous};

use super::args::Device;

/// Counts per newton and newton metre of the devices that send counts: those of the Robotous RFT60, a
/// DynPick WEF-6A200, and an OptoForce HEX.
const ROBOTOUS: [f64; 2] = [50.0, 2000.0];
const DYNPICK: [f64; 2] = [40.0, 1640.0];
const OPTOFORCE: [f64; 2] = [100.0, 10_000.0];
/// Range of the Resense sensor \[N, N·m\].
const RESENSE: [f64; 2] = [200.0, 10.0];
/// Temperature of the sensors that tell one \[°C\].
const TEMPERATURE: f32 = 25.0;

/// A sensor behind its end of the line.
#[derive(Clone, Debug)]
pub(super) struct SerialDevice {
    device: Device,
    streaming: bool,
    number: u64,
    /// Period \[µs\].
    period: f64,
    heard: Vec<u8>,
    /// Requests for single readings that wait for an answer.
    asked: u32,
    answers: Vec<Vec<u8>>,
    load: [f64; 6],
    zero: [f64; 6],
}

/// Nearest counts, within the range of a converter of 16 bits.
#[expect(clippy::cast_possible_truncation, reason = "saturates, as a converter does")]
fn counts(load: &[f64; 6], [per_newton, per_newton_metre]: [f64; 2]) -> [i16; 6] {
    let [fx, fy, fz, tx, ty, tz] = *load;
    let force = [fx, fy, fz].map(|force| (force * per_newton).round() as i16);
    let torque = [tx, ty, tz].map(|torque| (torque * per_newton_metre).round() as i16);
    let ([fx, fy, fz], [tx, ty, tz]) = (force, torque);
    [fx, fy, fz, tx, ty, tz]
}

/// How many bytes of requests are kept until they make sense.
const LONGEST_REQUEST: usize = 64;

impl SerialDevice {
    pub(super) fn new(device: Device, rate: f64) -> Self {
        Self {
            device,
            // As delivered; the others wait for a request.
            streaming: matches!(device, Device::Bota | Device::Optoforce | Device::Resense),
            number: 0,
            period: 1e6 / rate,
            heard: Vec::new(),
            asked: 0,
            answers: Vec::new(),
            load: [0.0; 6],
            zero: [0.0; 6],
        }
    }

    /// What the address of this sensor must say, behind its question mark.
    pub(super) fn options(device: Device, rate: f64) -> String {
        match device {
            Device::Bota => format!("?rate_Hz={rate}"),
            Device::Optoforce => {
                let [force, torque] = OPTOFORCE;
                format!("?counts_per_N={force}&counts_per_Nm={torque}")
            }
            Device::Resense => {
                let [force, torque] = RESENSE;
                format!("?greatest_N={force}&greatest_Nm={torque}")
            }
            _ => String::new(),
        }
    }

    /// Takes bytes from the client.
    pub(super) fn hear(&mut self, bytes: &[u8]) {
        self.heard.extend_from_slice(bytes);
        match self.device {
            Device::Dynpick => {
                for byte in self.heard.drain(..) {
                    match byte {
                        dynpick::REQUEST => self.asked = (self.asked + 1).min(8),
                        dynpick::REQUEST_ZERO => self.zero = self.load,
                        dynpick::REQUEST_SENSITIVITIES => {
                            let [f, t] = DYNPICK;
                            self.answers.push(
                                format!("{f:06.2},{f:06.2},{f:06.2},{t:06.1},{t:06.1},{t:06.1}\r\n")
                                    .into_bytes(),
                            );
                        }
                        _ => {}
                    }
                }
            }
            Device::Robotous => self.hear_framed(|this, frame: &[u8; Request::SERIAL_LENGTH]| {
                match Request::parse_serial(frame) {
                    None => return false,
                    Some(Request::Stream) => this.streaming = true,
                    Some(Request::Stop) => this.streaming = false,
                    Some(Request::Single) => this.asked = (this.asked + 1).min(8),
                    Some(Request::Bias { set }) => this.zero = if set { this.load } else { [0.0; 6] },
                    Some(_) => {}
                }
                true
            }),
            Device::Optoforce => self.hear_framed(|this, frame: &[u8; optoforce::Configuration::LENGTH]| {
                let Some(configuration) = optoforce::Configuration::parse(frame) else { return false };
                this.streaming = configuration.rate != optoforce::Rate::Stop;
                this.zero = if configuration.zero { this.load } else { [0.0; 6] };
                true
            }),
            _ => self.heard.clear(),
        }
        let excess = self.heard.len().saturating_sub(LONGEST_REQUEST);
        self.heard.drain(..excess);
    }

    fn hear_framed<const N: usize>(&mut self, understand: impl Fn(&mut Self, &[u8; N]) -> bool) {
        let mut at = 0;
        while let Some(frame) = self.heard.get(at..).and_then(|rest| rest.first_chunk::<N>()).copied() {
            if understand(self, &frame) {
                self.heard.drain(..at + N);
                at = 0;
            } else {
                at += 1;
            }
        }
    }

    /// Samples a load, and gives the frames that are to be sent.
    pub(super) fn sample(&mut self, load: &Wrench<f64>) -> Vec<Vec<u8>> {
        self.number += 1;
        self.load = load.components().into();
        let mut frames = core::mem::take(&mut self.answers);
        let readings = self.asked + u32::from(self.streaming);
        self.asked = 0;
        for _ in 0..readings {
            frames.push(self.frame());
        }
        frames
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "wire formats wrap around or round"
    )]
    fn frame(&self) -> Vec<u8> {
        let mut load = self.load;
        for (component, zero) in load.iter_mut().zip(self.zero) {
            *component -= zero;
        }
        let [fx, fy, fz, tx, ty, tz] = load.map(|component| component as f32);
        match self.device {
            Device::Bota => bota_serial::Frame {
                status: 0,
                components: [fx, fy, fz, tx, ty, tz],
                // The remainder first: what is above the range of 32 bits would stay at its end.
                microseconds: (self.number as f64 * self.period).rem_euclid(4_294_967_296.0) as u32,
                temperature: TEMPERATURE,
            }
            .emit()
            .to_vec(),
            Device::Robotous => {
                let counts = counts(&load, ROBOTOUS);
                robotous::Reading { streamed: self.streaming, counts, overload: 0 }.emit_serial().to_vec()
            }
            Device::Dynpick => {
                let greatest = i32::from(dynpick::Reading::GREATEST);
                let raw = counts(&load, DYNPICK).map(|count| {
                    (i32::from(count) + i32::from(dynpick::Reading::ZERO)).clamp(0, greatest) as u16
                });
                dynpick::Reading { tick: (self.number % 10) as u8, raw }.emit().to_vec()
            }
            Device::Optoforce => {
                let counts = counts(&load, OPTOFORCE);
                optoforce::Reading { count: self.number as u16, status: 0, counts }.emit().to_vec()
            }
            Device::Resense => {
                let torque_millinewton_metres = [tx, ty, tz].map(|torque| torque * 1e3);
                resense::Reading { force: [fx, fy, fz], torque_millinewton_metres, temperature: TEMPERATURE }
                    .emit()
                    .to_vec()
            }
            Device::Ati | Device::Schunk => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_heard_among_noise_and_in_pieces() {
        let mut sensor = SerialDevice::new(Device::Robotous, 1000.0);
        assert!(sensor.sample(&Wrench::zero()).is_empty());
        let request = Request::Stream.emit_serial();
        sensor.hear(&[0x55, 1, 2]);
        sensor.hear(&request[..4]);
        sensor.hear(&request[4..]);
        assert_eq!(sensor.sample(&Wrench::zero()).len(), 1);
        sensor.hear(&Request::Stop.emit_serial());
        assert!(sensor.sample(&Wrench::zero()).is_empty());
        for _ in 0..100 {
            sensor.hear(&[0x55; 1000]);
        }
        assert!(sensor.heard.len() <= LONGEST_REQUEST);
    }

    #[test]
    fn a_dynpick_answers_once_for_each_request() {
        let mut sensor = SerialDevice::new(Device::Dynpick, 1000.0);
        assert!(sensor.sample(&Wrench::zero()).is_empty());
        sensor.hear(b"pR");
        let frames = sensor.sample(&Wrench::zero());
        let counts = dynpick::Sensitivities::parse(&frames[0]).unwrap().counts();
        let wrench: Wrench<f64> = counts.wrench([40, 0, 0, 0, 0, 1640]);
        assert_eq!((wrench.force().x, wrench.torque().z), (1.0, 1.0));
        assert_eq!(frames.len(), 2);
    }
}
