//! Sensors on a serial port, or on TCP in its place.

use core::error::Error;
use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};

use fingertip_wrench::Wrench;

use super::{Address, ConnectError, Link, Losses, OpenSensor, Opened, REPLY, SensorFault, WAIT, source};
use crate::sensors::line::{LineDecoder, LineSensor};
use crate::{Sample, Source, SourceError, SourceErrorKind};

/// A serial port or a TCP connection.
pub(crate) trait Line: Read + Write + Send {}
impl<L: Read + Write + Send> Line for L {}

/// Opens the line of an address, at the sensor's baud rate unless the address has another.
pub(crate) fn open_line(address: &Address) -> Result<Box<dyn Line>, ConnectError> {
    let delivered = if let Link::Serial { baud } = address.device().link { baud } else { 0 };
    let baud = address.whole("baud")?.unwrap_or(delivered);
    let place = address.place();
    if address.is_over_tcp() {
        let stream =
            connect(place).map_err(|source| ConnectError::Tcp { place: place.to_owned(), source })?;
        return Ok(Box::new(stream));
    }
    let port = serialport::new(place, baud).timeout(WAIT).open();
    let port = port.map_err(|source| ConnectError::Port { place: place.to_owned(), baud, source })?;
    // What came before somebody listened is old.
    let _ = port.clear(serialport::ClearBuffer::Input);
    Ok(Box::new(port))
}

fn connect(place: &str) -> io::Result<TcpStream> {
    let address = place.to_socket_addrs()?.next().ok_or(io::ErrorKind::AddrNotAvailable)?;
    let stream = TcpStream::connect_timeout(&address, REPLY)?;
    stream.set_read_timeout(Some(WAIT))?;
    stream.set_write_timeout(Some(WAIT))?;
    stream.set_nodelay(true)?;
    Ok(stream)
}

/// A sensor that streams by itself, or once it was told to.
pub(crate) fn streaming<D>(
    mut line: Box<dyn Line>,
    decoder: D,
    start: &[u8],
    missing: impl Fn(&D) -> Option<u64> + Send + 'static,
) -> Result<OpenSensor, ConnectError>
where
    D: LineDecoder<f64> + Send + 'static,
    D::Fault: Error + Send + Sync + 'static,
{
    line.write_all(start)
        .and_then(|()| line.flush())
        .map_err(|error| ConnectError::Start(error.to_string()))?;
    Ok(source(LineSensor::new(line, decoder), move |sensor| losses(sensor, &missing)))
}

/// A sensor that gives one reading for each request.
pub(crate) fn asked<D>(
    line: Box<dyn Line>,
    decoder: D,
    request: Vec<u8>,
    missing: impl Fn(&D) -> Option<u64> + Send + 'static,
) -> OpenSensor
where
    D: LineDecoder<f64> + Send + 'static,
    D::Fault: Error + Send + Sync + 'static,
{
    OpenSensor::new(Asked { sensor: LineSensor::new(line, decoder), missing, request, silent: 0 })
}

type OnLine<D> = LineSensor<Box<dyn Line>, f64, D>;

fn losses<D: LineDecoder<f64>>(sensor: &OnLine<D>, missing: impl Fn(&D) -> Option<u64>) -> Losses {
    Losses::of_line(sensor.decoder().statistics(), missing(sensor.decoder()))
}

struct Asked<D, M> {
    sensor: OnLine<D>,
    missing: M,
    request: Vec<u8>,
    /// Requests that were not answered.
    silent: u64,
}

impl<D, M> Opened for Asked<D, M>
where
    D: LineDecoder<f64> + Send,
    D::Fault: Error + Send + Sync + 'static,
    M: Fn(&D) -> Option<u64> + Send,
{
    fn next(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, SensorFault> {
        // An answer that is not whole by now never will be.
        self.sensor.restart();
        self.sensor.line_mut().write_all(&self.request).map_err(|error| {
            SensorFault::of_kind(SourceErrorKind::Transport, format!("cannot ask the sensor: {error}"))
        })?;
        let next = self.sensor.next_sample().map_err(SensorFault::new);
        self.silent += u64::from(next.as_ref().is_err_and(|fault| fault.kind() == SourceErrorKind::Timeout));
        next
    }

    fn losses(&self) -> Losses {
        let losses = losses(&self.sensor, &self.missing);
        Losses { lost: Some(losses.lost.unwrap_or(0).max(self.silent)), ..losses }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::sensors::AxisCounts;
    use crate::sensors::dynpick::DynPickDecoder;

    /// A device that has so much to say, a few bytes at a time, and then keeps silent or fails.
    pub(crate) struct Told {
        pub(crate) says: Vec<u8>,
        pub(crate) then: io::ErrorKind,
    }

    impl Read for Told {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            if self.says.is_empty() {
                return Err(self.then.into());
            }
            let length = buffer.len().min(3).min(self.says.len());
            buffer[..length].copy_from_slice(&self.says[..length]);
            self.says.drain(..length);
            Ok(length)
        }
    }

    impl Write for Told {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.then == io::ErrorKind::BrokenPipe { Err(self.then.into()) } else { Ok(bytes.len()) }
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn requests_that_are_not_answered_are_lost() {
        let decoder = || DynPickDecoder::new(AxisCounts::uniform(40.0, 1640.0).unwrap());
        let line = |then| Box::new(Told { says: Vec::new(), then }) as Box<dyn Line>;
        let mut sensor = asked(line(io::ErrorKind::TimedOut), decoder(), b"R".to_vec(), |_| Some(1));
        assert_eq!(sensor.losses().lost, Some(1));
        for expected in 1..5 {
            assert_eq!(sensor.next_sample().unwrap_err().kind(), SourceErrorKind::Timeout);
            assert_eq!(sensor.losses().lost, Some(expected));
        }
        let mut gone = asked(line(io::ErrorKind::BrokenPipe), decoder(), b"R".to_vec(), |_| None);
        let fault = gone.next_sample().unwrap_err();
        assert_eq!(fault.kind(), SourceErrorKind::Transport);
        assert!(fault.to_string().starts_with("cannot ask the sensor"));
        assert_eq!(gone.losses().lost, Some(0));
        // One that streams by itself tells what its decoder knows.
        let sensor = streaming(line(io::ErrorKind::TimedOut), decoder(), b"S", |_| Some(7)).unwrap();
        assert_eq!(sensor.losses().lost, Some(7));
        let broken = streaming(line(io::ErrorKind::BrokenPipe), decoder(), b"S", |_| None).unwrap_err();
        assert!(broken.to_string().starts_with("cannot tell the sensor to start"));
    }
}
