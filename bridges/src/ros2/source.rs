//! Wrenches of any driver as a source.

use core::time::Duration;
use std::time::Instant;

use fingertip::wrench::Wrench;
use fingertip_drivers::{Sample, Source, SourceError, SourceErrorKind};
use nalgebra::Vector3;
use ros2_client::qos::History;
use ros2_client::{Name, QosProfile, Subscription};
use serde::Deserialize;
use thiserror::Error;

use super::node::{Participant, refused};
use super::{NodeError, Options};

/// How long a call waits for a sample, and how often it looks.
const PATIENCE: Duration = Duration::from_millis(100);
const NAP: Duration = Duration::from_micros(200);

#[derive(Debug, Deserialize)]
struct Stamp {
    seconds: i32,
    nanoseconds: u32,
}

#[derive(Debug, Deserialize)]
struct Header {
    stamp: Stamp,
    #[serde(rename = "frame_id")]
    _frame: String,
}

#[derive(Debug, Deserialize)]
struct WrenchStamped {
    header: Header,
    force: [f64; 3],
    torque: [f64; 3],
}

/// Why there is no sample.
///
/// ```
/// use fingertip_bridges::ros2::WrenchSourceError;
/// use fingertip_drivers::{SourceError, SourceErrorKind};
///
/// let told = "no message within 100 ms; is the driver publishing geometry_msgs/msg/WrenchStamped there?";
/// assert_eq!(WrenchSourceError::Silent.to_string(), told);
/// assert_eq!(WrenchSourceError::Silent.kind(), SourceErrorKind::Timeout);
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WrenchSourceError {
    /// None came for a while.
    #[error("no message within {} ms; is the driver publishing geometry_msgs/msg/WrenchStamped there?", PATIENCE.as_millis())]
    Silent,
    /// One came that is no wrench.
    #[error("a message that is no geometry_msgs/msg/WrenchStamped: {0}")]
    Message(String),
}

impl SourceError for WrenchSourceError {
    fn kind(&self) -> SourceErrorKind {
        match self {
            Self::Silent => SourceErrorKind::Timeout,
            Self::Message(_) => SourceErrorKind::Corrupt,
        }
    }
}

/// The wrenches of a topic.
///
/// ```
/// use fingertip_bridges::ros2::{Options, WrenchSource, WrenchSourceError};
/// use fingertip_drivers::Source;
///
/// // No driver publishes there.
/// let mut source = WrenchSource::open("/ft_sensor/wrench", &Options { domain: 198, ..Options::default() })?;
/// assert!(matches!(source.next_sample(), Err(WrenchSourceError::Silent)));
/// # Ok::<(), fingertip_bridges::ros2::NodeError>(())
/// ```
pub struct WrenchSource {
    subscription: Subscription<WrenchStamped>,
    _participant: Participant,
}

impl core::fmt::Debug for WrenchSource {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("WrenchSource").finish_non_exhaustive()
    }
}

impl WrenchSource {
    /// Subscribes to a topic, such as `/ft_sensor/wrench`, as sensors are: best effort, which reliable drivers serve, too.
    ///
    /// # Errors
    /// [`NodeError`].
    pub fn open(topic: &str, options: &Options) -> Result<Self, NodeError> {
        let name = Name::parse(topic)
            .map_err(|_| NodeError::Name { name: topic.to_owned(), example: "/ft_sensor/wrench" })?;
        let mut participant = Participant::new(options, "source")?;
        let qos = QosProfile::subscription_default().history(History::KeepLast { depth: 1000 });
        let topic = participant.topic(&name, ["geometry_msgs", "WrenchStamped"], &qos)?;
        let subscription = participant.node.create_subscription(&topic, Some(qos));
        let subscription = subscription.map_err(|why| refused("subscribe")(&why))?;
        Ok(Self { subscription, _participant: participant })
    }
}

impl Source<f64, Wrench<f64>> for WrenchSource {
    type Error = WrenchSourceError;

    /// Times are those of the stamps \[s\]; a driver that stamps nothing has the time of arrival.
    fn next_sample(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, WrenchSourceError> {
        let begun = Instant::now();
        loop {
            match self.subscription.take() {
                Ok(Some((message, _))) => return Ok(Some(sample(&message))),
                Ok(None) if begun.elapsed() > PATIENCE => return Err(WrenchSourceError::Silent),
                Ok(None) => std::thread::sleep(NAP),
                Err(why) => return Err(WrenchSourceError::Message(why.to_string())),
            }
        }
    }
}

fn sample(message: &WrenchStamped) -> Sample<f64, Wrench<f64>> {
    let Stamp { seconds, nanoseconds } = message.header.stamp;
    let is_stamped = seconds != 0 || nanoseconds != 0;
    let time = f64::from(seconds) + f64::from(nanoseconds) * 1e-9;
    let wrench = Wrench::on_fingertip(Vector3::from(message.force), Vector3::from(message.torque));
    Sample { time: is_stamped.then_some(time), value: wrench }
}
