//! What is wrong, in a form that programs and people read.

use core::fmt;

/// How bad something is.
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
