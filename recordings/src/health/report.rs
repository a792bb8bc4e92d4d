//! What is known of the health of a sensor.

use super::coupling::Coupling;
use super::drift::Drift;
use super::finding::{Finding, Level};
use super::held::HeldStretch;
use super::lines::SpectralLine;
use super::noise::Noise;
use super::zero_steps::ZeroStep;
use super::{Kind, WatchedChannel};

/// When samples came.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Rate {
    /// Samples a second, gaps aside; as stated where the recording has no time.
    pub rate: Option<f64>,
    /// Standard deviation of the step \[s\].
    pub jitter: Option<f64>,
    /// Steps that were too long.
    pub gaps: u64,
    /// The longest \[s\].
    pub longest_gap: Option<f64>,
    /// Samples that would have fitted into the gaps.
    pub missing: f64,
    /// Times that do not advance.
    pub not_advancing: u64,
    /// Samples in which no channel changed.
    pub held: u64,
}

/// The lowest and highest mean over a part of the recording.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Excursion {
    /// Time of the middle of the part \[s\].
    pub time: f64,
    /// The lowest reading.
    pub least: f64,
    /// The mean.
    pub mean: f64,
    /// The highest reading.
    pub greatest: f64,
}

/// The health of one channel, in its unit.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ChannelHealth {
    /// What messages call it.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its sensor; empty if there is but one.
    pub sensor: String,
    /// What its numbers are.
    pub kind: Kind,
    /// Whether it is calculated from others.
    pub is_derived: bool,
    /// Lowest and highest reading; `None` if there is none.
    pub range: Option<[f64; 2]>,
    /// The step of the converter, if it shows.
    pub step: Option<f64>,
    /// At rest; `None` if it never rested for long enough.
    pub noise: Option<Noise>,
    /// The independent part of the noise, as changes from reading to reading tell it whether or not it rested.
    pub quiet_noise: Option<f64>,
    /// Over the rest.
    pub drift: Option<Drift>,
    /// Lines of the spectrum, strongest first.
    pub lines: Vec<SpectralLine>,
    /// Whether lines and spectrum are of the rest; else of all, and only mains are listed.
    pub spectrum_at_rest: bool,
    /// Frequency \[Hz\] and amplitude density \[unit/√Hz\].
    #[cfg_attr(feature = "serde", serde(skip))]
    pub spectrum: Vec<(f64, f64)>,
    /// Stretches at fault: the first of them.
    pub stretches: Vec<HeldStretch>,
    /// Readings at fault in all.
    pub at_fault: u64,
    /// Readings that are no numbers.
    pub not_finite: u64,
    /// How it went, in parts of the recording.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub course: Vec<Excursion>,
}

/// The health of all channels.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Health {
    /// Samples that were looked at.
    pub samples: u64,
    /// When they came.
    pub rate: Rate,
    /// The longest rest \[s\]: from, to.
    pub rest: Option<[f64; 2]>,
    /// The share of the samples at rest.
    pub rest_share: f64,
    /// Each channel.
    pub channels: Vec<ChannelHealth>,
    /// Zeros that jumped.
    pub steps: Vec<ZeroStep>,
    /// Channels that share noise.
    pub couplings: Vec<Coupling>,
    /// What is wrong and what is good to know, worst first.
    pub findings: Vec<Finding>,
}

impl Health {
    /// The worst of what was found.
    #[must_use]
    pub fn level(&self) -> Level {
        self.findings.iter().map(|finding| finding.level).max().unwrap_or_default()
    }

    /// What is worse than a note.
    pub fn faults(&self) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(|finding| finding.level > Level::Note)
    }
}

impl ChannelHealth {
    pub(super) fn is_neighbour_of(&self, other: &Self) -> bool {
        self.sensor == other.sensor && self.kind == other.kind
    }

    pub(super) fn of(channel: &WatchedChannel) -> Self {
        Self {
            name: channel.name.clone(),
            unit: channel.unit.clone(),
            sensor: channel.sensor.clone(),
            kind: channel.kind,
            is_derived: channel.is_derived,
            range: None,
            step: None,
            noise: None,
            quiet_noise: None,
            drift: None,
            lines: Vec::new(),
            spectrum_at_rest: false,
            spectrum: Vec::new(),
            stretches: Vec::new(),
            at_fault: 0,
            not_finite: 0,
            course: Vec::new(),
        }
    }
}
