//! What is watched.

use fingertip_wrench::ChannelLimits;

/// What the numbers of a channel are: channels of one sensor and one kind are neighbours, whose noise can be compared.
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
