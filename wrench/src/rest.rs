//! Was the sensor really at rest?

use nalgebra::SVector;
use thiserror::Error;

use crate::false_alarm::{normal_quantile, student_quantile};
use crate::{Real, Tare, TareAccumulator};

/// Tares only a sensor that was at rest: collects readings, then gives the tare *with its error*, or
/// says which gauge moved, and how.
///
/// Three tests on each gauge, together alarming at most at the stated rate on a resting sensor with
/// independent normal noise (Bonferroni):
/// - **drift**: the slope of a straight line through the readings, Student's t;
/// - **unsteadiness**: the mean square of successive differences against the variance (von Neumann
///   1941), which falls when readings hang together: slow motion, vibration below half the sampling
///   rate, an arm that still swings;
/// - **outlier**: the reading farthest from the mean against the standard deviation (Grubbs 1950): a
///   knock.
///
/// No noise level needs to be known beforehand; if one is ([`with_known_noise`](Self::with_known_noise)),
/// a variance well above it counts as unsteadiness too. A constant load cannot be told from none: the
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
    successive: SVector<T, N>,
    last: SVector<T, N>,
    least: SVector<T, N>,
    greatest: SVector<T, N>,
    resolution: SVector<T, N>,
    known_noise: Option<SVector<T, N>>,
    rejected: u32,
    false_alarm_rate: f64,
}

/// The tare of a sensor that was at rest.
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
    /// Standard deviation of the tare itself: noise over the root of the number of readings.
    pub tare_noise: SVector<T, N>,
    /// How many readings went in.
    pub samples: u32,
}

/// Why there is no tare. Gauges count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NotAtRest {
    /// Too few readings for the tests to mean anything.
    #[error("at least {needed} readings at rest are needed, not {samples}")]
    TooFewSamples {
        /// How many finite readings there were.
        samples: u32,
        /// How many are needed.
        needed: u32,
    },
    /// Readings that were NaN or infinite.
    #[error("{rejected} of the readings were not finite numbers")]
    NotFinite {
        /// How many.
        rejected: u32,
    },
    /// A gauge moved steadily.
    #[error("gauge {gauge} drifted by {over_noise:.2} times its noise during the readings")]
    Drifts {
        /// Which one.
        gauge: usize,
        /// How far the fitted line moved over all readings, in standard deviations of one reading.
        over_noise: f64,
    },
    /// A gauge's readings hang together more than noise does, or spread more than its noise is known
    /// to.
    #[error("gauge {gauge} is unsteady: its readings are not independent noise of the usual size")]
    Unsteady {
        /// Which one.
        gauge: usize,
    },
    /// A reading far from the others.
    #[error("gauge {gauge} has a reading {over_noise:.1} times its noise away from the mean")]
    Outlier {
        /// Which one.
        gauge: usize,
        /// How far, in standard deviations of one reading.
        over_noise: f64,
    },
    /// The rate of false alarms is not between 0 and 1, both excluded, or a noise or resolution is
    /// negative or not finite.
    #[error("the rate of false alarms must be between 0 and 1, and noise and resolution not negative")]
    BadParameter,
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
            successive: SVector::zeros(),
            last: SVector::zeros(),
            least: SVector::repeat(T::GREATEST),
            greatest: SVector::repeat(-T::GREATEST),
            resolution: SVector::zeros(),
            known_noise: None,
            rejected: 0,
            false_alarm_rate,
        })
    }

    /// The same for a converter whose readings come in steps: motion and outliers below a step are
    /// not motion. Needed where the noise is smaller than a step.
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
        let before = *self.moments.mean();
        let samples = self.moments.samples();
        if !self.moments.add(raw) {
            self.rejected = self.rejected.saturating_add(1);
            return false;
        }
        // Welford's recurrence for the product with the number of the reading.
        let time = T::literal((f64::from(samples) + 1.0) * 0.5);
        self.with_time += (raw - before) * time * (T::literal(f64::from(samples)) / self.count());
        let change = if samples == 0 { SVector::zeros() } else { raw - self.last };
        self.successive += change.component_mul(&change);
        self.last = *raw;
        self.least = self.least.inf(raw);
        self.greatest = self.greatest.sup(raw);
        true
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
        let (Ok(noise), true) = (self.moments.noise(), samples >= Self::LEAST_SAMPLES) else {
            return Err(too_few);
        };
        let limits = Limits::new(f64::from(samples), self.false_alarm_rate / (3 * N) as f64);
        for gauge in 0..N {
            self.judge(gauge, noise[gauge], &limits)?;
        }
        let tare = self.moments.finish().map_err(|_| too_few)?;
        Ok(Rested { tare, noise, tare_noise: noise / self.count().root(), samples })
    }

    fn judge(&self, gauge: usize, noise: T, limits: &Limits) -> Result<(), NotAtRest> {
        let n = self.count().to_f64();
        // A step of the converter counts as noise: it hides as much.
        let step = self.resolution[gauge].to_f64();
        let measured = noise.to_f64();
        let spread = nalgebra::ComplexField::sqrt(measured * measured + step * step / 12.0);
        if !(spread > 0.0) {
            // Not one reading differs from another.
            return Ok(());
        }
        // Slope of the line times the number of readings, over what noise makes of it; Σ(i−ī)² is
        // n(n²−1)/12.
        let times = n * (n * n - 1.0) / 12.0;
        let slope = self.with_time[gauge].to_f64() / times;
        let about_line = (n - 1.0) * spread * spread - slope * slope * times;
        let line_noise = nalgebra::ComplexField::sqrt((about_line / (n - 2.0)).max(0.0));
        let slope_noise = line_noise / nalgebra::ComplexField::sqrt(times);
        let moved = slope.abs() * (n - 1.0);
        if slope.abs() > limits.slope * slope_noise && moved > step {
            return Err(NotAtRest::Drifts { gauge, over_noise: moved / spread });
        }
        let ratio = self.successive[gauge].to_f64() / ((n - 1.0) * spread * spread);
        let too_wide = self.known_noise.is_some_and(|known| {
            let known = known[gauge].to_f64();
            spread * spread > limits.variance * (known * known + step * step / 12.0)
        });
        if too_wide || (ratio < limits.successive && measured > step) {
            return Err(NotAtRest::Unsteady { gauge });
        }
        let mean = self.moments.mean()[gauge];
        let farthest = (self.greatest[gauge] - mean).max(mean - self.least[gauge]).to_f64();
        if farthest > limits.outlier * spread && farthest > 1.5 * step {
            return Err(NotAtRest::Outlier { gauge, over_noise: farthest / spread });
        }
        Ok(())
    }
}

/// The thresholds for a number of readings.
struct Limits {
    /// Of the slope over its standard error.
    slope: f64,
    /// Of the mean square of successive differences over the variance; 2 for independent readings.
    successive: f64,
    /// Of the variance over the known one.
    variance: f64,
    /// Of the distance from the mean over the standard deviation.
    outlier: f64,
}

impl Limits {
    fn new(n: f64, tail: f64) -> Self {
        use nalgebra::ComplexField;
        let slope = student_quantile(tail / 2.0, n - 2.0);
        // von Neumann's ratio is 2 on average, with variance 4(n−2)/(n²−1); only its lower tail is
        // of interest, half of the share of this test.
        let z = normal_quantile(tail / 2.0);
        let successive = 2.0 * (1.0 - z * ComplexField::sqrt((n - 2.0) / (n * n - 1.0)));
        // χ² by Wilson & Hilferty's cube, the other half.
        let ninth = 2.0 / (9.0 * (n - 1.0));
        let root = 1.0 - ninth + z * ComplexField::sqrt(ninth);
        let variance = root * root * root;
        // Grubbs: (n−1)/√n · √(t²/(n−2+t²)), t at tail/2n.
        let t = student_quantile(tail / (2.0 * n), n - 2.0);
        let outlier = (n - 1.0) / ComplexField::sqrt(n) * ComplexField::sqrt(t * t / (n - 2.0 + t * t));
        Self { slope, successive, variance, outlier }
    }
}
