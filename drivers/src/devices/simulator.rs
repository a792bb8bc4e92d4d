//! Sensors without hardware, to be served where the real one would be.

use core::net::{IpAddr, SocketAddr};
use core::time::Duration;
use std::io;

use thiserror::Error;

use crate::sensors::line::SerialDevice;
use crate::sensors::{FaultPlan, LinkStatistics};

/// How a device is simulated.
///
/// ```
/// use fingertip_drivers::devices::{Simulator, devices};
///
/// // Sensors that can be simulated on a serial port.
/// let serial = devices().iter().filter(|device| matches!(device.simulator, Some(Simulator::Serial(_))));
/// assert!(serial.map(|device| device.name).eq(["bota", "robotous", "dynpick", "optoforce", "resense"]));
/// ```
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
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::devices::{Simulator, devices};
/// use fingertip_drivers::sensors::bota_serial::BotaDecoder;
/// use fingertip_drivers::sensors::line::{LineFaults, LineSensor, SimulatedSerial};
///
/// let bota = devices().iter().find(|device| device.name == "bota").unwrap();
/// let Some(Simulator::Serial(make)) = bota.simulator else { unreachable!("it is on a serial port") };
/// let mut sensor =
///     LineSensor::new(SimulatedSerial::new(make(1000.0).device, LineFaults::default()), BotaDecoder::new());
/// sensor.line_mut().sample([0.0, 0.0, -2.0, 0.0, 0.0, 0.0]);
/// let force: f64 = sensor.next_sample()?.unwrap().value.force().z;
/// assert_eq!(force, -2.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub struct SerialSimulator {
    /// What it says.
    pub device: SerialDevice,
    /// What its address must say behind the question mark, with it.
    pub options: String,
}

/// Where and how a simulated sensor is to be served on a network.
///
/// [`OpenSensor`](super::OpenSensor) has one whose samples are read. One on a bad link:
///
/// ```
/// use core::net::Ipv4Addr;
/// use fingertip_drivers::devices::{Serving, Simulator, devices};
/// use fingertip_drivers::sensors::FaultPlan;
///
/// let ati = devices().iter().find(|device| device.name == "ati").unwrap();
/// let Some(Simulator::Network(serve)) = ati.simulator else { unreachable!("it is on a network") };
/// let served = serve(Serving {
///     listen: Ipv4Addr::LOCALHOST.into(),
///     port: Some(0),
///     http_port: 0,
///     udp_port: 0,
///     faults: FaultPlan { loss: 0.1, ..FaultPlan::default() },
///     rate: 1000.0,
///     load: Box::new(|number| [0.0, 0.0, -1e-3 * number as f64, 0.0, 0.0, 0.0]),
/// })?;
/// assert!(served.address().starts_with("ati://127.0.0.1:"));
/// # Ok::<(), fingertip_drivers::devices::ServeError>(())
/// ```
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
///
/// ```
/// use core::net::Ipv4Addr;
/// use fingertip_drivers::devices::{Serving, Simulator, devices};
/// use fingertip_drivers::sensors::FaultPlan;
///
/// // The port is taken.
/// let other = std::net::UdpSocket::bind("127.0.0.1:0")?;
/// let port = other.local_addr()?.port();
/// let ati = devices().iter().find(|device| device.name == "ati").unwrap();
/// let Some(Simulator::Network(serve)) = ati.simulator else { unreachable!("it is on a network") };
/// let (listen, faults) = (Ipv4Addr::LOCALHOST.into(), FaultPlan::default());
/// let load = Box::new(|_| [0.0; 6]);
/// let refused =
///     serve(Serving { listen, port: Some(port), http_port: 0, udp_port: 0, faults, rate: 1e3, load });
/// let told = refused.err().unwrap().to_string();
/// assert!(told.starts_with(&format!("cannot serve on UDP port {port}: ")));
/// assert!(told.ends_with("; choose another --port, 0 for any free one"));
/// # Ok::<(), std::io::Error>(())
/// ```
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
///
/// [`NetworkSimulator::stop`] says so:
///
/// ```
/// use fingertip_drivers::devices::Served;
/// use fingertip_drivers::sensors::LinkStatistics;
///
/// let mut injected = LinkStatistics::default();
/// injected.lost = 25;
/// let served = Served { sent: 1000, injected };
/// assert_eq!(served.injected.lost as f64 / served.sent as f64, 0.025);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Served {
    /// Datagrams that were sent.
    pub sent: u64,
    /// What was done to them; `received` stays zero.
    pub injected: LinkStatistics,
}

/// A simulated sensor that serves in a thread of its own, until it is stopped or dropped.
///
/// ```
/// use core::net::Ipv4Addr;
/// use fingertip_drivers::Source;
/// use fingertip_drivers::devices::{Address, Serving, Simulator, devices, open};
/// use fingertip_drivers::sensors::FaultPlan;
///
/// let ati = devices().iter().find(|device| device.name == "ati").unwrap();
/// let Some(Simulator::Network(serve)) = ati.simulator else { unreachable!("it is on a network") };
/// let (listen, faults) = (Ipv4Addr::LOCALHOST.into(), FaultPlan::default());
/// let load = Box::new(|_| [0.0; 6]);
/// let served =
///     serve(Serving { listen, port: Some(0), http_port: 0, udp_port: 0, faults, rate: 1e3, load })?;
/// let mut sensor = open(&Address::parse(served.address(), devices())?)?;
/// for _ in 0..10 {
///     sensor.next_sample()?;
/// }
/// assert!(served.stop().unwrap().sent >= 10);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
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
