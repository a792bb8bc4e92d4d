//! A sensor that sends the time of each sample but no number: what is missing shows in the times.

use fingertip::wrench::Wrench;
use fingertip_drivers::Sample;
use fingertip_drivers::middleware::Watch;

use super::{Feed, Losses, Next};

/// Counts the samples that are missing, by their times and the rate of the sensor.
pub(super) struct Timed {
    feed: Box<dyn Feed>,
    watch: Watch<f64, Wrench<f64>>,
}

impl Timed {
    /// A sensor that gives so many samples a second.
    pub(super) fn new(feed: Box<dyn Feed>, rate: f64) -> Self {
        Self { feed, watch: Watch::new(Some(rate.recip())) }
    }
}

impl Feed for Timed {
    fn next(&mut self) -> Result<Next, String> {
        let next = self.feed.next()?;
        if let Next::Reading(reading) = &next
            && let Some(time) = reading.time
        {
            self.watch.arrive(Sample { time: reading.time, value: reading.wrench }, time);
        }
        Ok(next)
    }

    fn losses(&self) -> Losses {
        let counts = self.watch.counts();
        Losses { lost: Some(counts.missing), late: counts.backward, ..self.feed.losses() }
    }
}

#[cfg(test)]
mod tests {
    use fingertip::wrench::Wrench;

    use super::super::{Feed, Losses, Next, Reading};
    use super::Timed;

    /// Gives samples of these times; what is not finite stands for a sample without one.
    struct At(Vec<f64>);

    impl Feed for At {
        fn next(&mut self) -> Result<Next, String> {
            if self.0.is_empty() {
                return Ok(Next::Silence);
            }
            let time = Some(self.0.remove(0)).filter(|time| time.is_finite());
            Ok(Next::Reading(Reading { time, wrench: Wrench::zero(), volts: None }))
        }
        fn losses(&self) -> Losses {
            Losses { corrupt: 5, ..Losses::default() }
        }
    }

    #[test]
    fn what_is_missing_shows_in_the_times() {
        // At 100 a second: 0.02 is missing, then 0.05 to 0.07, and 0.03 comes late.
        let times = vec![0.0, 0.01, 0.03, 0.04, 0.08, f64::NAN, 0.03, 0.09];
        let mut feed = Timed::new(Box::new(At(times)), 100.0);
        let mut lost = Vec::new();
        while let Ok(Next::Reading(_)) = feed.next() {
            lost.push(feed.losses().lost);
        }
        assert_eq!(lost[..6], [Some(0), Some(0), Some(1), Some(1), Some(4), Some(4)]);
        assert_eq!((feed.losses().late, feed.losses().corrupt), (1, 5));
    }
}
