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
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel};
///
/// let mut watch = HealthWatch::new(vec![WatchedChannel::new("v1", "V", Kind::Signal)], Depth::Brief);
/// for i in 0..1000_u32 {
///     // 500 samples a second, of which the one at 1 s is missing.
///     if i != 500 {
///         watch.add(Some(f64::from(i) * 2e-3), &[f64::from(i % 7)]);
///     }
/// }
/// let rate = watch.finish().rate;
/// assert!((rate.rate.unwrap() - 500.0).abs() < 1e-6);
/// assert_eq!(rate.gaps, 1);
/// assert!((rate.missing - 1.0).abs() < 1e-9 && (rate.longest_gap.unwrap() - 4e-3).abs() < 1e-9);
/// ```
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
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel};
///
/// let mut watch = HealthWatch::new(vec![WatchedChannel::new("fz", "N", Kind::Force)], Depth::Brief);
/// for i in 0..4000_u32 {
///     watch.add(Some(f64::from(i) * 1e-3), &[if i < 2000 { 0.0 } else { -5.0 }]);
/// }
/// // A press at 2 s, as a plot of few points shows it.
/// let health = watch.finish();
/// let course = &health.channels[0].course;
/// assert!(course.iter().all(|part| part.least <= part.mean && part.mean <= part.greatest));
/// let (first, last) = (course.first().unwrap(), course.last().unwrap());
/// assert_eq!((first.mean, last.mean), (0.0, -5.0));
/// assert!(first.time < 2.0 && 2.0 < last.time);
/// ```
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
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, WatchedChannel};
///
/// let mut watch = HealthWatch::new(vec![WatchedChannel::new("v1", "counts", Kind::Signal)], Depth::Brief);
/// let mut state = 1_u32;
/// let mut noise = || {
///     state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     f64::from(state >> 25)
/// };
/// for i in 0..4000_u32 {
///     // Steps of 4 counts, and one reading that is no number.
///     let reading = if i == 7 { f64::NAN } else { 4.0 * noise() };
///     watch.add(Some(f64::from(i) * 1e-3), &[reading]);
/// }
/// let health = watch.finish();
/// let channel = &health.channels[0];
/// assert_eq!((channel.name.as_str(), channel.unit.as_str()), ("v1", "counts"));
/// assert_eq!(channel.range, Some([0.0, 508.0]));
/// assert_eq!((channel.step, channel.not_finite), (Some(4.0), 1));
/// ```
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
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, Level, WatchedChannel};
///
/// let channels = ["v1", "v2"].map(|name| WatchedChannel::new(name, "V", Kind::Signal)).to_vec();
/// let mut watch = HealthWatch::new(channels, Depth::Brief);
/// for i in 0..4000_u32 {
///     let noise = |k: u32| f64::from(i.wrapping_mul(k) >> 16) / 65_536.0;
///     watch.add(Some(f64::from(i) * 1e-3), &[noise(2_654_435_769), noise(2_246_822_519)]);
/// }
/// let health = watch.finish();
/// assert_eq!(health.samples, 4000);
/// assert!(health.rest_share > 0.9); // nothing touches it
/// assert!(health.level() < Level::Suspect);
/// assert_eq!(health.faults().count(), 0);
/// ```
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
