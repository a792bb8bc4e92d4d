//! What is watched.

use fingertip_wrench::ChannelLimits;

/// What the numbers of a channel are: channels of one sensor and one kind are neighbours, whose noise can be compared.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel, What};
///
/// // One of two channels never changes: beside a gauge it is dead, alone of its kind it may just rest.
/// let finds = |kinds: [Kind; 2]| {
///     let channels = kinds.map(|kind| WatchedChannel::new("a channel", "", kind)).to_vec();
///     let mut watch = HealthWatch::new(channels, Depth::Brief);
///     for i in 0..1000_u32 {
///         watch.add(Some(f64::from(i) * 1e-3), &[f64::from(i * 7919 % 101), 0.0]);
///     }
///     let health = watch.finish();
///     health.findings.into_iter().find(|finding| finding.what == What::Dead).map(|finding| finding.level)
/// };
/// assert!(finds([Kind::Signal, Kind::Signal]) > finds([Kind::Signal, Kind::Force]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Kind {
    /// A gauge.
    Signal,
    /// The unloaded gauge beside the others.
    Dummy,
    /// A component of the force.
    Force,
    /// A component of the torque.
    Torque,
}

impl Kind {
    /// Whether it is a component of a wrench, which several gauges make.
    pub(super) const fn is_of_wrench(self) -> bool {
        matches!(self, Self::Force | Self::Torque)
    }
}

/// A channel that is watched.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel, What};
/// use fingertip_wrench::ChannelLimits;
///
/// // A gauge of the left finger, whose amplifier is linear up to 4.5 V.
/// let linear = ChannelLimits::new(0.0, 4.5)?;
/// let gauge = WatchedChannel::new("v1", "V", Kind::Signal).of_sensor("left").within(linear);
/// let mut watch = HealthWatch::new(vec![gauge], Depth::Brief);
/// for i in 0..1000_u32 {
///     watch.add(Some(f64::from(i) * 1e-3), &[f64::from(i) * 5e-3]);
/// }
/// let health = watch.finish();
/// assert!(health.findings.iter().any(|finding| finding.what == What::Saturated));
/// assert_eq!(health.channels[0].sensor, "left");
/// # Ok::<(), fingertip_wrench::BadLimits>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct WatchedChannel {
    /// What messages call it.
    pub name: String,
    /// The unit of its readings, for messages.
    pub unit: String,
    /// The sensor that it belongs to; empty if there is but one.
    pub sensor: String,
    /// What its numbers are.
    pub kind: Kind,
    /// Its linear range.
    pub limits: ChannelLimits<f64>,
    /// Whether it is calculated from other channels that are watched: what is wrong with those is not said again.
    pub is_derived: bool,
}

impl WatchedChannel {
    /// Of the only sensor, without a known range.
    #[must_use]
    pub fn new(name: &str, unit: &str, kind: Kind) -> Self {
        let (name, unit) = (name.to_owned(), unit.to_owned());
        Self { name, unit, sensor: String::new(), kind, limits: ChannelLimits::none(), is_derived: false }
    }

    /// The same, of a sensor of this name.
    #[must_use]
    pub fn of_sensor(self, sensor: &str) -> Self {
        Self { sensor: sensor.to_owned(), ..self }
    }

    /// The same, with a range beyond which it is saturated.
    #[must_use]
    pub fn within(self, limits: ChannelLimits<f64>) -> Self {
        Self { limits, ..self }
    }

    /// The same, calculated from other channels that are watched.
    #[must_use]
    pub fn derived(self) -> Self {
        Self { is_derived: true, ..self }
    }

    /// Whether the noise of both can be compared.
    pub(super) fn is_neighbour_of(&self, other: &Self) -> bool {
        self.sensor == other.sensor && self.kind == other.kind
    }

    /// Whether both are readings of one device.
    pub(super) fn is_beside(&self, other: &Self) -> bool {
        self.sensor == other.sensor && self.kind.is_of_wrench() == other.kind.is_of_wrench()
    }
}
