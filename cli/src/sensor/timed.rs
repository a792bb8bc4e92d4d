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
