//! The drop of the friction ratio in noise of any kind.

use fingertip_wrench::{ContactForce, Real, stored};

use super::block_maxima::BlockMaxima;
use super::change_test::ChangeTest;
use super::followed_lines::State;
use super::predictor::Predictor;
use super::ratio_tracker::{RatioTracker, taken_rate};
use super::run_length::run_length_for;
use crate::{BadParameter, ForceNoise, SlipDetector, SlipVerdict};

/// Allowance of the cumulative sums.
const ALLOWANCE: f64 = 0.75;
/// What is allowed beside for each deviation by which the ratio's innovation differs from the force's, as it does where the
/// normal force changes at once: what is foretold of the ratio, which the hum has moved, is then off in proportion
/// (`docs/theory/friction.md#noise-that-is-not-white`).
const DOUBT: f64 = 1.0 / 16.0;
/// Samples after a start that give no evidence, beside the eight of the tracker: until its lines run evenly, which takes 25,
/// and the predictors have seen nothing but such, which takes as many as foretell.
const SETTLING: u8 = 64;

/// Finds the fall of the friction ratio like [`DropDetector`](crate::DropDetector), and holds the rate of false alarms
/// that was asked for in noise that is stronger than stated, correlated, humming, or made of coarse steps.
///
/// Two things are learnt while nothing slips (`docs/theory/friction.md#noise-that-is-not-white`):
/// - What the innovations of ratio and force still foretell of each other, by an adaptive predictor of order 32
///   each. It takes a hum and a correlation out, and what is left is counted in its own deviations. The stated noise
///   sets the scale where the true one is a quarter of it or less.
/// - How high a cumulative sum climbs without slip: the law of its greatest value in 256 samples gives the threshold
///   that it passes as seldom as was asked. It is that of *rises* of the ratio, which noise makes as it makes falls,
///   and slip does not; so no slip teaches the detector to be silent.
///
/// # What it costs
/// - It says nothing in the first 768 samples of its life, nor after a [`reset`](SlipDetector::reset), and nothing
///   in the first 72 after contact, a gap or an alarm (at more than 2 kHz, samples are those of half a millisecond
///   each): of slips that come again, at 1 kHz up to 13 a second are each found. What it has learnt of the noise it
///   keeps over lift-offs and gaps.
/// - In white noise as stated it finds 99 % of the drops by five deviations of the ratio, as `DropDetector` does, in
///   noise of three times that 29 % of those by five and all by ten. In a hum of ten deviations at 50 Hz, or at 60 with strong
///   harmonics, sampled at 1 kHz, it finds 36 and 40 % of the drops by five and all of those by ten. The `slip_report` has
///   all of it, and what a rarer false alarm costs.
/// - Two predictions of order 32 for each sample taken, and some 140 numbers more than a `DropDetector`.
///
/// # How well it keeps to what was asked
/// Asked for one false alarm a minute, over ten million samples each at 0.2 to 10 kHz, it gives 0.5 to 1 in most noises, and
/// in none more than two, in a hold and on touches of a second that are let go in two samples. Of twenty that are
/// asked for it gives seven, since it does not listen in the 72 samples after each. It gives a tenth or less in a hum of ten
/// deviations that does not stop, and on touches at 200 Hz: these last 40 to 440 samples, so that much of what it learns is
/// how they begin and end.
///
/// # What it can't tell
/// A noise that begins: for some hundred samples its alarms are not those asked for. A disturbance that only ever
/// *lowers* the ratio suddenly, without being slip, is not learnt. And a stick-slip with great drops that goes on from the
/// first sample of its life may be taken for noise: the line rebounds after a drop that was not called. Let it feel a
/// second of hold first. Where a converter's steps are several times the noise, slips that follow each other within a tenth
/// of a second are taken for these steps: a fourth to a half of them is found.
///
/// ```
/// use fingertip_friction::{AdaptiveDropDetector, ForceNoise, SlipDetector, SlipVerdict};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let mut detector = AdaptiveDropDetector::new(ForceNoise::isotropic(0.01)?, 1.0, 1000.0)?;
/// let force = ContactForce::new(2.0, Vector3::new(0.9, 0.0, 0.0), 0.0);
/// // It learns the noise first.
/// assert_ne!(detector.update(&force, 1e-3), SlipVerdict::Slipping);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveDropDetector<T> {
    tracker: RatioTracker<T>,
    test: LearntTest<T>,
    run_length: f64,
}

/// Cumulative sums of what predictors leave, against a threshold that is learnt.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LearntTest<T> {
    of_ratio: Predictor<T>,
    of_force: Predictor<T>,
    /// Samples since the start, up to `SETTLING`.
    settled: u8,
    fall: T,
    rise: T,
    maxima: BlockMaxima<T>,
}

impl<T: Real> AdaptiveDropDetector<T> {
    /// From the noise of the contact force, a wanted rate of false alarms per minute, and the sample rate \[Hz\].
    ///
    /// # Errors
    /// [`BadParameter`] unless both deviations, and their squares, are positive and finite, and the rates too; and
    /// unless at least 1024 samples (of half a millisecond each above 2 kHz) pass between two false alarms.
    pub fn new(
        noise: ForceNoise<T>,
        false_alarms_per_minute: f64,
        sample_rate: f64,
    ) -> Result<Self, BadParameter> {
        let run_length = run_length_for(false_alarms_per_minute, taken_rate(sample_rate));
        Self::with_run_length(noise, run_length)
    }

    /// From the mean number of samples between false alarms; above 2 kHz, of means over half a millisecond.
    ///
    /// # Errors
    /// [`BadParameter`] unless both deviations, and their squares, are positive and finite, and the run length at least
    /// 1024 and finite.
    pub fn with_run_length(noise: ForceNoise<T>, run_length: f64) -> Result<Self, BadParameter> {
        let test = LearntTest {
            of_ratio: Predictor::new(),
            of_force: Predictor::new(),
            settled: 0,
            fall: T::zero(),
            rise: T::zero(),
            maxima: BlockMaxima::new(run_length)?,
        };
        Ok(Self { tracker: RatioTracker::new(noise)?, test, run_length })
    }

    /// The friction ratio as followed so far; `None` without contact.
    #[inline]
    #[must_use]
    pub fn ratio(&self) -> Option<T> {
        self.tracker.ratio()
    }

    /// The threshold of the cumulative sum, in deviations of what can't be foretold; `None` while too little is
    /// known of the noise, and nothing is called slip.
    #[must_use]
    pub fn threshold(&self) -> Option<T> {
        self.test.maxima.is_known().then_some(self.test.maxima.threshold())
    }
}

impl<T: Real> ChangeTest<T> for LearntTest<T> {
    type Evidence = Option<(T, T)>;
    const NOTHING: fn() -> Option<(T, T)> = || None;

    #[inline(always)]
    fn evidence(_: &mut State<T>, innovations: &(T, T)) -> Option<(T, T)> {
        Some(*innovations)
    }

    #[inline]
    fn take(&mut self, innovations: Option<(T, T)>) -> bool {
        let Some((of_ratio, of_force)) = innovations else { return false };
        let Some((of_ratio, of_force)) = self.of_ratio.take(of_ratio).zip(self.of_force.take(of_force))
        else {
            return false;
        };
        if self.settled < SETTLING {
            self.settled += 1;
            return false;
        }
        let allowance = T::literal(ALLOWANCE) + T::literal(DOUBT) * (of_ratio - of_force).abs();
        self.fall = (self.fall - of_ratio.max(of_force) - allowance).max(T::zero());
        self.rise = (self.rise + of_ratio.min(of_force) - allowance).max(T::zero());
        if self.fall > self.maxima.threshold() {
            return true;
        }
        self.maxima.see(self.rise);
        self.maxima.count();
        false
    }

    fn restart(&mut self) {
        self.of_ratio.restart();
        self.of_force.restart();
        self.settled = 0;
        (self.fall, self.rise) = (T::zero(), T::zero());
    }
}

impl<T: Real> SlipDetector<T> for AdaptiveDropDetector<T> {
    #[inline]
    fn update(&mut self, force: &ContactForce<T>, time_step: T) -> SlipVerdict {
        self.tracker.update(&mut self.test, force, time_step)
    }

    #[inline]
    fn update_open(&mut self, time_step: T) -> SlipVerdict {
        self.tracker.update_open(&mut self.test, time_step)
    }

    /// Forgets the noise, too.
    fn reset(&mut self) {
        self.tracker.reset();
        self.test.restart();
        (self.test.of_ratio, self.test.of_force) = (Predictor::new(), Predictor::new());
        self.test.maxima.reset();
    }
}

stored! {
    AdaptiveDropDetector<T>, [T: Real],
    |detector| { noise: ForceNoise<T> = detector.tracker.noise(), run_length: f64 = detector.run_length },
    Self::with_run_length(noise, run_length)
}
