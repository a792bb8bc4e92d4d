//! The times of samples in words: how many a second, how evenly.

use core::fmt::Write as _;

use fingertip_recordings::Timing;
use serde::Serialize;

use super::seconds;
use crate::table::{count, short};

/// What the times of samples tell.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Steps {
    /// \[s\]
    #[serde(rename = "start_s", skip_serializing_if = "Option::is_none")]
    first: Option<f64>,
    #[serde(rename = "end_s", skip_serializing_if = "Option::is_none")]
    last: Option<f64>,
    /// Of the steps that are no gaps \[1/s\].
    #[serde(rename = "rate_Hz", skip_serializing_if = "Option::is_none")]
    rate: Option<f64>,
    /// Standard deviation of the same \[s\].
    #[serde(rename = "jitter_s", skip_serializing_if = "Option::is_none")]
    jitter: Option<f64>,
    gaps: u64,
    /// \[s\]
    #[serde(rename = "longest_gap_s", skip_serializing_if = "Option::is_none")]
    longest_gap: Option<f64>,
    /// Times that are that of the sample before.
    repeats: u64,
    /// Times before it.
    backward: u64,
}

/// The jitter, none of which is what the times are rounded by \[s\].
fn jitter(timing: &Timing) -> Option<f64> {
    let times = timing.first()?.abs().max(timing.last()?.abs());
    timing.jitter().map(|jitter| if jitter > 4.0 * f64::EPSILON * times { jitter } else { 0.0 })
}

impl From<&Timing> for Steps {
    fn from(timing: &Timing) -> Self {
        Self {
            first: timing.first(),
            last: timing.last(),
            rate: timing.rate(),
            jitter: jitter(timing),
            gaps: timing.gaps(),
            longest_gap: timing.longest_gap(),
            repeats: timing.repeats(),
            backward: timing.backward(),
        }
    }
}

impl Steps {
    /// In words, a line for times and one for what is uneven.
    pub(crate) fn said(&self, indent: &str) -> String {
        let (Some(first), Some(last)) = (self.first, self.last) else { return String::new() };
        let mut text = format!("{indent}from {} to {}", seconds(first), seconds(last));
        // Writing to a string cannot fail.
        if let (Some(rate), Some(jitter)) = (self.rate, self.jitter) {
            let _ = write!(
                text,
                ", {} samples/s, jitter {} ms (standard deviation of the step)",
                short(rate),
                short(1e3 * jitter)
            );
        }
        text.push('\n');
        let uneven = self.uneven();
        if !uneven.is_empty() {
            let _ = writeln!(text, "{indent}{uneven}");
        }
        text
    }

    /// What is uneven, in one line; nothing if it is even.
    pub(crate) fn uneven(&self) -> String {
        let mut uneven = Vec::new();
        if let Some(longest) = self.longest_gap {
            uneven.push(format!("{} gaps, the longest of {}", count(self.gaps), seconds(longest)));
        }
        if self.repeats > 0 {
            uneven.push(format!("{} times are those of the sample before", count(self.repeats)));
        }
        if self.backward > 0 {
            uneven.push(format!("{} times go back", count(self.backward)));
        }
        uneven.join("; ")
    }
}

#[cfg(test)]
mod tests {
    use fingertip_recordings::Timing;

    use super::Steps;

    #[test]
    fn gaps_repeats_and_steps_back_are_said() {
        let mut timing = Timing::default();
        let times = (0..100).map(|k| f64::from(k) * 0.25).chain([24.75, 30.0, 29.0, 29.25]);
        times.for_each(|time| timing.add(time));
        let steps = Steps::from(&timing);
        let uneven = "1 gaps, the longest of 5.25 s; 1 times are those of the sample before; 1 times go back";
        assert_eq!(steps.uneven(), uneven);
        let said = steps.said("  ");
        assert!(said.starts_with("  from 0 s to 29.2 s, 4 samples/s, jitter 0 ms"), "{said}");
        assert!(said.ends_with(&format!("\n  {uneven}\n")), "{said}");
        assert_eq!((Steps::default().said(""), Steps::default().uneven()), (String::new(), String::new()));
    }

    /// Seconds since 1970 in double precision are exact to a quarter of a microsecond.
    #[test]
    fn what_times_are_rounded_by_is_no_jitter() {
        let jitter = |uneven: f64| {
            let mut timing = Timing::default();
            let late = |k: u32| if k.is_multiple_of(2) { uneven } else { 0.0 };
            (0..1000_u32).for_each(|k| timing.add(1.79e9 + f64::from(k) * 1e-3 + late(k)));
            assert!(timing.jitter().is_some_and(|jitter| jitter > 0.0));
            Steps::from(&timing).jitter
        };
        assert_eq!(jitter(0.0), Some(0.0));
        // Every step is longer or shorter by as much.
        assert!(jitter(1e-5).is_some_and(|found| (found - 1e-5).abs() < 1e-6));
    }
}
