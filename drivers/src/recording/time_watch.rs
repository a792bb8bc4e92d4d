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

/// Judges each step against the median of the steps before it.
///
/// The median is that of the last [`REMEMBERED`](Self::REMEMBERED) steps forward (gaps included:
/// as long as fewer than half of them are gaps, they do not move it, and after a change of the
/// sample rate it follows within 16 rows). Nothing is judged before
/// [`FEWEST`](Self::FEWEST) steps are known.
#[derive(Clone, Debug)]
pub(super) struct TimeWatch {
    factor: f64,
    last: Option<f64>,
    /// The steps in the order in which they came, a ring.
    recent: [f64; Self::REMEMBERED],
    oldest: usize,
    /// The same steps in order of size.
    sorted: [f64; Self::REMEMBERED],
    known: usize,
}

impl TimeWatch {
    const REMEMBERED: usize = 31;
    const FEWEST: usize = 3;

    pub(super) const fn new(factor: f64) -> Self {
        Self {
            factor,
            last: None,
            recent: [0.0; Self::REMEMBERED],
            oldest: 0,
            sorted: [0.0; Self::REMEMBERED],
            known: 0,
        }
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
        let gap = self.known >= Self::FEWEST && step > self.factor * self.median();
        self.remember(step);
        if gap { Step::Gap(step) } else { Step::Usual(step) }
    }

    /// The lower median of the steps remembered.
    fn median(&self) -> f64 {
        let known = self.sorted.get(..self.known).unwrap_or_default();
        known.get(known.len().saturating_sub(1) / 2).copied().unwrap_or(f64::INFINITY)
    }

    fn remember(&mut self, step: f64) {
        if self.known == Self::REMEMBERED {
            let forgotten = self.recent.get(self.oldest).copied().unwrap_or_default();
            let at = self.sorted.partition_point(|known| *known < forgotten);
            if let Some(tail) = self.sorted.get_mut(at..) {
                tail.rotate_left(1);
            }
            self.known -= 1;
        }
        if let Some(place) = self.recent.get_mut(self.oldest) {
            *place = step;
        }
        self.oldest = (self.oldest + 1) % Self::REMEMBERED;
        let known = self.sorted.get(..self.known).unwrap_or_default();
        let at = known.partition_point(|known| *known < step);
        if let Some(tail) = self.sorted.get_mut(at..=self.known) {
            tail.rotate_right(1);
            if let Some(first) = tail.first_mut() {
                *first = step;
            }
        }
        self.known += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_median_is_that_of_the_last_steps(steps in prop::collection::vec(1e-6_f64..1.0, 1..120)) {
            let mut watch = TimeWatch::new(1.5);
            let mut time = 0.0;
            watch.step_to(time);
            let mut seen = Vec::new();
            for step in steps {
                let next = time + step;
                let true_step = next - time;
                time = next;
                let mut window: Vec<f64> =
                    seen.iter().rev().take(TimeWatch::REMEMBERED).copied().collect();
                window.sort_by(f64::total_cmp);
                let expected = window.len() >= TimeWatch::FEWEST
                    && true_step > 1.5 * window[(window.len() - 1) / 2];
                prop_assert_eq!(
                    watch.step_to(time),
                    if expected { Step::Gap(true_step) } else { Step::Usual(true_step) }
                );
                seen.push(true_step);
            }
        }
    }

    #[test]
    fn time_that_does_not_advance_is_told_apart() {
        let mut watch = TimeWatch::new(1.5);
        let steps: Vec<Step> = [1.0, 2.0, 2.0, 1.5, 2.5].map(|time| watch.step_to(time)).to_vec();
        assert_eq!(steps, [Step::First, Step::Usual(1.0), Step::Same, Step::Backward, Step::Usual(1.0)]);
    }
}
