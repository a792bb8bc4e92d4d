//! How old samples are, how many are missing, and which are repeated.

use fingertip_wrench::Real;

use crate::polled::NbSource;
use crate::{Sample, Source};

/// A sample, and how fresh it is.
///
/// ```
/// use fingertip_drivers::Sample;
/// use fingertip_drivers::middleware::Watch;
///
/// // Samples of 1 kHz; the third is missing, and the fourth was 2 ms longer under way than the quickest.
/// let mut watch = Watch::new(Some(1e-3));
/// watch.arrive(Sample { time: Some(0.0), value: 1.0 }, 10.0);
/// watch.arrive(Sample { time: Some(1e-3), value: 2.0 }, 10.001);
/// let fresh = watch.arrive(Sample { time: Some(3e-3), value: 2.0 }, 10.005);
/// assert!(fresh.age.is_some_and(|age: f64| (age - 2e-3).abs() < 1e-9));
/// assert_eq!((fresh.missing, fresh.repeated), (1, true));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fresh<T, V> {
    /// The sample.
    pub sample: Sample<T, V>,
    /// How much longer it was under way than the quickest sample so far \[s\]: what has queued up in
    /// buffers. `None` if samples have no time. The delay of the quickest one itself cannot be known
    /// from one clock's difference to another, and is not in it.
    pub age: Option<T>,
    /// How many samples should have come between the last one and this one, by their times and the
    /// period that was stated; 0 without those.
    pub missing: u64,
    /// Whether the value is exactly that of the last one. A converter with some noise hardly ever
    /// gives all channels twice: a run of repetitions is a source that has frozen.
    pub repeated: bool,
}

/// What was read so far.
///
/// ```
/// use fingertip_drivers::Sample;
/// use fingertip_drivers::middleware::Watch;
///
/// // A source that has frozen.
/// let mut watch = Watch::<f64, f64>::new(None);
/// for value in [1.0, 2.0, 2.0, 2.0, 2.0] {
///     watch.arrive(Sample { time: None, value }, 0.0);
/// }
/// assert_eq!((watch.counts().given, watch.counts().longest_freeze), (5, 3));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ReadCounts {
    /// Samples given to the caller.
    pub given: u64,
    /// Samples read and passed over for a newer one, by reading the latest.
    pub passed_over: u64,
    /// Samples that never came, by times and period.
    pub missing: u64,
    /// Samples with exactly the value of the one before.
    pub repeated: u64,
    /// The longest run of repetitions.
    pub longest_freeze: u64,
    /// Samples whose time was not after that of the one before.
    pub backward: u64,
    /// Errors of the source.
    pub errors: u64,
}

/// Follows samples as they come. [`Watched`] does this around a source; use it alone where samples
/// come by another way.
///
/// ```
/// use fingertip_drivers::Sample;
/// use fingertip_drivers::middleware::Watch;
///
/// // Samples of 1 kHz that come as messages; some are missing, and one comes late.
/// let mut watch = Watch::new(Some(1e-3));
/// for milliseconds in [0.0, 1.0, 4.0, 3.0] {
///     watch.arrive(Sample { time: Some(1e-3 * milliseconds), value: milliseconds }, 10.0);
/// }
/// assert_eq!((watch.counts().missing, watch.counts().backward), (2, 1));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Watch<T, V> {
    period: Option<T>,
    last: Option<Sample<T, V>>,
    /// Least (arrival − sample time) so far.
    quickest: Option<T>,
    freeze: u64,
    counts: ReadCounts,
}

impl<T: Real, V: Copy + PartialEq> Watch<T, V> {
    /// For samples at a period \[s\], or `None` to count no missing ones. A period that is not
    /// positive and finite is none.
    #[must_use]
    pub fn new(period: Option<T>) -> Self {
        let period = period.filter(|period| *period > T::zero() && period.is_number());
        Self { period, last: None, quickest: None, freeze: 0, counts: ReadCounts::default() }
    }

    /// Takes a sample that came at the time `now` of the caller's clock \[s\].
    pub fn arrive(&mut self, sample: Sample<T, V>, now: T) -> Fresh<T, V> {
        self.counts.given += 1;
        let last = self.last.replace(sample);
        let repeated = last.is_some_and(|last| last.value == sample.value);
        self.freeze = if repeated { self.freeze + 1 } else { 0 };
        self.counts.repeated += u64::from(repeated);
        self.counts.longest_freeze = self.counts.longest_freeze.max(self.freeze);
        let step = last.and_then(|last| Some(sample.time? - last.time?));
        if step.is_some_and(|step| !(step > T::zero())) {
            self.counts.backward += 1;
            // A clock that was set anew says nothing about delays any more.
            self.quickest = None;
        }
        let missing = self.missing_in(step);
        self.counts.missing = self.counts.missing.saturating_add(missing);
        let age = sample.time.map(|time| now - time).filter(|delay| delay.is_number()).map(|delay| {
            let quickest =
                self.quickest.map_or(delay, |quickest| if delay < quickest { delay } else { quickest });
            self.quickest = Some(quickest);
            delay - quickest
        });
        Fresh { sample, age, missing, repeated }
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is positive")]
    fn missing_in(&self, step: Option<T>) -> u64 {
        let (Some(step), Some(period)) = (step, self.period) else { return 0 };
        let periods = (step / period).to_f64();
        // The nearest whole number, less the step that is due; NaN and negative steps become 0.
        (periods + 0.5) as u64 - u64::from(periods + 0.5 >= 1.0)
    }

    /// Notes that the sample taken last was passed over for a newer one.
    pub const fn pass_over(&mut self) {
        self.counts.given = self.counts.given.saturating_sub(1);
        self.counts.passed_over += 1;
    }

    /// Notes an error of the source.
    pub const fn error(&mut self) {
        self.counts.errors += 1;
    }

    /// What was read so far.
    #[must_use]
    pub const fn counts(&self) -> &ReadCounts {
        &self.counts
    }
}

/// A source whose samples are watched, and which can be read without loss or to the latest sample.
///
/// The caller gives the time of its own clock with each call: there is no hidden clock. `V` is what
/// the source gives: `Wrench<T>`, or `SVector<T, N>` for signals.
///
/// ```
/// use fingertip_drivers::middleware::Watched;
/// use fingertip_drivers::playback::WrenchPlayback;
/// use fingertip_recordings::RecordingReader;
///
/// let file =
///     "time_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0,0,0,-1,0,0,0\n0.001,0,0,-1,0,0,0\n0.005,0,0,-3,0,0,0\n";
/// let playback = WrenchPlayback::new(RecordingReader::new("example.csv", file.as_bytes())?, "")?;
/// let mut watched = Watched::new(playback, Some(1e-3));
/// while let Some(fresh) = watched.next_fresh(0.0)? {
///     assert!(fresh.sample.value.force().z < 0.0);
/// }
/// let counts = watched.counts();
/// assert_eq!((counts.given, counts.missing, counts.repeated), (3, 3, 1));
/// # Ok::<(), fingertip_recordings::RecordingError>(())
/// ```
#[derive(Debug)]
pub struct Watched<S, T, V> {
    source: S,
    watch: Watch<T, V>,
}

impl<S, T: Real, V: Copy + PartialEq> Watched<S, T, V> {
    /// Most samples that reading the latest one passes over in one call, so that a source that is
    /// quicker than its reader cannot hold it for ever.
    pub const MOST_PASSED_OVER: usize = 4096;

    /// Around a source with a period \[s\], or `None` to count no missing samples.
    #[must_use]
    pub fn new(source: S, period: Option<T>) -> Self {
        Self { source, watch: Watch::new(period) }
    }

    /// What was read so far.
    #[must_use]
    pub const fn counts(&self) -> &ReadCounts {
        self.watch.counts()
    }

    /// The source inside.
    #[must_use]
    pub const fn source(&self) -> &S {
        &self.source
    }

    /// The source inside.
    #[must_use]
    pub fn into_source(self) -> S {
        self.source
    }

    /// The next sample, each one in turn: for records.
    ///
    /// # Errors
    /// Those of the source.
    pub fn next_fresh(&mut self, now: T) -> Result<Option<Fresh<T, V>>, S::Error>
    where
        S: Source<T, V>,
    {
        match self.source.next_sample() {
            Ok(sample) => Ok(sample.map(|sample| self.watch.arrive(sample, now))),
            Err(error) => {
                self.watch.error();
                Err(error)
            }
        }
    }

    /// The newest sample that is there, passing over older ones: for control that must not lag.
    ///
    /// # Errors
    /// `WouldBlock` if none has come since the last call, otherwise those of the source. After an
    /// error what was read before it is gone, since it would be old by the next call.
    pub fn latest(&mut self, now: T) -> nb::Result<Option<Fresh<T, V>>, S::Error>
    where
        S: NbSource<T, V>,
    {
        let mut latest: Option<Fresh<T, V>> = None;
        let mut missing = 0_u64;
        for _ in 0..=Self::MOST_PASSED_OVER {
            match self.source.poll_sample() {
                Ok(Some(sample)) => {
                    if latest.is_some() {
                        self.watch.pass_over();
                    }
                    let fresh = self.watch.arrive(sample, now);
                    missing = missing.saturating_add(fresh.missing);
                    latest = Some(Fresh { missing, ..fresh });
                }
                Ok(None) | Err(nb::Error::WouldBlock) if latest.is_some() => break,
                Ok(None) => return Ok(None),
                Err(nb::Error::WouldBlock) => return Err(nb::Error::WouldBlock),
                Err(nb::Error::Other(error)) => {
                    self.watch.error();
                    if latest.is_some() {
                        // It would be passed over for the error, and was never given.
                        self.watch.pass_over();
                    }
                    return Err(nb::Error::Other(error));
                }
            }
        }
        Ok(latest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::convert::Infallible;
    use fingertip_wrench::Wrench;
    use nalgebra::{Vector1, Vector3};

    fn sample(time: f64, value: f64) -> Sample<f64, Vector1<f64>> {
        Sample { time: Some(time), value: Vector1::new(value) }
    }

    #[test]
    fn age_missing_and_repeated_are_told() {
        let mut watch = Watch::new(Some(1e-3));
        // The device's clock began 100 s before the caller's, and the way takes 2 ms at best.
        let mut arrive = |number: f64, value, delay| {
            watch.arrive(sample(number * 1e-3, value), number * 1e-3 - 100.0 + delay)
        };
        let first = arrive(0.0, 1.0, 3e-3);
        assert_eq!((first.age, first.missing, first.repeated), (Some(0.0), 0, false));
        let quick = arrive(1.0, 2.0, 2e-3);
        assert_eq!(quick.age, Some(0.0));
        let late = arrive(4.0, 2.0, 12e-3);
        assert!((late.age.unwrap() - 10e-3).abs() < 1e-12, "{late:?}");
        assert_eq!((late.missing, late.repeated), (2, true));
        let back = arrive(3.0, 5.0, 2e-3);
        assert_eq!((back.missing, back.age), (0, Some(0.0)));
        let counts = ReadCounts {
            given: 4,
            missing: 2,
            repeated: 1,
            longest_freeze: 1,
            backward: 1,
            ..ReadCounts::default()
        };
        assert_eq!(*watch.counts(), counts);
    }

    /// The device begins to count anew, fifty seconds behind: what is under way from then on is told against the
    /// quickest since, not against one of before.
    #[test]
    fn a_clock_that_was_set_back_begins_the_ages_anew() {
        let mut watch = Watch::new(None);
        let ages = [(60.0, 60.5), (61.0, 61.25), (11.0, 62.5), (12.0, 63.25), (13.0, 64.75)]
            .map(|(time, now)| watch.arrive(sample(time, time), now).age);
        assert_eq!(ages, [Some(0.0), Some(0.0), Some(0.0), Some(0.0), Some(0.5)]);
        assert_eq!(watch.counts().backward, 1);
    }

    #[test]
    fn times_that_make_no_sense_do_not_matter() {
        for period in [Some(0.0), Some(-1.0), Some(f64::NAN), Some(1e-300), None] {
            let mut watch = Watch::new(period);
            for time in [0.0, f64::NAN, f64::INFINITY, -1e300, 1e300] {
                let fresh = watch.arrive(sample(time, time), f64::NAN);
                assert_eq!(fresh.age, None);
            }
            assert_eq!(watch.counts().given, 5);
        }
    }

    /// Gives some numbers, with pauses for `None`.
    struct Queue(core::array::IntoIter<Option<f64>, 6>);
    impl NbSource<f64, Wrench<f64>> for Queue {
        type Error = Infallible;

        fn poll_sample(&mut self) -> nb::Result<Option<Sample<f64, Wrench<f64>>>, Infallible> {
            match self.0.next() {
                Some(Some(number)) => {
                    let value = Wrench::on_fingertip(Vector3::new(number, 0.0, 0.0), Vector3::zeros());
                    Ok(Some(Sample { time: Some(number), value }))
                }
                Some(None) => Err(nb::Error::WouldBlock),
                None => Ok(None),
            }
        }
    }

    #[test]
    fn the_latest_passes_over_what_has_queued_up() {
        let numbers = [None, Some(1.0), Some(2.0), Some(5.0), None, Some(6.0)];
        let mut watched = Watched::new(Queue(numbers.into_iter()), Some(1.0));
        assert_eq!(watched.latest(0.0), Err(nb::Error::WouldBlock));
        let latest = watched.latest(6.0).unwrap().unwrap();
        assert_eq!((latest.sample.time, latest.missing), (Some(5.0), 2));
        assert_eq!(watched.latest(7.0).unwrap().unwrap().sample.time, Some(6.0));
        assert_eq!(watched.latest(8.0).unwrap(), None);
        let counts = ReadCounts { given: 2, passed_over: 2, missing: 2, ..ReadCounts::default() };
        assert_eq!(*watched.counts(), counts);
    }
}
