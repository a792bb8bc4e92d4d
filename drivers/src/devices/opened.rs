//! A sensor that was opened by its address, whatever it is.

use core::error::Error;
use core::fmt;

use fingertip_wrench::Wrench;

use super::Losses;
use crate::{Sample, Source, SourceError, SourceErrorKind};

/// Why an open sensor has no sample to give.
///
/// Nothing is at this address:
///
/// ```
/// use fingertip_drivers::devices::{Address, devices, open};
/// use fingertip_drivers::{Source, SourceError, SourceErrorKind};
///
/// let address = Address::parse("ati://127.0.0.1:9?counts_per_N=1e6&counts_per_Nm=1e6", devices())?;
/// let fault = open(&address)?.next_sample().unwrap_err();
/// assert!(matches!(fault.kind(), SourceErrorKind::Timeout | SourceErrorKind::Transport), "{fault}");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct SensorFault {
    kind: SourceErrorKind,
    error: Box<dyn Error + Send + Sync>,
}

impl SensorFault {
    pub(crate) fn new(error: impl SourceError + Error + Send + Sync + 'static) -> Self {
        Self::of_kind(error.kind(), error)
    }

    pub(crate) fn of_kind(kind: SourceErrorKind, error: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self { kind, error: error.into() }
    }
}

impl fmt::Display for SensorFault {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(out)
    }
}

impl Error for SensorFault {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.error.source()
    }
}

impl SourceError for SensorFault {
    fn kind(&self) -> SourceErrorKind {
        self.kind
    }
}

/// A sensor that streams, or is asked for each reading. A call waits for a fraction of a second at most: silence is
/// an error of the kind [`Timeout`](SourceErrorKind::Timeout), after which the next call goes on.
///
/// On a sensor that is simulated in this program:
///
/// ```
/// use core::net::Ipv4Addr;
/// use fingertip_drivers::Source;
/// use fingertip_drivers::devices::{Address, Serving, Simulator, devices, open};
/// use fingertip_drivers::sensors::FaultPlan;
///
/// let ati = devices().iter().find(|device| device.name == "ati").unwrap();
/// let Some(Simulator::Network(serve)) = ati.simulator else { unreachable!("it is on a network") };
/// let served = serve(Serving {
///     listen: Ipv4Addr::LOCALHOST.into(),
///     port: Some(0),
///     http_port: 0,
///     udp_port: 0,
///     faults: FaultPlan::default(),
///     rate: 1000.0,
///     load: Box::new(|_| [0.0, 0.0, -2.0, 0.0, 0.0, 0.0]),
/// })?;
///
/// let mut sensor = open(&Address::parse(served.address(), devices())?)?;
/// let sample = sensor.next_sample()?.unwrap();
/// assert!((sample.value.force().z + 2.0).abs() < 1e-6);
/// assert_eq!(sensor.losses().corrupt, 0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub struct OpenSensor(Box<dyn Opened>);

impl fmt::Debug for OpenSensor {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_tuple("OpenSensor").field(&self.losses()).finish()
    }
}

impl OpenSensor {
    pub(crate) fn new(opened: impl Opened + 'static) -> Self {
        Self(Box::new(opened))
    }

    /// What went missing so far.
    #[must_use]
    pub fn losses(&self) -> Losses {
        self.0.losses()
    }
}

impl Source<f64, Wrench<f64>> for OpenSensor {
    type Error = SensorFault;

    fn next_sample(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, SensorFault> {
        self.0.next()
    }
}

/// What is behind it.
pub(crate) trait Opened: Send {
    fn next(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, SensorFault>;
    fn losses(&self) -> Losses;
}

impl Opened for OpenSensor {
    fn next(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, SensorFault> {
        self.0.next()
    }
    fn losses(&self) -> Losses {
        self.0.losses()
    }
}

/// A source and what it says of its losses.
struct Counted<S, L> {
    source: S,
    losses: L,
}

/// A source as an open sensor.
pub(crate) fn source<S>(source: S, losses: impl Fn(&S) -> Losses + Send + 'static) -> OpenSensor
where
    S: Source<f64, Wrench<f64>> + Send + 'static,
    S::Error: Error + Send + Sync + 'static,
{
    OpenSensor::new(Counted { source, losses })
}

impl<S, L> Opened for Counted<S, L>
where
    S: Source<f64, Wrench<f64>> + Send,
    S::Error: Error + Send + Sync + 'static,
    L: Fn(&S) -> Losses + Send,
{
    fn next(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, SensorFault> {
        self.source.next_sample().map_err(SensorFault::new)
    }
    fn losses(&self) -> Losses {
        (self.losses)(&self.source)
    }
}
