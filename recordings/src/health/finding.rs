//! What is wrong, in a form that programs and people read.

use core::fmt;

/// How bad something is.
///
/// ```
/// use fingertip_recordings::health::Level;
///
/// // They are ordered, so that the worst is the greatest.
/// let found = [Level::Note, Level::Bad, Level::Sound];
/// assert_eq!(found.into_iter().max(), Some(Level::Bad));
/// assert!(Level::Suspect > Level::Note);
/// assert_eq!(Level::Suspect.name(), "suspect");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Level {
    /// Nothing is.
    #[default]
    Sound,
    /// Good to know.
    Note,
    /// Somebody should look at it.
    Suspect,
    /// Readings are wrong.
    Bad,
}

impl Level {
    /// In one word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sound => "sound",
            Self::Note => "note",
            Self::Suspect => "suspect",
            Self::Bad => "bad",
        }
    }
}

/// What was found.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, Level, WatchedChannel, What};
///
/// let channels = ["v1", "v2"].map(|name| WatchedChannel::new(name, "V", Kind::Signal)).to_vec();
/// let mut watch = HealthWatch::new(channels, Depth::Brief);
/// watch.add(Some(0.0), &[0.1, f64::NAN]);
/// let health = watch.finish();
/// let found = health.findings.iter().map(|finding| finding.what).collect::<Vec<_>>();
/// assert_eq!(found[0], What::NotFinite);
/// assert!(found.contains(&What::TooShort));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum What {
    /// Too few samples to tell anything.
    TooShort,
    /// Nowhere at rest for long enough.
    NoRest,
    /// Readings that are no numbers.
    NotFinite,
    /// A channel that never changes.
    Dead,
    /// A channel that loads do not move while they move its neighbours.
    Unmoved,
    /// A channel that stayed at one value.
    Stuck,
    /// A channel that stayed at its highest or lowest value.
    Clipped,
    /// A channel at the end of its known range.
    Saturated,
    /// A channel that is noisier than its neighbours.
    Noisy,
    /// Noise below the step of the converter.
    Coarse,
    /// A line in the spectrum that makes much of the noise.
    Hum,
    /// A channel that moves at rest.
    Drift,
    /// A channel that moves less and less at rest.
    Settling,
    /// The zero of a channel jumped.
    ZeroStep,
    /// All channels jumped to zero.
    Tare,
    /// Two channels share noise.
    CrossTalk,
    /// Two channels say the same.
    Identical,
    /// Most channels share noise.
    CommonNoise,
    /// Samples are missing.
    Gaps,
    /// Times that do not advance.
    Repeats,
    /// Samples come unevenly.
    Jitter,
    /// Samples that hold the last values.
    Held,
}

/// Something that was found.
///
/// ```
/// use fingertip_recordings::health::{Depth, HealthWatch, Kind, Level, WatchedChannel, What};
///
/// let mut watch = HealthWatch::new(vec![WatchedChannel::new("v1", "V", Kind::Signal)], Depth::Brief);
/// for i in 0..4000_u32 {
///     // Half a second is missing after the first two.
///     let time = f64::from(i) * 1e-3 + if i < 2000 { 0.0 } else { 0.5 };
///     watch.add(Some(time), &[f64::from(i * 7919 % 101) * 1e-4]);
/// }
/// let health = watch.finish();
/// let gap = health.findings.iter().find(|finding| finding.what == What::Gaps).unwrap();
/// assert!(gap.channels.is_empty()); // it is of all
/// assert_eq!(gap.said, "1 gap in time, the longest of 0.501 s; about 500 samples are missing");
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Finding {
    /// What.
    pub what: What,
    /// How bad it is.
    pub level: Level,
    /// Names of the channels; empty if it is of all.
    pub channels: Vec<String>,
    /// When \[s\], if it has a time.
    pub at: Option<f64>,
    /// How much, in the unit of the channel or as a ratio.
    pub size: Option<f64>,
    /// In a sentence, without its full stop.
    pub said: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.level.name(), self.said)
    }
}

/// A number with three digits.
pub(super) fn digits(value: f64) -> String {
    let magnitude = value.abs();
    if !magnitude.is_finite() || (magnitude > 0.0 && !(1e-3..1e5).contains(&magnitude)) {
        return format!("{value:.2e}");
    }
    let places = if magnitude > 0.0 { (2.0 - magnitude.log10().floor()).clamp(0.0, 6.0) as usize } else { 0 };
    let text = format!("{value:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn numbers_have_three_digits() {
        for (number, said) in [
            (0.0, "0"),
            (1.0, "1"),
            (-12.345, "-12.3"),
            (0.001, "0.001"),
            (0.000_999, "9.99e-4"),
            (99_999.0, "99999"),
            (100_000.0, "1.00e5"),
            (-123_456.0, "-1.23e5"),
            (0.012_345, "0.0123"),
            (250.0, "250"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(digits(number), said);
        }
    }
}
