//! A sensor on a line of the standard library: a serial port, a file, a socket.

use std::io::{self, Read};

use fingertip_wrench::{Real, Wrench};

use super::decoder::LineDecoder;
use super::error::LineError;
use super::pump::{Pump, Step, pumping};
use crate::polled::NbSource;
use crate::{Sample, Source};

/// A sensor on anything that can be read, such as an open serial port. Set the read timeout of a
/// port to some periods of the sensor.
///
/// It blocks as a [`Source`]. As an [`NbSource`] it takes the timeout of the line (`TimedOut` or
/// `WouldBlock`) for "nothing yet": open the line as non-blocking, or with a timeout of zero.
///
/// In place of an open port, what was read from one:
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::bota_serial::{BotaDecoder, Frame};
/// use fingertip_drivers::sensors::line::LineSensor;
///
/// let bytes = Frame { components: [0.0, 0.0, -2.0, 0.0, 0.0, 0.0], ..Frame::default() }.emit();
/// let mut sensor = LineSensor::<_, f64, _>::new(&bytes[..], BotaDecoder::new());
/// assert_eq!(sensor.next_sample()?.unwrap().value.force().z, -2.0);
/// assert!(sensor.next_sample()?.is_none());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct LineSensor<L, T, D> {
    line: L,
    pump: Pump<T, D>,
}

pumping!(LineSensor);

impl<L: Read, T: Real, D: LineDecoder<T>> Source<T, Wrench<T>> for LineSensor<L, T, D>
where
    D::Fault: core::fmt::Display,
{
    type Error = LineError<io::Error, D::Fault>;

    fn next_sample(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, Self::Error> {
        loop {
            match self.pump.step() {
                Step::Sample(sample) => return Ok(Some(sample)),
                Step::Fault(fault) => return Err(LineError::Device(fault)),
                Step::NoFrame(bytes) => return Err(LineError::NoFrame { bytes }),
                Step::Empty => {}
            }
            match self.line.read(self.pump.buffer()) {
                Ok(0) => return Ok(None),
                Ok(length) => self.pump.filled(length),
                Err(error) => match error.kind() {
                    io::ErrorKind::Interrupted => {}
                    io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock => return Err(LineError::Timeout),
                    _ if is_pulled(&error) => return Ok(None),
                    _ => return Err(LineError::Line(error)),
                },
            }
        }
    }
}

/// Whether a line has ended at its other end, or was pulled out: systems say so in many ways.
fn is_pulled(error: &io::Error) -> bool {
    /// Of a terminal whose other end has hung up.
    const EIO: i32 = 5;
    let kinds = [
        io::ErrorKind::BrokenPipe,
        io::ErrorKind::ConnectionAborted,
        io::ErrorKind::ConnectionReset,
        io::ErrorKind::NotConnected,
        io::ErrorKind::UnexpectedEof,
    ];
    kinds.contains(&error.kind()) || cfg!(unix) && error.raw_os_error() == Some(EIO)
}

impl<L: Read, T: Real, D: LineDecoder<T>> NbSource<T, Wrench<T>> for LineSensor<L, T, D>
where
    D::Fault: core::fmt::Display,
{
    type Error = LineError<io::Error, D::Fault>;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, Wrench<T>>>, Self::Error> {
        match self.next_sample() {
            Ok(sample) => Ok(sample),
            Err(LineError::Timeout) => Err(nb::Error::WouldBlock),
            Err(error) => Err(nb::Error::Other(error)),
        }
    }
}
