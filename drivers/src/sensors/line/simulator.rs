//! A line with faults.

use alloc::collections::VecDeque;
use std::io::{self, Read};

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// What the line does to frames: probabilities between 0 and 1.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::bota_serial::{BotaDecoder, SimulatedBota};
/// use fingertip_drivers::sensors::line::{LineFaults, LineSensor, SimulatedSerial};
///
/// // A bit of one frame in ten is flipped: those frames are missing, and no number is wrong.
/// let faults = LineFaults { bit_flip: 0.1, ..LineFaults::default() };
/// let port = SimulatedSerial::new(SimulatedBota::new(1000.0), faults);
/// let mut sensor = LineSensor::<_, f64, _>::new(port, BotaDecoder::new());
/// let mut given = 0;
/// for _ in 0..200 {
///     sensor.line_mut().sample([0.0, 0.0, -2.0, 0.0, 0.0, 0.0]);
/// }
/// while let Some(sample) = sensor.next_sample()? {
///     assert_eq!(sample.value.force().z, -2.0);
///     given += 1;
/// }
/// let line = sensor.line_mut().line();
/// assert!(line.damaged() > 0);
/// assert_eq!(given, line.sent() - line.damaged());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineFaults {
    /// One bit of the frame is flipped.
    pub bit_flip: f64,
    /// One byte of the frame is lost.
    pub lost_byte: f64,
    /// The whole frame is lost.
    pub lost_frame: f64,
    /// Some bytes that mean nothing come before the frame.
    pub noise: f64,
    /// Seed of the chance.
    pub seed: u64,
}

/// A line on which a simulated sensor sends: the other end is read.
///
/// ```
/// use fingertip_drivers::sensors::line::{LineFaults, SimulatedLine};
/// use std::io::Read;
///
/// let mut line = SimulatedLine::new(LineFaults { lost_frame: 1.0, ..LineFaults::default() });
/// assert!(!line.send_seen(b"frame"));
/// let mut came = Vec::new();
/// line.read_to_end(&mut came)?;
/// assert_eq!((came.len(), line.sent(), line.damaged()), (0, 1, 1));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SimulatedLine {
    faults: LineFaults,
    random: Pcg64Mcg,
    line: VecDeque<u8>,
    sent: u64,
    damaged: u64,
}

impl SimulatedLine {
    /// A line with faults.
    #[must_use]
    pub fn new(faults: LineFaults) -> Self {
        let random = Pcg64Mcg::seed_from_u64(faults.seed);
        Self { faults, random, line: VecDeque::new(), sent: 0, damaged: 0 }
    }

    /// Sends a frame.
    pub fn send(&mut self, frame: &[u8]) {
        self.send_seen(frame);
    }

    /// Sends a frame, and tells whether it goes through undamaged.
    pub fn send_seen(&mut self, frame: &[u8]) -> bool {
        let LineFaults { bit_flip, lost_byte, lost_frame, noise, .. } = self.faults;
        if self.random.random::<f64>() < noise {
            let count = self.random.random_range(1..40);
            for _ in 0..count {
                self.line.push_back(self.random.random());
            }
        }
        let mut bytes = frame.to_vec();
        let (chance, at) = (self.random.random::<f64>(), self.random.random_range(0..frame.len().max(1)));
        let damaged = chance < bit_flip + lost_byte + lost_frame;
        if chance < bit_flip {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << self.random.random_range(0..8);
            }
        } else if chance < bit_flip + lost_byte {
            if at < bytes.len() {
                bytes.remove(at);
            }
        } else if damaged {
            bytes.clear();
        }
        self.sent += 1;
        self.damaged += u64::from(damaged);
        self.line.extend(bytes);
        !damaged
    }

    /// Loses what is on the line.
    pub(super) fn clear(&mut self) {
        self.line.clear();
    }

    /// Frames sent, the damaged and lost ones included.
    #[must_use]
    pub const fn sent(&self) -> u64 {
        self.sent
    }

    /// Frames damaged or lost on the line.
    #[must_use]
    pub const fn damaged(&self) -> u64 {
        self.damaged
    }
}

impl Read for SimulatedLine {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.line.read(buffer)
    }
}

#[cfg(feature = "embedded-io")]
impl embedded_io::ErrorType for SimulatedLine {
    type Error = core::convert::Infallible;
}

#[cfg(feature = "embedded-io")]
impl embedded_io::Read for SimulatedLine {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, Self::Error> {
        let mut length = 0;
        for (place, byte) in buffer.iter_mut().zip(core::iter::from_fn(|| self.line.pop_front())) {
            *place = byte;
            length += 1;
        }
        Ok(length)
    }
}

#[cfg(feature = "embedded-io")]
impl embedded_io::ReadReady for SimulatedLine {
    fn read_ready(&mut self) -> Result<bool, Self::Error> {
        Ok(!self.line.is_empty())
    }
}

#[cfg(feature = "embedded-io")]
impl embedded_io_async::Read for SimulatedLine {
    async fn read(&mut self, buffer: &mut [u8]) -> Result<usize, Self::Error> {
        embedded_io::Read::read(self, buffer)
    }
}
