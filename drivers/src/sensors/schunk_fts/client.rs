//! A client over sockets: commands over TCP, samples over UDP.

use core::net::IpAddr;
use core::time::Duration;
use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs, UdpSocket};

use fingertip_wrench::{Real, Wrench};
use thiserror::Error;

use super::receiver::{FtsFault, FtsReceiver};
use super::wire::{Command, CommandAnswer, FtsSample, FtsWireError, Packet};
use crate::polled::NbSource;
use crate::sensors::LinkStatistics;
use crate::sensors::datagram_socket::DatagramSocket;
use crate::{Sample, Source, SourceError, SourceErrorKind};

/// Why a client has no wrench to give.
///
/// ```
/// use core::time::Duration;
/// use fingertip_drivers::sensors::schunk_fts::{Command, FtsClient, FtsClientError};
/// use fingertip_drivers::{SourceError, SourceErrorKind};
///
/// // Nobody serves there.
/// let nobody = std::net::TcpListener::bind("127.0.0.1:0")?.local_addr()?;
/// let error = FtsClient::connect(nobody, "127.0.0.1:0", Duration::from_secs(1)).unwrap_err();
/// assert_eq!(error.kind(), SourceErrorKind::Transport);
/// let refused = FtsClientError::Refused { command: Command::Tare, error: 3 };
/// assert_eq!(refused.to_string(), "the sensor refuses Tare with error 3");
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FtsClientError {
    /// A socket failed.
    #[error("socket: {0}")]
    Socket(#[from] io::Error),
    /// No datagram came in time.
    #[error("no datagram within {timeout:?}; is the sensor sending to this address and port?")]
    Timeout {
        /// How long was waited.
        timeout: Duration,
    },
    /// A datagram or an answer is none.
    #[error("a message that is none: {0}")]
    Corrupt(#[from] FtsWireError),
    /// The sensor refused a command.
    #[error("the sensor refuses {command:?} with error {error}")]
    Refused {
        /// The command.
        command: Command,
        /// Its code.
        error: u8,
    },
    /// The sensor answered another command than it was sent.
    #[error("the sensor answers {found:?} to {sent:?}")]
    OtherAnswer {
        /// What was sent.
        sent: Command,
        /// What was answered.
        found: Command,
    },
    /// The sensor reports a fault.
    #[error(transparent)]
    Device(#[from] FtsFault),
}

impl SourceError for FtsClientError {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Socket(_) => SourceErrorKind::Transport,
            Self::Timeout { .. } => SourceErrorKind::Timeout,
            Self::Corrupt(_) | Self::OtherAnswer { .. } => SourceErrorKind::Corrupt,
            Self::Refused { .. } => SourceErrorKind::Unsupported,
            Self::Device(fault) => fault.kind(),
        }
    }
}

/// The largest datagram: sixteen samples.
const LARGEST: usize = 7 + 16 * FtsSample::LENGTH;

/// Streams wrenches from a sensor. Never sets its zero unless [`tare`](Self::tare) is called; tells it to stop
/// when dropped.
///
/// ```
/// use core::time::Duration;
/// use fingertip_drivers::Source;
/// use fingertip_drivers::sensors::FaultPlan;
/// use fingertip_drivers::sensors::schunk_fts::{FtsClient, FtsServer, SimulatedFts};
///
/// // In place of the sensor: one on this machine that is pressed with 2 N.
/// let port = std::net::UdpSocket::bind("127.0.0.1:0")?.local_addr()?.port();
/// let (sensor, period) = (SimulatedFts::new(FaultPlan::default()), Duration::from_millis(1));
/// let server = FtsServer::start("127.0.0.1:0", port, sensor, period, |_| [0.0, 0.0, -2.0, 0.0, 0.0, 0.0])?;
///
/// let wait = Duration::from_secs(2);
/// let mut client = FtsClient::connect(server.address(), ("127.0.0.1", port), wait)?.timed_by(1000.0);
/// let sample = client.next_sample()?.unwrap();
/// let force: f64 = sample.value.force().z;
/// assert_eq!(force, -2.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FtsClient {
    commands: TcpStream,
    counter: u16,
    socket: DatagramSocket,
    sensor: IpAddr,
    receiver: FtsReceiver,
    datagram: [u8; LARGEST],
    length: usize,
    /// Samples of the datagram at hand that were given.
    given: usize,
    /// Whether the datagram at hand is news.
    news: bool,
    /// Time between samples \[s\], where that was stated.
    period: Option<f64>,
}

impl FtsClient {
    /// Connects to a sensor (its address with [`TCP_PORT`](super::TCP_PORT)), listens for datagrams at `local` (any
    /// address with [`UDP_PORT`](super::UDP_PORT)) and lets the sensor send. Datagrams of other addresses are
    /// not taken. `timeout` is how long to wait for an answer, and for a datagram.
    ///
    /// # Errors
    /// [`FtsClientError`].
    pub fn connect(
        sensor: impl ToSocketAddrs,
        local: impl ToSocketAddrs,
        timeout: Duration,
    ) -> Result<Self, FtsClientError> {
        let address = sensor.to_socket_addrs()?.next();
        let address = address.ok_or_else(|| io::Error::from(io::ErrorKind::AddrNotAvailable))?;
        // Before the sensor sends, so that nothing is missed.
        let socket = DatagramSocket::new(UdpSocket::bind(local)?, timeout)?;
        let commands = TcpStream::connect_timeout(&address, timeout)?;
        commands.set_read_timeout(Some(timeout))?;
        commands.set_write_timeout(Some(timeout))?;
        commands.set_nodelay(true)?;
        let mut client = Self {
            commands,
            counter: 0,
            socket,
            sensor: address.ip(),
            receiver: FtsReceiver::default(),
            datagram: [0; LARGEST],
            length: 0,
            given: 0,
            news: false,
            period: None,
        };
        client.command(Command::StartUdp)?;
        Ok(client)
    }

    /// States the sensor's rate \[samples/s\], so that samples have a time: that of the sensor's count of
    /// datagrams, the lost ones included.
    #[must_use]
    pub fn timed_by(mut self, rate: f64) -> Self {
        self.period = (rate > 0.0 && rate.is_finite()).then(|| rate.recip());
        self
    }

    /// Takes the present load as zero, in the sensor. Collect a [`Tare`](fingertip_wrench::Tare) instead where
    /// you can: this one hides how large it was.
    ///
    /// # Errors
    /// [`FtsClientError`].
    pub fn tare(&mut self) -> Result<(), FtsClientError> {
        self.command(Command::Tare)
    }

    /// Forgets the zero of the sensor.
    ///
    /// # Errors
    /// [`FtsClientError`].
    pub fn reset_tare(&mut self) -> Result<(), FtsClientError> {
        self.command(Command::ResetTare)
    }

    /// How the link has behaved so far; numbers are of datagrams.
    #[must_use]
    pub const fn statistics(&self) -> &LinkStatistics {
        self.receiver.statistics()
    }

    fn command(&mut self, command: Command) -> Result<(), FtsClientError> {
        self.counter = self.counter.wrapping_add(1);
        self.commands.write_all(&command.emit(self.counter))?;
        let mut bytes = [0; CommandAnswer::LENGTH];
        self.commands.read_exact(&mut bytes)?;
        let (_, CommandAnswer { command: found, error }) = CommandAnswer::parse(&bytes)?;
        if found != command {
            return Err(FtsClientError::OtherAnswer { sent: command, found });
        }
        if error != 0 {
            return Err(FtsClientError::Refused { command, error });
        }
        Ok(())
    }

    fn receive(&mut self) -> Result<(), FtsClientError> {
        (self.length, self.given, self.news) = (0, 0, false);
        let Some((length, from)) = self.socket.receive(&mut self.datagram)? else {
            return Err(FtsClientError::Timeout { timeout: self.socket.timeout() });
        };
        if from.ip() != self.sensor {
            return Ok(());
        }
        let packet = Packet::new_checked(self.datagram.get(..length).unwrap_or_default());
        match packet {
            Ok(packet) => {
                self.news = self.receiver.accept::<f64>(&packet).is_some();
                self.length = length;
                Ok(())
            }
            Err(error) => {
                self.receiver.note_corrupt();
                Err(error.into())
            }
        }
    }

    /// The next sample of the datagram at hand, or of the next one that is news.
    fn next_sample<T: Real>(&mut self) -> Result<Sample<T, Wrench<T>>, FtsClientError> {
        loop {
            let bytes = self.datagram.get(..self.length).unwrap_or_default();
            let sample = Packet::new_checked(bytes).ok().filter(|_| self.news);
            let count = sample.map_or(0, |packet| packet.samples().count());
            if let Some(sample) = sample.and_then(|packet| packet.samples().nth(self.given)) {
                let number = self.receiver.index() * count as u64 + self.given as u64;
                self.given += 1;
                #[expect(clippy::cast_precision_loss, reason = "exact for 10^15 samples")]
                let time = self.period.map(|period| T::literal(period * number as f64));
                return Ok(Sample { time, value: FtsReceiver::wrench(&sample)? });
            }
            self.receive()?;
        }
    }
}

impl Drop for FtsClient {
    fn drop(&mut self) {
        // If it cannot be told, nothing can be done about it here.
        let _ = self.command(Command::StopUdp);
    }
}

/// The sensor sends no time: samples have one only if its rate is stated, by [`timed_by`](FtsClient::timed_by).
impl<T: Real> Source<T, Wrench<T>> for FtsClient {
    type Error = FtsClientError;

    fn next_sample(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, FtsClientError> {
        self.socket.wait(true)?;
        self.next_sample().map(Some)
    }
}

/// For control that must not lag, put it into a [`Watched`](crate::middleware::Watched) and read the
/// latest.
impl<T: Real> NbSource<T, Wrench<T>> for FtsClient {
    type Error = FtsClientError;

    fn poll_sample(&mut self) -> nb::Result<Option<Sample<T, Wrench<T>>>, FtsClientError> {
        self.socket.wait(false).map_err(FtsClientError::from)?;
        match self.next_sample() {
            Ok(sample) => Ok(Some(sample)),
            Err(FtsClientError::Timeout { .. }) => Err(nb::Error::WouldBlock),
            Err(error) => Err(nb::Error::Other(error)),
        }
    }
}
