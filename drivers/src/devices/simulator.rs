//! Sensors without hardware, to be served where the real one would be.

use core::net::{IpAddr, SocketAddr};
use core::time::Duration;
use std::io;

use thiserror::Error;

use crate::sensors::line::SerialDevice;
use crate::sensors::{FaultPlan, LinkStatistics};

/// How a device is simulated.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Simulator {
    /// On a serial line; made for a rate \[samples/s\].
    Serial(fn(f64) -> SerialSimulator),
    /// On a network.
    Network(fn(Serving) -> Result<NetworkSimulator, ServeError>),
    /// Over the traits of `embedded-can`, in a program.
    OnABus,
    /// Over the traits of `embedded-hal`, on a simulated bench.
    OnABench,
}

/// A simulated sensor for a serial line, to be put into a
/// [`SimulatedSerial`](crate::sensors::line::SimulatedSerial).
pub struct SerialSimulator {
    /// What it says.
    pub device: SerialDevice,
    /// What its address must say behind the question mark, with it.
    pub options: String,
}

/// Where and how a simulated sensor is to be served on a network.
pub struct Serving {
    /// The local address; the loopback interface unless you know what you do.
    pub listen: IpAddr,
    /// Its port, 0 for any free one; `None` for that of the protocol, or any.
    pub port: Option<u16>,
    /// The port of the page of an ATI sensor, 0 for any free one.
    pub http_port: u16,
    /// The port of the client that a SCHUNK sensor sends to.
    pub udp_port: u16,
    /// What the link does to datagrams.
    pub faults: FaultPlan,
    /// Samples a second.
    pub rate: f64,
    /// The load of each sample \[N, N·m\] by its number, which begins anew with each client.
    pub load: Box<dyn FnMut(u64) -> [f64; 6] + Send>,
}

impl Serving {
    /// Time from one sample to the next.
    pub(crate) fn period(&self) -> Duration {
        Duration::try_from_secs_f64(self.rate.recip()).unwrap_or(Duration::from_millis(1))
    }
}

/// What to do about a port that is not to be had: another one, or one of an address that there is.
fn mend(source: &io::Error, port: &'static str) -> &'static str {
    match source.kind() {
        io::ErrorKind::AddrNotAvailable => "the address is none of this machine's: give --listen one that is",
        _ => port,
    }
}

/// Why a simulated sensor cannot be served.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ServeError {
    /// The port is not to be had.
    #[error("cannot serve on {transport} port {port}: {source}; {}", mend(.source, "choose another --port, 0 for any free one"))]
    Port {
        /// UDP or TCP.
        transport: &'static str,
        /// The port.
        port: u16,
        /// Why not.
        source: io::Error,
    },
    /// The port of the page is not to be had.
    #[error("cannot serve on TCP port {port}: {source}; {}", mend(.source, "choose another --http-port"))]
    Page {
        /// The port.
        port: u16,
        /// Why not.
        source: io::Error,
    },
}

/// What a served sensor did.
#[derive(Clone, Copy, Debug)]
pub struct Served {
    /// Datagrams that were sent.
    pub sent: u64,
    /// What was done to them; `received` stays zero.
    pub injected: LinkStatistics,
}

/// A simulated sensor that serves in a thread of its own, until it is stopped or dropped.
pub struct NetworkSimulator {
    address: String,
    stop: Box<dyn FnOnce() -> Option<Served> + Send>,
}

impl NetworkSimulator {
    pub(crate) fn new(
        address: SocketAddr,
        scheme_and_options: (&str, String),
        stop: impl FnOnce() -> Option<Served> + Send + 'static,
    ) -> Self {
        let (scheme, options) = scheme_and_options;
        Self { address: format!("{scheme}://{address}{options}"), stop: Box::new(stop) }
    }

    /// The address to open it by.
    #[must_use]
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Stops it and says what it did; `None` if its thread died.
    #[must_use]
    pub fn stop(self) -> Option<Served> {
        (self.stop)()
    }
}
