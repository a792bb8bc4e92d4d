//! A sensor on a line of a microcontroller.

use core::fmt::Display;

use embedded_io::{Read, ReadReady};
use fingertip_wrench::{Real, Wrench};

use super::decoder::LineDecoder;
use super::error::LineError;
use super::pump::{Pump, Step, pumping};
use crate::polled::NbSource;
use crate::{AsyncSource, Sample, Source};

/// A sensor on any `embedded_io::Read`, blocking; polled, too, if the line can say whether bytes are
/// there (`ReadReady`).
///
/// ```
/// use fingertip_drivers::polled::NbSource;
/// use fingertip_drivers::sensors::bota_serial::{BotaDecoder, Frame};
/// use fingertip_drivers::sensors::line::{EmbeddedLine, LineFaults, SimulatedLine};
///
/// // In place of the port of a microcontroller.
/// let mut port = SimulatedLine::new(LineFaults::default());
/// port.send(&Frame::default().emit());
/// let mut sensor = EmbeddedLine::<_, f32, _>::new(port, BotaDecoder::new());
/// assert!(sensor.poll_sample().is_ok());
/// // Nothing more has come.
/// assert!(matches!(sensor.poll_sample(), Err(nb::Error::WouldBlock)));
/// ```
#[derive(Debug)]
pub struct EmbeddedLine<L, T, D> {
    line: L,
    pump: Pump<T, D>,
}

/// A sensor on any `embedded_io_async::Read`. No sample is lost if a call is dropped: what was read is
/// kept, as long as the line keeps what it was asked for when its own call is dropped.
///
/// ```
/// use fingertip_drivers::AsyncSource;
/// use fingertip_drivers::sensors::bota_serial::{BotaDecoder, Frame};
/// use fingertip_drivers::sensors::line::{AsyncLine, LineFaults, SimulatedLine};
/// # use fingertip_test_support::block_on;
///
/// let mut port = SimulatedLine::new(LineFaults::default());
/// port.send(&Frame { components: [0.0, 0.0, -2.0, 0.0, 0.0, 0.0], ..Frame::default() }.emit());
/// let mut sensor = AsyncLine::<_, f32, _>::new(port, BotaDecoder::new());
/// assert_eq!(block_on(sensor.next_sample())?.unwrap().value.force().z, -2.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct AsyncLine<L, T, D> {
    line: L,
    pump: Pump<T, D>,
}

pumping!(EmbeddedLine);
pumping!(AsyncLine);

/// The next sample of a pump; reading is the caller's, in its own way to wait.
macro_rules! pumped {
    ($sensor:ident, $read:expr) => {
        loop {
            match $sensor.pump.step() {
                Step::Sample(sample) => break Ok(Some(sample)),
                Step::Fault(fault) => break Err(LineError::Device(fault).into()),
                Step::NoFrame(bytes) => break Err(LineError::NoFrame { bytes }.into()),
                Step::Empty => {}
            }
            match $read {
                Ok(0) => break Ok(None),
                Ok(length) => $sensor.pump.filled(length),
                Err(error) => break Err(LineError::Line(error).into()),
            }
        }
    };
}

impl<L: Read, T: Real, D: LineDecoder<T>> Source<T, Wrench<T>> for EmbeddedLine<L, T, D>
where
    D::Fault: Display,
{
    type Error = LineError<L::Error, D::Fault>;

    fn next_sample(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, Self::Error> {
        pumped!(self, self.line.read(self.pump.buffer()))
    }
}

impl<L: Read + ReadReady, T: Real, D: LineDecoder<T>> NbSource<T, Wrench<T>> for EmbeddedLine<L, T, D>
where
    D::Fault: Display,
{
    type Error = LineError<L::Error, D::Fault>;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, Wrench<T>>>, Self::Error> {
        pumped!(self, {
            match self.line.read_ready() {
                Ok(true) => self.line.read(self.pump.buffer()),
                Ok(false) => return Err(nb::Error::WouldBlock),
                Err(error) => Err(error),
            }
        })
    }
}

impl<L: embedded_io_async::Read, T: Real, D: LineDecoder<T>> AsyncSource<T, Wrench<T>> for AsyncLine<L, T, D>
where
    D::Fault: Display,
{
    type Error = LineError<L::Error, D::Fault>;

    async fn next_sample(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, Self::Error> {
        pumped!(self, self.line.read(self.pump.buffer()).await)
    }
}
