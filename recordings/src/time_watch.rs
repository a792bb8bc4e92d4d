//! Gaps and backward steps of the time column.

/// What the time of a row is to the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    /// The first one.
    First,
    /// Later by seconds, as usual.
    Usual(f64),
    /// Later by seconds, which is more than usual.
    Gap(f64),
    /// The same time again.
    Same,
    /// Earlier.
    Backward,
}

/// Judges each step against the median of all steps forward before it.
///
/// The median does not move for gaps as long as they are fewer than half of the steps, and a burst
/// in which every other sample is lost counts as that many gaps. It comes from a histogram of
/// 32 bins per octave, so that memory does not grow with the file: what is compared is the upper
/// edge of the median's bin, at most 3.2 % above the median itself. Nothing is judged before
/// [`FEWEST`](Self::FEWEST) steps are known.
#[derive(Clone, Debug)]
pub(super) struct TimeWatch {
    factor: f64,
    last: Option<f64>,
    /// How many steps fell into each bin.
    bins: Box<[u64; Self::BINS]>,
    known: u64,
    /// The bin of the median, and how many steps lie in the bins below it.
    median: usize,
    below: u64,
}

impl TimeWatch {
    const FEWEST: u64 = 3;
    /// From 2⁻³² s to 2³² s; what lies beyond goes into the bins at the ends.
    const BINS: usize = 64 * 32;
    /// The five leading bits of the fraction stay.
    const SHIFT: u32 = 52 - 5;
    /// What is left of the bits of 2⁻³².
    const FIRST: u64 = (1023 - 32) << 5;

    pub(super) fn new(factor: f64) -> Self {
        Self { factor, last: None, bins: Box::new([0; Self::BINS]), known: 0, median: 0, below: 0 }
    }

    /// Takes the next time, which must be finite \[s\].
    pub(super) fn step_to(&mut self, time: f64) -> Step {
        let Some(last) = self.last.replace(time) else { return Step::First };
        let step = time - last;
        if step == 0.0 {
            return Step::Same;
        }
        if step < 0.0 {
            return Step::Backward;
        }
        let gap = self.known >= Self::FEWEST && step > self.factor * self.upper_median();
        self.remember(step);
        if gap { Step::Gap(step) } else { Step::Usual(step) }
    }

    /// The upper edge of the bin that the lower median lies in.
    fn upper_median(&self) -> f64 {
        f64::from_bits((Self::FIRST + self.median as u64 + 1) << Self::SHIFT)
    }

    fn remember(&mut self, step: f64) {
        let place = (step.to_bits() >> Self::SHIFT).saturating_sub(Self::FIRST);
        let bin = usize::try_from(place).unwrap_or(usize::MAX).min(Self::BINS - 1);
        if let Some(count) = self.bins.get_mut(bin) {
            *count += 1;
        }
        self.known += 1;
        self.below += u64::from(bin < self.median);
        // The steps in order of size: the lower median is the one with this many before it.
        let rank = (self.known - 1) / 2;
        let count = |bin: usize| self.bins.get(bin).copied().unwrap_or_default();
        // Below the first bin there are none, and up to the last one there are all: both loops end within.
        while self.below > rank {
            self.median -= 1;
            self.below -= count(self.median);
        }
        while self.below + count(self.median) <= rank {
            self.below += count(self.median);
            self.median += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_median_is_that_of_all_steps_before(
            steps in prop::collection::vec(prop_oneof![1e-6_f64..1.0, 0.9e-3..1.1e-3], 1..200),
        ) {
            let mut watch = TimeWatch::new(1.5);
            let mut time = 0.0;
            watch.step_to(time);
            let mut seen: Vec<f64> = Vec::new();
            for step in steps {
                let next = time + step;
                let step = next - time;
                time = next;
                let judged = watch.step_to(time);
                if seen.len() < 3 {
                    prop_assert_eq!(judged, Step::Usual(step));
                } else {
                    let median = seen[(seen.len() - 1) / 2];
                    if step <= 1.5 * median {
                        prop_assert_eq!(judged, Step::Usual(step));
                    } else if step > 1.5 * median * (1.0 + 1.0 / 31.0) {
                        prop_assert_eq!(judged, Step::Gap(step));
                    }
                }
                seen.insert(seen.partition_point(|known| *known < step), step);
            }
        }

        #[test]
        fn any_times_are_taken(factor in any::<f64>(), times in prop::collection::vec(any::<f64>(), 0..50)) {
            let mut watch = TimeWatch::new(factor);
            for time in times {
                watch.step_to(time);
            }
        }
    }

    #[test]
    fn time_that_does_not_advance_is_told_apart() {
        let mut watch = TimeWatch::new(1.5);
        let steps: Vec<Step> = [1.0, 2.0, 2.0, 1.5, 2.5].map(|time| watch.step_to(time)).to_vec();
        assert_eq!(steps, [Step::First, Step::Usual(1.0), Step::Same, Step::Backward, Step::Usual(1.0)]);
    }

    #[test]
    fn a_burst_of_losses_is_counted_whole() {
        let mut watch = TimeWatch::new(1.5);
        let mut gaps = 0;
        let mut time = 0.0;
        for row in 0..1000 {
            time += if (400..580).contains(&row) { 0.01 } else { 0.005 };
            gaps += u32::from(matches!(watch.step_to(time), Step::Gap(_)));
        }
        assert_eq!(gaps, 180);
    }
}
