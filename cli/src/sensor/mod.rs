//! Where live samples come from: sensors on a wire, the simulated fingertip, a recording that plays.

mod devices;
mod error;
mod gauge_sources;
mod gauges;
mod losses;
mod replay;
#[cfg(feature = "ros2")]
mod ros2;
mod simulated;
mod stream;
#[cfg(test)]
mod testing;

use fingertip::wrench::Wrench;
use fingertip_drivers::{Source, SourceError, SourceErrorKind};
use nalgebra::SVector;

pub(crate) use devices::{address, help, is_simulated, open};
pub(crate) use error::SensorError;
pub(crate) use fingertip_drivers::devices::{Address, Losses};
pub(crate) use gauges::{Calibrating, GaugesOf, calibrated};
pub(crate) use losses::said as losses_said;
pub(crate) use replay::open as replay;
#[cfg(feature = "ros2")]
pub(crate) use ros2::ros_domain;
pub(crate) use stream::{Event, Stream, StreamOptions};

/// The gauges of the simulated fingertip, its dummy gauge last \[V\].
pub(crate) type Volts = SVector<f64, 7>;

/// One sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reading {
    /// On the clock of the sensor or the recording \[s\], if it tells.
    pub(crate) time: Option<f64>,
    /// As the sensor reports it.
    pub(crate) wrench: Wrench<f64>,
    /// What the wrench was made from, if that is known.
    pub(crate) volts: Option<Volts>,
}

/// What asking for the next sample gives.
#[derive(Clone, Debug)]
pub(crate) enum Next {
    Reading(Reading),
    /// A sample that cannot be used, and why.
    Fault(String),
    /// Nothing came for a while.
    Silence,
    /// There will never be another one.
    End,
}

/// A source of samples. A call waits for a fraction of a second at most, so that the user is heard.
pub(crate) trait Feed: Send {
    /// The next sample; an error is one after which the source is of no more use.
    fn next(&mut self) -> Result<Next, SensorError>;

    /// What went missing so far.
    fn losses(&self) -> Losses;
}

/// A source of the library as a feed.
struct SourceFeed<S, L> {
    source: S,
    losses: L,
}

impl<S, L> Feed for SourceFeed<S, L>
where
    S: Source<f64, Wrench<f64>> + Send,
    S::Error: core::error::Error + Send + Sync + 'static,
    L: Fn(&S) -> Losses + Send,
{
    fn next(&mut self) -> Result<Next, SensorError> {
        match self.source.next_sample() {
            Ok(Some(sample)) => {
                Ok(Next::Reading(Reading { time: sample.time, wrench: sample.value, volts: None }))
            }
            Ok(None) => Ok(Next::End),
            Err(error) => match error.kind() {
                SourceErrorKind::Timeout => Ok(Next::Silence),
                SourceErrorKind::Corrupt | SourceErrorKind::Overload | SourceErrorKind::DeviceFault => {
                    Ok(Next::Fault(error.to_string()))
                }
                _ => Err(SensorError::Source(Box::new(error))),
            },
        }
    }

    fn losses(&self) -> Losses {
        (self.losses)(&self.source)
    }
}
