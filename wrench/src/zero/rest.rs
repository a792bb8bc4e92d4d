//! Was the sensor really at rest?

use super::rest_limits::Limits;
use crate::{NotAtRest, Real, Tare, TareAccumulator, TareError};
use nalgebra::SVector;

/// Tares only a sensor that was at rest: collects readings, then gives the tare *with its error*, or
/// says which gauge moved, and how.
///
/// Three tests on each gauge, together alarming at most at the stated rate on a resting sensor with
/// independent normal noise (Bonferroni):
/// - **drift**: the slope of a straight line through the readings, Student's t;
/// - **unsteadiness**: the spread of the means of 16 to 31 equal stretches against the spread of
///   readings (analysis of variance), which grows when something slower than a stretch moves: an arm
///   that still swings, a hand that is lifted;
/// - **outlier**: the reading farthest from the mean against the standard deviation (Grubbs 1950): a
///   knock.
///
/// Noise of converters is not quite independent from reading to reading; the test looks at stretches
/// so that this does not matter. A vibration faster than a stretch averages out of the tare and is not
/// seen, unless the usual noise is known ([`with_known_noise`](Self::with_known_noise)): then a
/// variance well above it counts as unsteadiness too. A constant load cannot be told from none: the
/// test says "at rest", never "unloaded".
///
/// ```
/// use fingertip_wrench::{NotAtRest, RestTest};
/// use nalgebra::SVector;
///
/// let mut rest = RestTest::<f64, 6>::new(1e-3)?;
/// for i in 0..200 {
///     // Some noise, and gauge 4 creeps.
///     let mut reading = SVector::repeat(f64::from(i * 7919 % 101) * 1e-5);
///     reading[4] += f64::from(i) * 1e-4;
///     rest.add(&reading);
/// }
/// assert!(matches!(rest.finish(), Err(NotAtRest::Drifts { gauge: 4, .. })));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestTest<T: Real, const N: usize> {
    moments: TareAccumulator<T, N>,
    /// Σ (i − ī)(v − v̄).
    with_time: SVector<T, N>,
    /// Sums of the readings less the first one, of stretches of equal length; the last may be
    /// unfinished.
    stretches: [SVector<T, N>; STRETCHES],
    /// Binary logarithm of the length of a stretch.
    doublings: u32,
    first: SVector<T, N>,
    least: SVector<T, N>,
    greatest: SVector<T, N>,
    resolution: SVector<T, N>,
    /// The reading before, if the resolution is to be found.
    before: Option<Option<SVector<T, N>>>,
    tolerance: SVector<T, N>,
    known_noise: Option<SVector<T, N>>,
    rejected: u32,
    false_alarm_rate: f64,
}

/// When so many stretches are full, neighbours are joined.
const STRETCHES: usize = 32;

/// The tare of a sensor that was at rest.
///
/// ```
/// use fingertip_wrench::{NotAtRest, RestTest};
/// use nalgebra::Vector6;
///
/// let mut rest = RestTest::<f64, 6>::new(1e-3)?;
/// for i in 0..400 {
///     // A zero of 0.2 V, and noise between −0.5 and 0.5 mV.
///     rest.add(&Vector6::repeat(0.2 + (f64::from(i * 7919 % 101) - 50.0) * 1e-5));
/// }
/// let rested = rest.finish()?;
/// assert!((rested.tare.zero()[0] - 0.2).abs() < 1e-5);
/// assert!((rested.noise[0] - 0.29e-3).abs() < 0.01e-3); // 1 mV over √12
/// assert!(rested.tare_noise[0] >= rested.noise[0] / 20.0); // of 400 readings
/// # Ok::<(), NotAtRest>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Rested<T: Real, const N: usize> {
    /// Mean readings, to be subtracted.
    pub tare: Tare<T, N>,
    /// Standard deviation of one reading of each gauge.
    pub noise: SVector<T, N>,
    /// Standard deviation of the tare itself: noise over the root of the number of readings, or what
    /// the spread of the stretches says if that is more.
    pub tare_noise: SVector<T, N>,
    /// How many readings went in.
    pub samples: u32,
}

impl<T: Real, const N: usize> RestTest<T, N> {
    /// The fewest readings that are judged.
    pub const LEAST_SAMPLES: u32 = 32;

    /// With the fraction of tares at rest that may be refused wrongly.
    ///
    /// # Errors
    /// [`NotAtRest::BadParameter`] for a rate that is not between 0 and 1.
    pub fn new(false_alarm_rate: f64) -> Result<Self, NotAtRest> {
        if !(false_alarm_rate > 0.0 && false_alarm_rate < 1.0) {
            return Err(NotAtRest::BadParameter);
        }
        Ok(Self {
            moments: TareAccumulator::default(),
            with_time: SVector::zeros(),
            stretches: [SVector::zeros(); STRETCHES],
            doublings: 0,
            first: SVector::zeros(),
            least: SVector::repeat(T::GREATEST),
            greatest: SVector::repeat(-T::GREATEST),
            resolution: SVector::zeros(),
            before: None,
            tolerance: SVector::zeros(),
            known_noise: None,
            rejected: 0,
            false_alarm_rate,
        })
    }

    /// The same for a converter whose readings come in steps: motion of less than a step is not
    /// motion. Needed where the noise is smaller than a step.
    ///
    /// # Errors
    /// [`NotAtRest::BadParameter`] for a step that is negative or not finite.
    pub fn with_resolution(self, step: SVector<T, N>) -> Result<Self, NotAtRest> {
        if step.iter().all(|x| *x >= T::zero() && x.is_number()) {
            Ok(Self { resolution: step, ..self })
        } else {
            Err(NotAtRest::BadParameter)
        }
    }

    /// The same, taking the smallest change of each gauge from reading to reading for the step of its
    /// converter. That is the step if it shows in the noise, and next to nothing if it does not.
    #[must_use]
    pub fn finding_resolution(self) -> Self {
        Self { before: Some(None), ..self }
    }

    /// The same, putting up with a motion this large, in the unit of the readings: of the fitted line
    /// from end to end, and as standard deviation from stretch to stretch. A rig that never stops
    /// trembling can then be tared; the noise of the tare includes the tremble.
    ///
    /// # Errors
    /// [`NotAtRest::BadParameter`] for a motion that is negative or not finite.
    pub fn with_tolerance(self, motion: SVector<T, N>) -> Result<Self, NotAtRest> {
        if motion.iter().all(|x| *x >= T::zero() && x.is_number()) {
            Ok(Self { tolerance: motion, ..self })
        } else {
            Err(NotAtRest::BadParameter)
        }
    }

    /// The same, knowing the standard deviation of each gauge at rest from earlier.
    ///
    /// # Errors
    /// [`NotAtRest::BadParameter`] for a deviation that is not positive and finite.
    pub fn with_known_noise(self, noise: SVector<T, N>) -> Result<Self, NotAtRest> {
        if noise.iter().all(|x| *x > T::zero() && x.is_number()) {
            Ok(Self { known_noise: Some(noise), ..self })
        } else {
            Err(NotAtRest::BadParameter)
        }
    }

    /// Takes one reading; one that is not finite is counted, and `false` returned.
    pub fn add(&mut self, raw: &SVector<T, N>) -> bool {
        self.add_compensated(raw, raw)
    }

    /// Takes one reading of which known drift has been taken off. What came from the converter tells its
    /// resolution.
    pub fn add_compensated(&mut self, converted: &SVector<T, N>, raw: &SVector<T, N>) -> bool {
        let before = *self.moments.mean();
        let samples = self.moments.samples();
        if !self.moments.add(raw) {
            self.rejected = self.rejected.saturating_add(1);
            return false;
        }
        if let Some(last) = &mut self.before {
            if let Some(last) = last {
                self.resolution = self.resolution.zip_map(&(converted - *last).abs(), |least, change| {
                    let smaller = !(least > T::zero() && least <= change);
                    if change > T::zero() && change.is_number() && smaller { change } else { least }
                });
            }
            *last = Some(*converted);
        }
        // Welford's recurrence for the product with the number of the reading.
        let time = T::literal((f64::from(samples) + 1.0) * 0.5);
        self.with_time += (raw - before) * time * (T::literal(f64::from(samples)) / self.count());
        if samples == 0 {
            self.first = *raw;
        }
        self.extend_stretches(&(raw - self.first), samples);
        self.least = self.least.inf(raw);
        self.greatest = self.greatest.sup(raw);
        true
    }

    fn extend_stretches(&mut self, reading: &SVector<T, N>, samples: u32) {
        let mut stretch = (samples >> self.doublings.min(31)) as usize;
        if stretch >= STRETCHES {
            for i in 0..STRETCHES / 2 {
                self.stretches[i] = self.stretches[2 * i] + self.stretches[2 * i + 1];
            }
            self.stretches[STRETCHES / 2..].fill(SVector::zeros());
            self.doublings = self.doublings.saturating_add(1);
            stretch = STRETCHES / 2;
        }
        if let Some(sum) = self.stretches.get_mut(stretch) {
            *sum += reading;
        }
    }

    fn stretch_length(&self) -> f64 {
        f64::from(1_u32 << self.doublings.min(31))
    }

    /// Variance of the means of the finished stretches, times their length: that of one reading, if
    /// readings are independent. And how many there are.
    fn variance_by_stretches(&self, gauge: usize) -> (f64, f64) {
        let finished = ((self.moments.samples() >> self.doublings.min(31)) as usize).min(STRETCHES);
        let length = self.stretch_length();
        let means = || self.stretches.iter().take(finished).map(|sum| sum[gauge].to_f64() / length);
        let count = finished as f64;
        let mean = means().sum::<f64>() / count;
        let scatter: f64 = means().map(|x| x - mean).map(|off| off * off).sum();
        (scatter / (count - 1.0) * length, count)
    }

    fn count(&self) -> T {
        T::literal(f64::from(self.moments.samples()))
    }

    /// The verdict, and the tare if it is good.
    ///
    /// # Errors
    /// [`NotAtRest`]: what was wrong, and with which gauge.
    pub fn finish(&self) -> Result<Rested<T, N>, NotAtRest> {
        let samples = self.moments.samples();
        if self.rejected > 0 {
            return Err(NotAtRest::NotFinite { rejected: self.rejected });
        }
        let too_few = NotAtRest::TooFewSamples { samples, needed: Self::LEAST_SAMPLES };
        if samples < Self::LEAST_SAMPLES {
            return Err(too_few);
        }
        let refused = |error| match error {
            TareError::TooFewSamples { .. } => too_few,
            TareError::OutOfRange { gauge } => NotAtRest::OutOfRange { gauge },
        };
        let noise = self.moments.noise().map_err(refused)?;
        let limits = Limits::new(f64::from(samples), self.false_alarm_rate / (3 * N) as f64);
        for gauge in 0..N {
            self.judge(gauge, noise[gauge], &limits)?;
        }
        let tare = self.tare().map_err(refused)?;
        let tare_noise = SVector::from_fn(|gauge, _| {
            let by_stretches = T::literal(self.variance_by_stretches(gauge).0).root();
            noise[gauge].max(by_stretches) / self.count().root()
        });
        Ok(Rested { tare, noise, tare_noise, samples })
    }

    /// The mean readings, at rest or not.
    ///
    /// # Errors
    /// [`TareError`] if there are none, or they are too large.
    pub fn tare(&self) -> Result<Tare<T, N>, TareError> {
        self.moments.finish()
    }

    fn judge(&self, gauge: usize, noise: T, limits: &Limits) -> Result<(), NotAtRest> {
        let n = self.count().to_f64();
        // A step of the converter counts as noise: it hides as much.
        let step = self.resolution[gauge].to_f64();
        let measured = noise.to_f64();
        let spread = nalgebra::ComplexField::sqrt(measured * measured + step * step / 12.0);
        if !spread.is_finite() {
            return Err(NotAtRest::OutOfRange { gauge });
        }
        let mean = self.moments.mean()[gauge];
        let farthest = (self.greatest[gauge] - mean).max(mean - self.least[gauge]).to_f64();
        if farthest - step / 2.0 > limits.outlier * spread {
            return Err(NotAtRest::Outlier { gauge, over_noise: farthest / spread });
        }
        // The slope of the line, over what noise makes of it; Σ(i−ī)² is n(n²−1)/12.
        let times = n * (n * n - 1.0) / 12.0;
        let slope = self.with_time[gauge].to_f64() / times;
        let about_line = (n - 1.0) * spread * spread - slope * slope * times;
        let line_noise = nalgebra::ComplexField::sqrt((about_line / (n - 2.0)).max(0.0));
        let slope_noise = line_noise / nalgebra::ComplexField::sqrt(times);
        let tolerated = step.max(self.tolerance[gauge].to_f64());
        let moved = slope.abs() * (n - 1.0);
        if moved - tolerated > limits.slope * slope_noise * (n - 1.0) {
            return Err(NotAtRest::Drifts { gauge, over_noise: moved / spread });
        }
        let (by_stretches, stretches) = self.variance_by_stretches(gauge);
        let length = self.stretch_length();
        let expected = spread * spread + length * tolerated * tolerated;
        let unsteady = by_stretches > limits.variance(stretches - 1.0) * expected;
        let too_wide = self.known_noise.is_some_and(|known| {
            let known = known[gauge].to_f64();
            spread * spread > limits.variance(n - 1.0) * (known * known + step * step / 12.0)
        });
        if unsteady || too_wide { Err(NotAtRest::Unsteady { gauge }) } else { Ok(()) }
    }
}
