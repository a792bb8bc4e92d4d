//! A sensor that sends the time of each sample but no number: what is missing shows in the times.

use fingertip_wrench::Wrench;

use super::{Losses, Opened, SensorFault};
use crate::Sample;
use crate::middleware::Watch;

/// Counts the samples that are missing, by their times and the rate of the sensor.
pub(crate) struct Timed<S> {
    sensor: S,
    watch: Watch<f64, Wrench<f64>>,
}

impl<S> Timed<S> {
    /// A sensor that gives so many samples a second.
    pub(crate) fn new(sensor: S, rate: f64) -> Self {
        Self { sensor, watch: Watch::new(Some(rate.recip())) }
    }
}

impl<S: Opened> Opened for Timed<S> {
    fn next(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, SensorFault> {
        let next = self.sensor.next()?;
        if let Some(sample @ Sample { time: Some(time), .. }) = next {
            self.watch.arrive(sample, time);
        }
        Ok(next)
    }

    fn losses(&self) -> Losses {
        let counts = self.watch.counts();
        Losses { lost: Some(counts.missing), late: counts.backward, ..self.sensor.losses() }
    }
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::Wrench;

    use super::*;

    /// Gives samples of these times; what is not finite stands for a sample without one.
    struct At(Vec<f64>);

    impl Opened for At {
        fn next(&mut self) -> Result<Option<Sample<f64, Wrench<f64>>>, SensorFault> {
            if self.0.is_empty() {
                return Ok(None);
            }
            let time = Some(self.0.remove(0)).filter(|time| time.is_finite());
            Ok(Some(Sample { time, value: Wrench::zero() }))
        }
        fn losses(&self) -> Losses {
            Losses { corrupt: 5, ..Losses::default() }
        }
    }

    #[test]
    fn what_is_missing_shows_in_the_times() {
        // At 100 a second: 0.02 is missing, then 0.05 to 0.07, and 0.03 comes late.
        let times = vec![0.0, 0.01, 0.03, 0.04, 0.08, f64::NAN, 0.03, 0.09];
        let mut sensor = Timed::new(At(times), 100.0);
        let mut lost = Vec::new();
        while let Ok(Some(_)) = sensor.next() {
            lost.push(sensor.losses().lost);
        }
        assert_eq!(lost[..6], [Some(0), Some(0), Some(1), Some(1), Some(4), Some(4)]);
        assert_eq!((sensor.losses().late, sensor.losses().corrupt), (1, 5));
    }
}
