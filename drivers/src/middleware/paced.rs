//! Replay as it was recorded, or at another speed.

use core::time::Duration;
use std::thread;
use std::time::Instant;

use fingertip_wrench::Real;

use crate::{Sample, Source};

/// Gives each sample no sooner than its time says, counted from the first: a recording that plays.
///
/// Times are not changed. A sample without a time, one whose time goes back, and one behind a gap longer
/// than [`LONGEST_WAIT`](Self::LONGEST_WAIT) are given at once, and time counts anew from there.
///
/// ```
/// use fingertip_drivers::Source;
/// use fingertip_drivers::middleware::Paced;
/// use fingertip_drivers::playback::WrenchPlayback;
/// use fingertip_recordings::RecordingReader;
/// use std::time::{Duration, Instant};
///
/// // 40 ms of a recording, twice as fast.
/// let file = "time_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n7,0,0,-1,0,0,0\n7.04,0,0,-3,0,0,0\n";
/// let playback = WrenchPlayback::new(RecordingReader::new("example.csv", file.as_bytes())?, "")?;
/// let (mut paced, start) = (Paced::new(playback, 2.0), Instant::now());
/// while paced.next_sample()?.is_some() {}
/// assert!(start.elapsed() >= Duration::from_millis(20));
/// # Ok::<(), fingertip_recordings::RecordingError>(())
/// ```
#[derive(Debug)]
pub struct Paced<S> {
    source: S,
    speed: f64,
    start: Option<(Instant, f64)>,
    last: f64,
}

impl<S> Paced<S> {
    /// The longest step between samples that is waited for \[s of the recording\].
    pub const LONGEST_WAIT: f64 = 60.0;

    /// Plays a source at a speed: 1 as recorded, 2 twice as fast. A speed that is not positive and
    /// finite does not wait.
    #[must_use]
    pub const fn new(source: S, speed: f64) -> Self {
        Self { source, speed, start: None, last: 0.0 }
    }

    /// The source inside.
    #[must_use]
    pub const fn source(&self) -> &S {
        &self.source
    }

    /// How long to wait for a sample of that time.
    fn wait(&mut self, time: Option<f64>, now: Instant) -> Duration {
        let Some(time) = time.filter(|time| time.is_finite()) else { return Duration::ZERO };
        let step = time - self.last;
        self.last = time;
        match self.start {
            Some((begun, first)) if (0.0..=Self::LONGEST_WAIT).contains(&step) => {
                let due = Duration::try_from_secs_f64((time - first) / self.speed).unwrap_or_default();
                due.saturating_sub(now.saturating_duration_since(begun))
            }
            _ => {
                self.start = Some((now, time));
                Duration::ZERO
            }
        }
    }
}

impl<T: Real, V, S: Source<T, V>> Source<T, V> for Paced<S> {
    type Error = S::Error;

    fn next_sample(&mut self) -> Result<Option<Sample<T, V>>, S::Error> {
        let sample = self.source.next_sample()?;
        if let Some(sample) = &sample {
            let wait = self.wait(sample.time.map(Real::to_f64), Instant::now());
            if !wait.is_zero() {
                thread::sleep(wait);
            }
        }
        Ok(sample)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waits_follow_the_times_and_the_speed() {
        let begin = Instant::now();
        let at = |seconds: f64| begin + Duration::from_secs_f64(seconds);
        let mut paced = Paced::new((), 2.0);
        assert_eq!(paced.wait(Some(10.0), at(0.0)), Duration::ZERO);
        let wait = paced.wait(Some(11.0), at(0.1));
        assert!((wait.as_secs_f64() - 0.4).abs() < 1e-9, "{wait:?}");
        // Too late already; then a gap, a step back, and a time that is none.
        assert_eq!(paced.wait(Some(12.0), at(5.0)), Duration::ZERO);
        for time in [Some(1e6), Some(-3.0), None, Some(f64::NAN)] {
            assert_eq!(paced.wait(time, at(5.0)), Duration::ZERO);
        }
        let wait = paced.wait(Some(-1.0), at(5.0));
        assert!((wait.as_secs_f64() - 1.0).abs() < 1e-9, "{wait:?}");
        for speed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let mut paced = Paced::new((), speed);
            paced.wait(Some(0.0), at(0.0));
            assert_eq!(paced.wait(Some(1.0), at(0.0)), Duration::ZERO);
        }
    }
}
