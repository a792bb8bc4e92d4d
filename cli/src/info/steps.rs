//! The times of samples: how many a second, how evenly.

use core::fmt::Write as _;

use serde::Serialize;

use super::seconds;
use crate::table::{count, short};

/// A step above this many times the mean of those before is a gap, as readers have it of the median.
const GAP: f64 = 1.5;
/// So many steps are looked at before one is called a gap.
const USUAL: u64 = 8;

/// What the times of samples tell.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Steps {
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
    #[serde(skip)]
    usual: u64,
    #[serde(skip)]
    mean: f64,
    #[serde(skip)]
    squares: f64,
}

impl Steps {
    /// Takes the time of a sample \[s\].
    pub(super) fn add(&mut self, time: f64) {
        self.first.get_or_insert(time);
        let Some(last) = self.last else {
            self.last = Some(time);
            return;
        };
        let step = time - last;
        if step == 0.0 {
            self.repeats += 1;
        } else if step < 0.0 {
            self.backward += 1;
            return;
        } else if self.usual >= USUAL && step > GAP * self.mean {
            self.gaps += 1;
            self.longest_gap = Some(self.longest_gap.map_or(step, |longest| longest.max(step)));
        } else {
            // Welford 1962.
            self.usual += 1;
            let off = step - self.mean;
            self.mean += off / self.usual as f64;
            self.squares += off * (step - self.mean);
            self.rate = Some(self.mean.recip());
            self.jitter = Some((self.squares / self.usual as f64).sqrt());
        }
        self.last = Some(time);
    }

    /// In words, a line for times and one for what is uneven.
    pub(super) fn said(&self, indent: &str) -> String {
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
        if !uneven.is_empty() {
            let _ = writeln!(text, "{indent}{}", uneven.join("; "));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::Steps;

    #[test]
    fn gaps_repeats_and_steps_back_are_told_apart() {
        let mut steps = Steps::default();
        for k in 0..100 {
            steps.add(f64::from(k) * 0.25);
        }
        for time in [24.75, 30.0, 29.0, 30.25] {
            steps.add(time);
        }
        assert_eq!((steps.gaps, steps.repeats, steps.backward), (1, 1, 1));
        assert_eq!((steps.longest_gap, steps.rate, steps.jitter), (Some(5.25), Some(4.0), Some(0.0)));
        assert!(steps.said("").contains("4 samples/s, jitter 0 ms"), "{}", steps.said(""));
        // Steps of 1 and 3 in turn, before any is called a gap: mean 2, deviation 1.
        let mut uneven = Steps::default();
        [0.0, 1.0, 4.0, 5.0, 8.0].into_iter().for_each(|time| uneven.add(time));
        assert_eq!((uneven.rate, uneven.jitter, uneven.gaps), (Some(0.5), Some(1.0), 0));
        assert_eq!(Steps::default().said(""), "");
    }
}
