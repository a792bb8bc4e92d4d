//! A client over sockets: commands over TCP, samples over UDP.

use alloc::collections::VecDeque;
use core::time::Duration;
use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs, UdpSocket};

use fingertip_wrench::{Real, Wrench};
use thiserror::Error;

use super::receiver::{FtsFault, FtsReceiver};
use super::wire::{Command, CommandAnswer, FtsWireError, Packet};
use crate::{ErrorType, LinkStatistics, Sample, SourceError, SourceErrorKind, WrenchSource};

/// Why a client has no wrench to give.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FtsClientError {
    /// A socket failed.
    #[error("socket: {0}")]
    Socket(#[from] io::Error),
    /// No datagram came in time.
    #[error("no datagram within {timeout:?}; is the sensor on, and does it send to this address and port?")]
    Timeout {
        /// How long was waited.
        timeout: Duration,
    },
    /// A datagram or an answer is none.
    #[error("bytes that are no message: {0}")]
    Corrupt(#[from] FtsWireError),
    /// The sensor does not do what it is told.
    #[error("the sensor refuses the command {command:?} with error {error}")]
    Refused {
        /// What it was told.
        command: Command,
        /// Its answer.
        error: u8,
    },
    /// The sensor reports a fault.
    #[error(transparent)]
    Fault(#[from] FtsFault),
}

impl SourceError for FtsClientError {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Socket(_) => SourceErrorKind::Transport,
            Self::Timeout { .. } => SourceErrorKind::Timeout,
            Self::Corrupt(_) => SourceErrorKind::Corrupt,
            Self::Refused { .. } => SourceErrorKind::Unsupported,
            Self::Fault(fault) => fault.kind(),
        }
    }
}

/// Streams wrenches from a sensor. Its zero is set only by [`tare`](Self::tare); it is told to stop when
/// the client is dropped.
#[derive(Debug)]
pub struct FtsClient<T: Real> {
    socket: UdpSocket,
    commands: TcpStream,
    counter: u16,
    timeout: Duration,
    period: Option<T>,
    receiver: FtsReceiver,
    datagram: Box<[u8; 2048]>,
    waiting: VecDeque<Result<Sample<T, Wrench<T>>, FtsFault>>,
}

impl<T: Real> FtsClient<T> {
    /// Connects to the commands of a sensor, waits for datagrams at a local address (port
    /// [`UDP_PORT`](super::UDP_PORT), unless the sensor is set otherwise), and lets it stream. `timeout` is
    /// how long to wait for a datagram or an answer.
    ///
    /// # Errors
    /// [`FtsClientError`] if an address cannot be had, or the sensor does not start.
    pub fn connect(
        sensor: impl ToSocketAddrs,
        local: impl ToSocketAddrs,
        timeout: Duration,
    ) -> Result<Self, FtsClientError> {
        let address = sensor.to_socket_addrs()?.next();
        let address = address.ok_or_else(|| io::Error::from(io::ErrorKind::AddrNotAvailable))?;
        let socket = UdpSocket::bind(local)?;
        socket.set_read_timeout(Some(timeout))?;
        let commands = TcpStream::connect_timeout(&address, timeout)?;
        commands.set_read_timeout(Some(timeout))?;
        commands.set_write_timeout(Some(timeout))?;
        let mut client = Self {
            socket,
            commands,
            counter: 0,
            timeout,
            period: None,
            receiver: FtsReceiver::default(),
            datagram: Box::new([0; 2048]),
            waiting: VecDeque::new(),
        };
        client.command(Command::StartUdp)?;
        Ok(client)
    }

    /// States the sensor's rate \[samples/s\], so that samples have a time: that of the sensor's count of
    /// datagrams, the lost ones included.
    #[must_use]
    pub fn timed_by(mut self, rate: T) -> Self {
        self.period = (rate > T::zero() && rate.is_number()).then(|| T::one() / rate);
        self
    }

    /// Takes the present load as zero, in the sensor. Collect a [`Tare`](fingertip_wrench::Tare) instead
    /// where you can.
    ///
    /// # Errors
    /// [`FtsClientError`].
    pub fn tare(&mut self) -> Result<(), FtsClientError> {
        self.command(Command::Tare)
    }

    /// How the link has behaved so far; numbers are of datagrams.
    #[must_use]
    pub const fn statistics(&self) -> &LinkStatistics {
        self.receiver.statistics()
    }

    fn command(&mut self, command: Command) -> Result<(), FtsClientError> {
        self.commands.write_all(&command.emit(self.counter))?;
        self.counter = self.counter.wrapping_add(1);
        let mut answer = [0; CommandAnswer::LENGTH];
        self.commands.read_exact(&mut answer)?;
        match CommandAnswer::parse(&answer)?.1 {
            CommandAnswer { command: done, error: 0 } if done == command => Ok(()),
            CommandAnswer { error, .. } => Err(FtsClientError::Refused { command, error }),
        }
    }

    fn receive(&mut self) -> Result<(), FtsClientError> {
        let length = match self.socket.recv(&mut self.datagram[..]) {
            Ok(length) => length,
            Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
                return Err(FtsClientError::Timeout { timeout: self.timeout });
            }
            Err(error) => return Err(error.into()),
        };
        let packet = match Packet::new_checked(self.datagram.get(..length).unwrap_or_default()) {
            Ok(packet) => packet,
            Err(error) => {
                self.receiver.note_corrupt();
                return Err(error.into());
            }
        };
        let Some(samples) = self.receiver.accept::<T>(&packet) else { return Ok(()) };
        let (period, first) = (self.period, self.receiver.index() * samples.len() as u64);
        for (number, wrench) in (first..).zip(samples) {
            #[allow(clippy::cast_precision_loss, reason = "exact for 10^15 samples")]
            let time = period.map(|period| period * T::literal(number as f64));
            self.waiting.push_back(wrench.map(|value| Sample { time, value }));
        }
        Ok(())
    }
}

impl<T: Real> Drop for FtsClient<T> {
    fn drop(&mut self) {
        // The sensor would go on for ever. If it cannot be told, nothing can be done about it here.
        let _ = self.commands.write_all(&Command::StopUdp.emit(self.counter));
    }
}

impl<T: Real> ErrorType for FtsClient<T> {
    type Error = FtsClientError;
}

impl<T: Real> WrenchSource<T> for FtsClient<T> {
    fn next_wrench(&mut self) -> Result<Option<Sample<T, Wrench<T>>>, FtsClientError> {
        loop {
            if let Some(next) = self.waiting.pop_front() {
                return Ok(Some(next?));
            }
            self.receive()?;
        }
    }
}
