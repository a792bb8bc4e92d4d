//! The socket at which a sensor's datagrams arrive.

use core::net::SocketAddr;
use core::time::Duration;
use std::io;
use std::net::UdpSocket;

use socket2::SockRef;

/// Receives datagrams, and waits for them or not.
#[derive(Debug)]
pub(crate) struct DatagramSocket {
    socket: UdpSocket,
    timeout: Duration,
    /// Whether it waits for a datagram.
    waits: bool,
}

impl DatagramSocket {
    /// Receive buffer that is asked for \[bytes\]. A datagram of a single sample takes some 770 of them.
    const ROOM: usize = 4 << 20;

    /// A socket that waits for a datagram as long as `timeout`.
    pub(crate) fn new(socket: UdpSocket, timeout: Duration) -> io::Result<Self> {
        socket.set_read_timeout(Some(timeout))?;
        // Room for what comes while this thread does not run. What the system grants may be less; a smaller
        // buffer works, and what it loses is counted.
        let _ = SockRef::from(&socket).set_recv_buffer_size(Self::ROOM);
        Ok(Self { socket, timeout, waits: true })
    }

    /// How long it waits.
    pub(crate) const fn timeout(&self) -> Duration {
        self.timeout
    }

    /// Makes it wait or not; a call of the system only if that changes.
    pub(crate) fn wait(&mut self, wait: bool) -> io::Result<()> {
        if self.waits != wait {
            self.socket.set_nonblocking(!wait)?;
            self.waits = wait;
        }
        Ok(())
    }

    /// The length of the next datagram and where it comes from; `None` if there is none, or none in time.
    pub(crate) fn receive(&self, buffer: &mut [u8]) -> io::Result<Option<(usize, SocketAddr)>> {
        match self.socket.recv_from(buffer) {
            Ok(received) => Ok(Some(received)),
            Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// Sends to where it is connected to.
    #[cfg(feature = "ati-rdt")]
    pub(crate) fn send(&self, bytes: &[u8]) -> io::Result<()> {
        self.socket.send(bytes).map(drop)
    }
}
