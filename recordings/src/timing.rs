//! When samples came: how many a second, how evenly, and what is missing.

use crate::time_watch::{Step, TimeWatch};

/// What the times of samples tell, in memory that does not grow with them.
///
/// A step above a factor times the median of all steps before is a gap; rate and jitter are of the steps that are none.
/// Readers, `info` and the health of a sensor go by this one rule.
///
/// ```
/// use fingertip_recordings::Timing;
///
/// let mut timing = Timing::default();
/// for time in [0.0, 0.01, 0.02, 0.03, 0.04, 0.08, 0.09] {
///     timing.add(time);
/// }
/// assert_eq!((timing.gaps(), timing.rate().map(f64::round)), (1, Some(100.0)));
/// ```
#[derive(Clone, Debug)]
pub struct Timing {
    watch: TimeWatch,
    first: Option<f64>,
    last: Option<f64>,
    /// Of the usual steps, their mean, and the sum of the squares of what is off it (Welford 1962).
    usual: u64,
    mean: f64,
    squares: f64,
    gaps: u64,
    longest_gap: Option<f64>,
    missing: f64,
    repeats: u64,
    backward: u64,
}

impl Default for Timing {
    /// A lost sample is a gap: the factor is 1.5.
    fn default() -> Self {
        Self::with_gap_factor(Self::GAP_FACTOR)
    }
}

impl Timing {
    /// So many times the usual step is a gap, where nothing else is said.
    pub const GAP_FACTOR: f64 = 1.5;

    /// With the factor above which a step is a gap.
    #[must_use]
    pub fn with_gap_factor(factor: f64) -> Self {
        Self {
            watch: TimeWatch::new(factor),
            first: None,
            last: None,
            usual: 0,
            mean: 0.0,
            squares: 0.0,
            gaps: 0,
            longest_gap: None,
            missing: 0.0,
            repeats: 0,
            backward: 0,
        }
    }

    /// Takes the time of the next sample \[s\]; one that is not finite is left out.
    pub fn add(&mut self, time: f64) {
        self.judge(time);
    }

    /// As [`add`](Self::add); says what the step was.
    pub(super) fn judge(&mut self, time: f64) -> Option<Step> {
        if !time.is_finite() {
            return None;
        }
        self.first.get_or_insert(time);
        let step = self.watch.step_to(time);
        match step {
            Step::First => {}
            Step::Usual(step) => {
                self.usual += 1;
                let off = step - self.mean;
                self.mean += off / self.usual as f64;
                self.squares += off * (step - self.mean);
            }
            Step::Gap(step) => {
                self.gaps += 1;
                self.longest_gap = Some(self.longest_gap.map_or(step, |longest| longest.max(step)));
                self.missing += (step / self.mean - 1.0).round().max(0.0);
            }
            Step::Same => self.repeats += 1,
            Step::Backward => self.backward += 1,
        }
        if !matches!(step, Step::Backward) {
            self.last = Some(time);
        }
        Some(step)
    }

    /// The first time \[s\].
    #[must_use]
    pub const fn first(&self) -> Option<f64> {
        self.first
    }

    /// The last time, of those that went forward \[s\].
    #[must_use]
    pub const fn last(&self) -> Option<f64> {
        self.last
    }

    /// The mean of the steps that are no gaps \[s\].
    #[must_use]
    pub fn step(&self) -> Option<f64> {
        (self.usual > 0).then_some(self.mean)
    }

    /// Samples a second, but for the gaps.
    #[must_use]
    pub fn rate(&self) -> Option<f64> {
        self.step().map(f64::recip)
    }

    /// Standard deviation of the steps that are no gaps \[s\].
    #[must_use]
    pub fn jitter(&self) -> Option<f64> {
        (self.usual > 0).then(|| (self.squares / self.usual as f64).max(0.0).sqrt())
    }

    /// How many steps were gaps.
    #[must_use]
    pub const fn gaps(&self) -> u64 {
        self.gaps
    }

    /// The longest gap \[s\].
    #[must_use]
    pub const fn longest_gap(&self) -> Option<f64> {
        self.longest_gap
    }

    /// How many samples would have fitted into the gaps.
    #[must_use]
    pub const fn missing(&self) -> f64 {
        self.missing
    }

    /// Times that are that of the sample before.
    #[must_use]
    pub const fn repeats(&self) -> u64 {
        self.repeats
    }

    /// Times before that of the sample before.
    #[must_use]
    pub const fn backward(&self) -> u64 {
        self.backward
    }
}

#[cfg(test)]
mod tests {
    use super::Timing;

    fn of(times: impl IntoIterator<Item = f64>) -> Timing {
        let mut timing = Timing::default();
        times.into_iter().for_each(|time| timing.add(time));
        timing
    }

    #[test]
    fn gaps_repeats_and_steps_back_are_told_apart() {
        let timing = of((0..100).map(|k| f64::from(k) * 0.25).chain([24.75, 30.0, 29.0, 29.25]));
        assert_eq!((timing.gaps(), timing.repeats(), timing.backward()), (1, 1, 1));
        assert_eq!((timing.longest_gap(), timing.missing()), (Some(5.25), 20.0));
        assert_eq!((timing.rate(), timing.jitter()), (Some(4.0), Some(0.0)));
        assert_eq!((timing.first(), timing.last()), (Some(0.0), Some(29.25)));
        // Steps of 1 and 3 in turn, before any is called a gap: mean 2, deviation 1.
        let uneven = of([0.0, 1.0, 4.0]);
        assert_eq!((uneven.rate(), uneven.jitter(), uneven.gaps()), (Some(0.5), Some(1.0), 0));
    }

    #[test]
    fn no_time_and_no_step_tell_nothing() {
        let none = of([f64::NAN, f64::INFINITY]);
        assert_eq!((none.first(), none.step(), none.rate(), none.jitter()), (None, None, None, None));
        let one = of([7.0, f64::NAN]);
        assert_eq!((one.first(), one.last(), one.rate(), one.gaps()), (Some(7.0), Some(7.0), None, 0));
    }

    #[test]
    fn the_factor_is_kept_to() {
        let times = [0.0, 1.0, 2.0, 3.0, 4.0, 6.5];
        for (factor, gaps) in [(2.0, 1), (3.0, 0)] {
            let mut timing = Timing::with_gap_factor(factor);
            times.iter().for_each(|time| timing.add(*time));
            assert_eq!(timing.gaps(), gaps);
        }
    }
}
