//! The generalised likelihood ratio over a sliding window.

use fingertip_wrench::{ContactForce, Real, stored};

use super::change_test::{ChangeTest, test_of_falls};
use super::followed_lines::State;
use super::ratio_tracker::RatioTracker;
use crate::slip::run_length::{likelihood_ratio_threshold, run_length_for};
use crate::{BadParameter, ForceNoise, SlipDetector, SlipVerdict};

/// `max_j S_j²/(2j) > threshold` over the sums `S_j > 0` of the last `j ≤ W` standardised samples:
/// it needs no guess of the size of the change, as the cumulative sum does.
///
/// # Cost
/// The sums are taken anew from the samples, so that no rounding adds up: W additions. But hardly
/// any update needs them. The line through the first and the last point of the bound `√(2j·threshold)`
/// lies below all of it, the root being concave; so a sum that passes the bound has passed the line,
/// and then so has Page's cumulative sum with the line's slope as allowance, which costs one
/// addition. Only while that is above the line's intercept are the sums looked at.
///
/// ```
/// use fingertip_friction::LikelihoodRatio;
///
/// let mut test = LikelihoodRatio::<f64, 16>::new(10.0)?; // the threshold, over the last 16 samples
/// assert!((0..100).all(|_| !test.add(0.0)));
/// assert!((0..16).any(|_| test.add(3.0)));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LikelihoodRatio<T, const W: usize> {
    /// The last samples, newest at `next − 1`.
    samples: [T; W],
    next: usize,
    filled: usize,
    window: usize,
    threshold: T,
    /// Slope and intercept of the line below the bound on the sums, and the cumulative sum.
    slope: T,
    intercept: T,
    screen: T,
}

impl<T: Real, const W: usize> LikelihoodRatio<T, W> {
    /// With a threshold and the full window.
    ///
    /// # Errors
    /// [`BadParameter`] unless W is at least 2 and the threshold positive and finite.
    pub fn new(threshold: T) -> Result<Self, BadParameter> {
        Self::with_window(W, threshold)
    }

    /// With a window shorter than the room for it.
    ///
    /// # Errors
    /// [`BadParameter`] unless the window is from 2 to W and the threshold positive and finite.
    pub fn with_window(window: usize, threshold: T) -> Result<Self, BadParameter> {
        if !(2..=W).contains(&window) {
            return Err(BadParameter { parameter: "window", requirement: "at least 2, and within its room" });
        }
        if !(threshold > T::zero() && threshold.is_number()) {
            return Err(BadParameter { parameter: "threshold", requirement: "positive and finite" });
        }
        let first = (threshold + threshold).root();
        let last = first * T::literal(window as f64).root();
        let steps = T::literal(window as f64 - 1.0);
        let slope = (last - first) / steps;
        // Lowered by far more than what the rounding of sums of that size comes to.
        let intercept = (first - slope) - last * (T::EPSILON * T::literal(window as f64)).root();
        let samples = [T::zero(); W];
        Ok(Self { samples, next: 0, filled: 0, window, threshold, slope, intercept, screen: T::zero() })
    }

    /// Takes one standardised sample and tells whether the ratio is above the threshold. A NaN is
    /// ignored.
    #[inline]
    pub fn add(&mut self, sample: T) -> bool {
        if !sample.is_number() {
            return false;
        }
        if let Some(place) = self.samples.get_mut(self.next) {
            *place = sample;
        }
        self.next = if self.next + 1 >= self.window { 0 } else { self.next + 1 };
        self.filled = (self.filled + 1).min(self.window);
        let screen = self.screen + sample - self.slope;
        self.screen = (if screen > T::zero() { screen } else { T::zero() }).min(T::GREATEST);
        self.screen > self.intercept && self.any_sum_passes()
    }

    #[inline(never)]
    fn any_sum_passes(&self) -> bool {
        // Always in range; but a compiler cannot know, and would keep a panic ready.
        let newer = self.samples.get(..self.next).unwrap_or(&[]);
        let older = self.samples.get(self.next..self.window).unwrap_or(&[]);
        let twice = self.threshold + self.threshold;
        let (mut sum, mut bound) = (T::zero(), T::zero());
        for x in newer.iter().rev().chain(older.iter().rev()).take(self.filled) {
            sum += *x;
            bound += twice;
            if sum > T::zero() && sum * sum > bound {
                return true;
            }
        }
        false
    }

    /// Forgets all samples.
    #[inline]
    pub fn reset(&mut self) {
        self.filled = 0;
        self.next = 0;
        self.screen = T::zero();
    }
}

test_of_falls! { LikelihoodRatio<T, W>, [T: Real, const W: usize] }

/// Finds slip as a fall of the friction ratio of unknown size: [`LikelihoodRatio`] on the same
/// evidence as [`DropDetector`](crate::DropDetector), with the same start, and as little proof against noise that is not
/// white, or stronger than stated: its rate of false alarms is that of white noise of the stated size.
///
/// ```
/// use fingertip_friction::{ForceNoise, LikelihoodRatioDetector, SlipDetector, SlipVerdict};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// // One false alarm a minute, at 1 kHz.
/// let mut detector = LikelihoodRatioDetector::<f64, 16>::new(ForceNoise::isotropic(0.01)?, 1.0, 1000.0)?;
/// let pull = |sideways| ContactForce::new(2.0, Vector3::new(sideways, 0.0, 0.0), 0.0);
/// let mut verdict = SlipVerdict::Holding;
/// // The ratio rises to one half, and falls: it slips.
/// for sample in 0..120 {
///     let sideways = if sample < 100 { 0.01 * f64::from(sample) } else { 0.8 };
///     if verdict != SlipVerdict::Slipping {
///         verdict = detector.update(&pull(sideways), 1e-3);
///     }
/// }
/// assert_eq!(verdict, SlipVerdict::Slipping);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LikelihoodRatioDetector<T, const W: usize> {
    tracker: RatioTracker<T>,
    ratio: LikelihoodRatio<T, W>,
}

impl<T: Real, const W: usize> LikelihoodRatioDetector<T, W> {
    /// From the noise of the contact force, a wanted rate of false alarms per minute, and the
    /// sample rate \[Hz\].
    ///
    /// # Errors
    /// [`BadParameter`] unless noise, rates and window are usable.
    pub fn new(
        noise: ForceNoise<T>,
        false_alarms_per_minute: f64,
        sample_rate: f64,
    ) -> Result<Self, BadParameter> {
        let length = run_length_for(false_alarms_per_minute, sample_rate);
        let threshold = T::literal(likelihood_ratio_threshold(W, length)?);
        Self::with_ratio(noise, LikelihoodRatio::new(threshold)?)
    }

    /// With another likelihood ratio.
    ///
    /// # Errors
    /// [`BadParameter`] unless both deviations, and their squares, are positive and finite.
    pub fn with_ratio(noise: ForceNoise<T>, ratio: LikelihoodRatio<T, W>) -> Result<Self, BadParameter> {
        Ok(Self { tracker: RatioTracker::new(noise)?, ratio })
    }
}

impl<T: Real, const W: usize> SlipDetector<T> for LikelihoodRatioDetector<T, W> {
    #[inline]
    fn update(&mut self, force: &ContactForce<T>, time_step: T) -> SlipVerdict {
        self.tracker.update(&mut self.ratio, force, time_step)
    }

    #[inline]
    fn update_open(&mut self, time_step: T) -> SlipVerdict {
        self.tracker.update_open(&mut self.ratio, time_step)
    }

    fn reset(&mut self) {
        self.tracker.reset();
        self.ratio.reset();
    }
}

stored! {
    LikelihoodRatio<T, W>, [T: Real, const W: usize],
    |ratio| { window: usize = ratio.window, threshold: T = ratio.threshold },
    Self::with_window(window, threshold)
}

stored! {
    LikelihoodRatioDetector<T, W>, [T: Real, const W: usize],
    |detector| {
        noise: ForceNoise<T> = detector.tracker.noise(),
        window: usize = detector.ratio.window,
        threshold: T = detector.ratio.threshold,
    },
    LikelihoodRatio::with_window(window, threshold).and_then(|ratio| Self::with_ratio(noise, ratio))
}
