//! A sensor on a serial line that is not there.

use alloc::sync::Arc;
use alloc::vec::Vec;
use core::fmt;
use std::io::{self, Read, Write};

use super::simulator::{LineFaults, SimulatedLine};

/// What a sensor is asked for.
///
/// ```
/// use fingertip_drivers::sensors::line::{LineFaults, SerialDevice, SerialRequest, SimulatedSerial};
/// use std::io::Write;
///
/// // It streams from an S on.
/// let hears = |heard: &[u8]| (heard.first() == Some(&b'S')).then_some((SerialRequest::Stream, 1));
/// let mut port = SimulatedSerial::new(SerialDevice::new(false, hears, |_| vec![]), LineFaults::default());
/// assert!(!port.is_streaming());
/// port.write_all(b"S")?;
/// assert!(port.is_streaming());
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SerialRequest {
    /// One reading.
    Single,
    /// Readings without end.
    Stream,
    /// No more readings.
    Stop,
    /// To take the present load as zero, or to forget the zero.
    Zero {
        /// Whether to set it.
        set: bool,
    },
    /// To stream or not, and to set or forget its zero.
    Configure {
        /// Whether to stream.
        stream: bool,
        /// Whether to set the zero.
        zero: bool,
    },
    /// To answer with these bytes.
    Tell(Vec<u8>),
}

/// What a reading is made of.
///
/// ```
/// use fingertip_drivers::sensors::line::{LineFaults, SerialDevice, SerialSample, SimulatedSerial};
/// use std::io::Read;
///
/// let speaks = |sample: &SerialSample| format!("{} {}\n", sample.number, sample.load[2]).into_bytes();
/// let mut port = SimulatedSerial::new(SerialDevice::new(true, |_| None, speaks), LineFaults::default());
/// port.sample([0.0, 0.0, -2.0, 0.0, 0.0, 0.0]);
/// port.sample([0.0, 0.0, -2.5, 0.0, 0.0, 0.0]);
/// let mut said = String::new();
/// port.read_to_string(&mut said)?;
/// assert_eq!(said, "1 -2\n2 -2.5\n");
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SerialSample {
    /// How many samples were taken, this one included.
    pub number: u64,
    /// The load less the zero \[N, N·m\].
    pub load: [f64; 6],
    /// Whether it is one of a stream, and no answer to a request for one.
    pub streamed: bool,
}

/// What one kind of sensor says on a serial line, and understands.
///
/// A sensor of one's own, which says its force in grams when it hears a question mark:
///
/// ```
/// use fingertip_drivers::sensors::line::{LineFaults, SerialDevice, SerialRequest, SimulatedSerial};
/// use std::io::{Read, Write};
///
/// let scales = SerialDevice::new(
///     false,
///     |heard| (heard.first() == Some(&b'?')).then_some((SerialRequest::Single, 1)),
///     |sample| format!("{:.0} g\n", sample.load[2] / -9.81e-3).into_bytes(),
/// );
/// let mut port = SimulatedSerial::new(scales, LineFaults::default());
/// port.write_all(b"?")?;
/// port.sample([0.0, 0.0, -0.981, 0.0, 0.0, 0.0]);
/// let mut said = String::new();
/// port.read_to_string(&mut said)?;
/// assert_eq!(said, "100 g\n");
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone)]
pub struct SerialDevice {
    streams: bool,
    request: Arc<Understand>,
    frame: Arc<Speak>,
}

type Understand = dyn Fn(&[u8]) -> Option<(SerialRequest, usize)> + Send + Sync;
type Speak = dyn Fn(&SerialSample) -> Vec<u8> + Send + Sync;

impl SerialDevice {
    /// By whether it streams as soon as it is switched on; by the request with which bytes begin, and how many it
    /// takes, `None` if they begin with none; and by the bytes of a reading.
    #[must_use]
    pub fn new(
        streams: bool,
        request: impl Fn(&[u8]) -> Option<(SerialRequest, usize)> + Send + Sync + 'static,
        frame: impl Fn(&SerialSample) -> Vec<u8> + Send + Sync + 'static,
    ) -> Self {
        Self { streams, request: Arc::new(request), frame: Arc::new(frame) }
    }
}

impl fmt::Debug for SerialDevice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SerialDevice").field("streams", &self.streams).finish_non_exhaustive()
    }
}

/// How many bytes of requests are kept until they make sense.
const LONGEST_REQUEST: usize = 64;

/// A simulated sensor at its end of a line with faults. Requests are written to it, and its bytes are read: so it
/// stands where a serial port does, for a [`LineSensor`](super::LineSensor) or anything else.
///
/// ```
/// # #[cfg(feature = "robotous")] {
/// use std::io::Write;
/// use fingertip_drivers::sensors::line::{LineFaults, LineSensor, SimulatedSerial};
/// use fingertip_drivers::sensors::robotous::{Request, RobotousDecoder, SimulatedRft};
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::AxisCounts;
///
/// let counts = AxisCounts::uniform(50.0, 2000.0)?;
/// let port = SimulatedSerial::new(SimulatedRft::new(counts), LineFaults::default());
/// let mut sensor = LineSensor::new(port, RobotousDecoder::new(counts));
/// sensor.line_mut().write_all(&Request::Stream.emit_serial())?;
/// sensor.line_mut().sample([1.0, 0.0, -2.0, 0.0, 0.0, 0.0]);
/// let sample = sensor.next_sample()?.unwrap();
/// let force: f64 = sample.value.force().z;
/// assert_eq!(force, -2.0);
/// # }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SimulatedSerial {
    device: SerialDevice,
    line: SimulatedLine,
    streaming: bool,
    number: u64,
    heard: Vec<u8>,
    /// Requests for single readings that wait for the next sample.
    asked: u32,
    load: [f64; 6],
    zero: [f64; 6],
}

impl SimulatedSerial {
    /// A sensor that was just switched on.
    #[must_use]
    pub fn new(device: impl Into<SerialDevice>, faults: LineFaults) -> Self {
        let device = device.into();
        let streaming = device.streams;
        Self {
            device,
            line: SimulatedLine::new(faults),
            streaming,
            number: 0,
            heard: Vec::new(),
            asked: 0,
            load: [0.0; 6],
            zero: [0.0; 6],
        }
    }

    /// Switches it off and on: zero, count and requests are forgotten, what is on the line is lost.
    pub fn switch_off_and_on(&mut self) {
        self.line.clear();
        self.heard.clear();
        (self.streaming, self.number, self.asked) = (self.device.streams, 0, 0);
        (self.load, self.zero) = ([0.0; 6], [0.0; 6]);
    }

    /// The line, with the counts of what it did.
    #[must_use]
    pub const fn line(&self) -> &SimulatedLine {
        &self.line
    }

    /// Whether it sends readings without being asked for each.
    #[must_use]
    pub const fn is_streaming(&self) -> bool {
        self.streaming
    }

    /// The sensor samples a load \[N, N·m\], and sends what it is to send.
    pub fn sample(&mut self, load: [f64; 6]) {
        self.number += 1;
        self.load = load;
        let mut zeroed = load;
        for (component, zero) in zeroed.iter_mut().zip(self.zero) {
            *component -= zero;
        }
        let streamed = self.streaming;
        for _ in 0..core::mem::take(&mut self.asked) + u32::from(streamed) {
            let frame = (self.device.frame)(&SerialSample { number: self.number, load: zeroed, streamed });
            self.line.send(&frame);
        }
    }

    fn obey(&mut self, request: SerialRequest) {
        let set_zero = |set| if set { self.load } else { [0.0; 6] };
        match request {
            SerialRequest::Single => self.asked = (self.asked + 1).min(8),
            SerialRequest::Stream => self.streaming = true,
            SerialRequest::Stop => self.streaming = false,
            SerialRequest::Zero { set } => self.zero = set_zero(set),
            SerialRequest::Configure { stream, zero } => {
                self.zero = set_zero(zero);
                self.streaming = stream;
            }
            SerialRequest::Tell(answer) => self.line.send(&answer),
        }
    }
}

/// Takes requests: whole ones, in pieces, or among bytes that mean nothing.
impl Write for SimulatedSerial {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.heard.extend_from_slice(bytes);
        let mut at = 0;
        while let Some(rest) = self.heard.get(at..).filter(|rest| !rest.is_empty()) {
            match (self.device.request)(rest) {
                Some((request, length)) => {
                    self.heard.drain(..at + length.max(1));
                    at = 0;
                    self.obey(request);
                }
                None => at += 1,
            }
        }
        // The last bytes may be the beginning of a request.
        let excess = self.heard.len().saturating_sub(LONGEST_REQUEST);
        self.heard.drain(..excess);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Read for SimulatedSerial {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.line.read(buffer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Streams on `go`, stops on `no`, and answers `x` with one reading; a reading is its number.
    fn simple() -> SerialDevice {
        SerialDevice::new(
            false,
            |heard| match heard {
                [b'g', b'o', ..] => Some((SerialRequest::Stream, 2)),
                [b'n', b'o', ..] => Some((SerialRequest::Stop, 2)),
                [b'z', ..] => Some((SerialRequest::Zero { set: true }, 1)),
                [b'x', ..] => Some((SerialRequest::Single, 1)),
                [b'?', ..] => Some((SerialRequest::Tell(b"me".to_vec()), 1)),
                _ => None,
            },
            |sample| alloc::vec![sample.number as u8, sample.load[0] as u8, u8::from(sample.streamed)],
        )
    }

    #[test]
    fn requests_are_heard_among_noise_and_in_pieces() {
        let mut sensor = SimulatedSerial::new(simple(), LineFaults::default());
        let said = |sensor: &mut SimulatedSerial, request: &[u8], load: f64| {
            sensor.write_all(request).unwrap();
            sensor.sample([load; 6]);
            let mut bytes = Vec::new();
            sensor.read_to_end(&mut bytes).unwrap();
            bytes
        };
        assert_eq!(said(&mut sensor, b"", 7.0), []);
        assert_eq!(said(&mut sensor, b"abcg", 7.0), []);
        assert_eq!(said(&mut sensor, b"o", 7.0), [3, 7, 1]);
        assert_eq!(said(&mut sensor, b"?z", 9.0), [b'm', b'e', 4, 2, 1]);
        assert_eq!(said(&mut sensor, b"noxx", 9.0), [5, 2, 0, 5, 2, 0]);
        assert_eq!(said(&mut sensor, b"abxcxd", 9.0), [6, 2, 0, 6, 2, 0]);
        assert_eq!(said(&mut sensor, &[b'a'; 1000], 9.0), []);
        assert!(sensor.heard.len() <= LONGEST_REQUEST);
        sensor.switch_off_and_on();
        assert_eq!(said(&mut sensor, b"x", 9.0), [1, 9, 0]);
    }
}
