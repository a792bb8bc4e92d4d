//! Sensors on a serial line, or on TCP in its place.

use core::fmt::Display;
use core::time::Duration;
use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};

use fingertip_drivers::sensors::line::{LineDecoder, LineSensor};

use super::address::Address;
use super::losses::Losses;
use super::{Feed, Next, SourceFeed};

/// How long to wait for bytes.
pub(super) const WAIT: Duration = Duration::from_millis(200);

/// A serial port or a TCP connection.
pub(super) trait Line: Read + Write + Send {}
impl<L: Read + Write + Send> Line for L {}

/// Opens the line of an address, at the sensor's baud rate unless the address has another.
pub(super) fn open(address: &Address, baud: u32) -> Result<Box<dyn Line>, String> {
    let baud = address.whole("baud")?.unwrap_or(baud);
    let place = &address.place;
    if address.over_tcp {
        return connect(place).map(|stream| Box::new(stream) as Box<dyn Line>).map_err(|error| {
            format!("cannot connect to {place}: {error}; is the sensor's server running there?")
        });
    }
    let port = serialport::new(place, baud).timeout(WAIT).open().map_err(|error| {
        format!(
            "cannot open {place} at {baud} baud: {error}; is the sensor plugged in, does nothing else use it, and may \
             you read it (group dialout)?"
        )
    })?;
    // What came before somebody listened is old.
    let _ = port.clear(serialport::ClearBuffer::Input);
    Ok(Box::new(port))
}

fn connect(place: &str) -> io::Result<TcpStream> {
    let address = place.to_socket_addrs()?.next().ok_or(io::ErrorKind::AddrNotAvailable)?;
    let stream = TcpStream::connect_timeout(&address, Duration::from_secs(2))?;
    stream.set_read_timeout(Some(WAIT))?;
    stream.set_write_timeout(Some(WAIT))?;
    stream.set_nodelay(true)?;
    Ok(stream)
}

/// A sensor that streams by itself, or once it was told to.
pub(super) fn streaming<D>(
    mut line: Box<dyn Line>,
    decoder: D,
    start: &[u8],
    missing: impl Fn(&D) -> Option<u64> + Send + 'static,
) -> Result<Box<dyn Feed>, String>
where
    D: LineDecoder<f64> + Send + 'static,
    D::Fault: Display,
{
    line.write_all(start)
        .and_then(|()| line.flush())
        .map_err(|error| format!("cannot tell the sensor to start: {error}"))?;
    Ok(Box::new(SourceFeed {
        source: LineSensor::new(line, decoder),
        losses: move |sensor: &LineSensor<Box<dyn Line>, f64, D>| {
            Losses::of_line(sensor.decoder().statistics(), missing(sensor.decoder()))
        },
    }))
}

/// A sensor that gives one reading for each request.
pub(super) fn asked<D>(
    line: Box<dyn Line>,
    decoder: D,
    request: Vec<u8>,
    missing: impl Fn(&D) -> Option<u64> + Send + 'static,
) -> Box<dyn Feed>
where
    D: LineDecoder<f64> + Send + 'static,
    D::Fault: Display,
{
    let losses = move |sensor: &LineSensor<Box<dyn Line>, f64, D>| {
        Losses::of_line(sensor.decoder().statistics(), missing(sensor.decoder()))
    };
    Box::new(Asked {
        feed: SourceFeed { source: LineSensor::new(line, decoder), losses },
        request,
        silent: 0,
    })
}

struct Asked<D, L> {
    feed: SourceFeed<LineSensor<Box<dyn Line>, f64, D>, L>,
    request: Vec<u8>,
    /// Requests that were not answered.
    silent: u64,
}

impl<D, L> Feed for Asked<D, L>
where
    D: LineDecoder<f64> + Send,
    D::Fault: Display,
    L: Fn(&LineSensor<Box<dyn Line>, f64, D>) -> Losses + Send,
{
    fn next(&mut self) -> Result<Next, String> {
        // An answer that is not whole by now never will be.
        self.feed.source.restart();
        let line = self.feed.source.line_mut();
        line.write_all(&self.request).map_err(|error| format!("cannot ask the sensor: {error}"))?;
        let next = self.feed.next()?;
        self.silent += u64::from(matches!(next, Next::Silence));
        Ok(next)
    }

    fn losses(&self) -> Losses {
        let losses = self.feed.losses();
        Losses { lost: Some(losses.lost.unwrap_or(0).max(self.silent)), ..losses }
    }
}
