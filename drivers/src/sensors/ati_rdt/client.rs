//! A client over a UDP socket.

use core::time::Duration;
use std::io::{self, Write};
use std::net::{TcpStream, ToSocketAddrs, UdpSocket};

use fingertip_wrench::{Real, Wrench};
use thiserror::Error;

use super::configuration::{Configuration, ConfigurationError};
use super::deadline::Deadline;
use super::receiver::{CountsPerUnit, RdtError, Receiver};
use super::wire::{Command, Record, Request, WireError, records};
use crate::polled::NbSource;
use crate::sensors::LinkStatistics;
use crate::sensors::datagram_socket::DatagramSocket;
use crate::{Sample, Source, SourceError, SourceErrorKind};

/// Why a client has no wrench to give.
///
/// ```
/// use core::time::Duration;
/// use fingertip_drivers::sensors::ati_rdt::{ClientError, CountsPerUnit, RdtClient};
/// use fingertip_drivers::{Source, SourceError, SourceErrorKind};
///
/// // Somebody is there, and says nothing.
/// let deaf = std::net::UdpSocket::bind("127.0.0.1:0")?;
/// let wait = Duration::from_millis(10);
/// let mut client = RdtClient::<f64>::connect(deaf.local_addr()?, CountsPerUnit::million()?, wait)?;
/// let error = client.next_sample().unwrap_err();
/// assert!(matches!(error, ClientError::Timeout { timeout } if timeout == wait));
/// assert_eq!(error.kind(), SourceErrorKind::Timeout);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ClientError {
    /// The socket failed.
    #[error("UDP socket: {0}")]
    Socket(#[from] io::Error),
    /// The page of its configuration cannot be asked for.
    #[error("HTTP: {0}")]
    Page(io::Error),
    /// No record came in time.
    #[error("no record within {timeout:?}; is the sensor on, reachable, and not serving another client?")]
    Timeout {
        /// How long was waited.
        timeout: Duration,
    },
    /// A datagram is no record.
    #[error("a datagram that is no record: {0}")]
    Corrupt(#[from] WireError),
    /// The sensor's page of its configuration tells nothing that can be used.
    #[error("configuration of the sensor: {0}")]
    Configuration(#[from] ConfigurationError),
    /// The sensor reports a fault, or the settings are wrong.
    #[error(transparent)]
    Rdt(#[from] RdtError),
}

impl SourceError for ClientError {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Socket(_) | Self::Page(_) => SourceErrorKind::Transport,
            Self::Timeout { .. } => SourceErrorKind::Timeout,
            Self::Corrupt(_) => SourceErrorKind::Corrupt,
            Self::Configuration(_) => SourceErrorKind::Unsupported,
            Self::Rdt(error) => error.kind(),
        }
    }
}

/// Refuses an answer whose status is another than that the page follows; an answer without a head is the page itself.
fn refused(answer: &str) -> Result<(), ClientError> {
    let status = answer.lines().next().filter(|line| line.starts_with("HTTP/")).map(str::trim);
    match status.and_then(|line| line.split_once(' ')) {
        Some((_, status)) if !status.starts_with('2') => {
            let shown: String = status.chars().filter(|letter| !letter.is_control()).take(60).collect();
            Err(ClientError::Page(io::Error::other(format!("the sensor answers \"{shown}\""))))
        }
        _ => Ok(()),
    }
}

/// More bytes than an Ethernet frame carries.
const LARGEST: usize = 2048;

/// Streams wrenches from a sensor. Never sets its bias unless [`bias`](Self::bias) is called; tells
/// it to stop when dropped.
///
/// ```
/// use core::time::Duration;
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::FaultPlan;
/// use fingertip_drivers::sensors::ati_rdt::{CountsPerUnit, RdtClient, RdtServer, SimulatedNetFt};
///
/// // In place of the sensor: one on this machine that is pressed with 2 N.
/// let (sensor, period) = (SimulatedNetFt::new(FaultPlan::default()), Duration::from_millis(1));
/// let server = RdtServer::start("127.0.0.1:0", sensor, period, |_| [0, 0, -2_000_000, 0, 0, 0])?;
///
/// let counts = CountsPerUnit::million()?;
/// let mut client =
///     RdtClient::<f64>::connect(server.address(), counts, Duration::from_secs(2))?.timed_by(1000.0);
/// let sample = client.next_sample()?.unwrap();
/// assert!((sample.value.force().z + 2.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct RdtClient<T: Real> {
    socket: DatagramSocket,
    period: Option<T>,
    receiver: Receiver<T>,
    datagram: Box<[u8; LARGEST]>,
    length: usize,
    /// Where the next record of the datagram begins.
    next: usize,
}

impl<T: Real> RdtClient<T> {
    /// The port of the protocol.
    pub const PORT: u16 = 49152;

    /// Asks a sensor (its name or address with port 80) for its configuration over HTTP.
    ///
    /// # Errors
    /// [`ClientError::Page`], also if all of it takes longer than `timeout`, or [`ClientError::Configuration`].
    pub fn configuration(
        sensor: impl ToSocketAddrs,
        timeout: Duration,
    ) -> Result<Configuration, ClientError> {
        let page = page(sensor, timeout).map_err(ClientError::Page)?;
        let page = String::from_utf8_lossy(&page);
        refused(&page)?;
        Ok(Configuration::parse(&page)?)
    }

    /// Starts streaming from a sensor, one record to a datagram. `timeout` is how long to wait for a
    /// record.
    ///
    /// # Errors
    /// [`ClientError::Socket`].
    pub fn connect(
        sensor: impl ToSocketAddrs,
        counts: CountsPerUnit<T>,
        timeout: Duration,
    ) -> Result<Self, ClientError> {
        let sensor = sensor
            .to_socket_addrs()?
            .next()
            .ok_or_else(|| io::Error::from(io::ErrorKind::AddrNotAvailable))?;
        let any: core::net::IpAddr = match sensor {
            core::net::SocketAddr::V4(_) => core::net::Ipv4Addr::UNSPECIFIED.into(),
            core::net::SocketAddr::V6(_) => core::net::Ipv6Addr::UNSPECIFIED.into(),
        };
        let socket = UdpSocket::bind((any, 0))?;
        socket.connect(sensor)?;
        let client = Self {
            socket: DatagramSocket::new(socket, timeout)?,
            period: None,
            receiver: Receiver::new(counts),
            datagram: Box::new([0; LARGEST]),
            length: 0,
            next: 0,
        };
        client.send(Command::Stream)?;
        Ok(client)
    }

    /// States the sensor's RDT rate \[1/s\], so that samples have a time: that of the sensor's
    /// count of records, the lost ones included.
    #[must_use]
    pub fn timed_by(mut self, rate: T) -> Self {
        self.period = (rate > T::zero() && rate.is_number()).then(|| T::one() / rate);
        self
    }

    /// Takes the present load as zero, in the sensor. Collect a
    /// [`Tare`](fingertip_wrench::Tare) instead where you can: this one is forgotten by the sensor
    /// when it is switched off, and hides how large it was.
    ///
    /// # Errors
    /// [`ClientError::Socket`].
    pub fn bias(&self) -> Result<(), ClientError> {
        self.send(Command::Bias)
    }

    /// How the link has behaved so far.
    #[must_use]
    pub const fn statistics(&self) -> &LinkStatistics {
        self.receiver.statistics()
    }

    fn send(&self, command: Command) -> Result<(), ClientError> {
        self.socket.send(&Request { command, count: 0 }.emit())?;
        Ok(())
    }

    /// The next record of the datagram at hand, or of the next one.
    fn next_record(&mut self) -> Result<Record, ClientError> {
        if self.next >= self.length {
            self.receive()?;
        }
        let bytes = self.datagram.get(self.next..self.length).unwrap_or_default();
        self.next += Record::LENGTH;
        let packet = records(bytes)?.next();
        let packet = packet.ok_or(WireError::Length { expected: Record::LENGTH, found: 0 })?;
        Ok(Record::parse(&packet))
    }

    fn receive(&mut self) -> Result<(), ClientError> {
        (self.next, self.length) = (0, 0);
        let Some((length, _)) = self.socket.receive(&mut self.datagram[..])? else {
            return Err(ClientError::Timeout { timeout: self.socket.timeout() });
        };
        if let Err(error) = records(self.datagram.get(..length).unwrap_or_default()) {
            self.receiver.note_corrupt();
            return Err(error.into());
        }
        self.length = length;
        Ok(())
    }

    fn next_sample(&mut self) -> Result<Sample<T, Wrench<T>>, ClientError> {
        loop {
            let record = self.next_record()?;
            if let Some(value) = self.receiver.accept(&record)? {
                #[allow(clippy::cast_precision_loss, reason = "exact for 10^15 records")]
                let time = self.period.map(|period| period * T::literal(self.receiver.index() as f64));
                return Ok(Sample { time, value });
            }
        }
    }
}

/// Asks for the page; all of it must have come within the timeout.
fn page(sensor: impl ToSocketAddrs, timeout: Duration) -> io::Result<Vec<u8>> {
    let end = Deadline::within(timeout);
    let address = sensor.to_socket_addrs()?.next();
    let address = address.ok_or_else(|| io::Error::from(io::ErrorKind::AddrNotAvailable))?;
    let mut stream = TcpStream::connect_timeout(&address, end.left()?)?;
    stream.set_write_timeout(Some(end.left()?))?;
    stream.write_all(Configuration::REQUEST.as_bytes())?;
    let mut page = Vec::new();
    // A page is some kilobytes; whatever serves more is no sensor.
    while page.len() < 1 << 20 && end.read(&mut stream, &mut page)? > 0 {}
    Ok(page)
}

impl<T: Real> Drop for RdtClient<T> {
    fn drop(&mut self) {
        // The sensor would go on for ever. If it cannot be told, nothing can be done about it here.
        let _ = self.send(Command::Stop);
    }
}

impl<T: Real> Source<T, Wrench<T>> for RdtClient<T> {
    type Error = ClientError;

    fn next_sample(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, ClientError> {
        self.socket.wait(true)?;
        self.next_sample().map(Some)
    }
}

/// For control that must not lag, put it into a [`Watched`](crate::middleware::Watched) and read the
/// latest.
impl<T: Real> NbSource<T, Wrench<T>> for RdtClient<T> {
    type Error = ClientError;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, Wrench<T>>>, ClientError> {
        self.socket.wait(false).map_err(ClientError::from)?;
        match self.next_sample() {
            Ok(sample) => Ok(Some(sample)),
            Err(ClientError::Timeout { .. }) => Err(nb::Error::WouldBlock),
            Err(error) => Err(nb::Error::Other(error)),
        }
    }
}
