//! Stick-slip: slip that comes back at even times.

use fingertip_wrench::{ContactForce, Real, stored};

use crate::{DropDetector, SlipDetector, SlipVerdict};

/// A periodic stick-slip motion.
///
/// ```
/// use fingertip_friction::{DropDetector, ForceNoise, SlipDetector, StickSlip, StickSlipDetector};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let mut detector = StickSlipDetector::new(DropDetector::new(ForceNoise::isotropic(0.01)?)?);
/// for sample in 0..500 {
///     // A saw: the ratio rises for 50 ms, and falls.
///     let ratio = 0.4 + 0.004 * f64::from(sample % 50);
///     detector.update(&ContactForce::new(2.0, Vector3::x() * (2.0 * ratio), 0.0), 1e-3);
/// }
/// let Some(StickSlip { period, spread }) = detector.motion() else { panic!("it sticks and slips") };
/// assert!((period - 0.05_f64).abs() < 1e-3 && spread < 0.2);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StickSlip<T> {
    /// Mean time between drops \[s\].
    pub period: T,
    /// Greatest less least of the last three periods, over their mean.
    pub spread: T,
}

/// Watches the drops of a [`DropDetector`] and calls them stick-slip when three periods in a row
/// differ by less than 20 % of their mean.
///
/// ```
/// use fingertip_friction::{DropDetector, ForceNoise, SlipDetector, StickSlipDetector};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let mut detector = StickSlipDetector::new(DropDetector::new(ForceNoise::isotropic(0.01)?)?);
/// for sample in 0..500 {
///     // A saw: the ratio rises for 50 ms, and falls.
///     let ratio = 0.4 + 0.004 * f64::from(sample % 50);
///     detector.update(&ContactForce::new(2.0, Vector3::x() * (2.0 * ratio), 0.0), 1e-3);
/// }
/// assert!(detector.motion().is_some_and(|motion| (motion.period - 0.05).abs() < 1e-3));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StickSlipDetector<T> {
    drops: DropDetector<T>,
    /// Time since the last drop, or since the contact closed \[s\].
    since: T,
    periods: [T; 3],
    /// Drops in a row, at most four: one more than the periods known.
    drops_seen: u8,
}

impl<T: Real> StickSlipDetector<T> {
    /// From a detector of single drops.
    #[must_use]
    pub fn new(drops: DropDetector<T>) -> Self {
        Self { drops, since: T::zero(), periods: [T::zero(); 3], drops_seen: 0 }
    }

    /// The stick-slip motion now going on, if any: it ends when no drop has come for one and a
    /// half periods.
    #[must_use]
    pub fn motion(&self) -> Option<StickSlip<T>> {
        if self.drops_seen < 4 {
            return None;
        }
        let [a, b, c] = self.periods;
        let period = (a + b + c) / T::literal(3.0);
        let spread = (a.max(b).max(c) - a.min(b).min(c)) / period;
        let going_on = self.since < period * T::literal(1.5);
        (going_on && spread < T::literal(0.2)).then_some(StickSlip { period, spread })
    }
}

impl<T: Real> SlipDetector<T> for StickSlipDetector<T> {
    #[inline]
    fn update(&mut self, force: &ContactForce<T>, time_step: T) -> SlipVerdict {
        self.pass(time_step);
        let verdict = self.drops.update(force, time_step);
        if verdict != SlipVerdict::Holding {
            self.take(verdict, force.is_finite() && time_step.is_number());
        }
        verdict
    }

    #[inline]
    fn update_open(&mut self, time_step: T) -> SlipVerdict {
        self.pass(time_step);
        let verdict = self.drops.update_open(time_step);
        self.take(verdict, time_step.is_number());
        verdict
    }

    fn reset(&mut self) {
        self.drops.reset();
        self.forget();
    }
}

impl<T: Real> StickSlipDetector<T> {
    /// Adds to the time; a step that is not positive and finite adds nothing.
    #[inline]
    fn pass(&mut self, time_step: T) {
        if time_step > T::zero() && time_step.is_number() {
            self.since += time_step;
        }
    }

    /// A drop, or a sample without contact if it is `sound`.
    #[cold]
    fn take(&mut self, verdict: SlipVerdict, sound: bool) {
        if verdict == SlipVerdict::Slipping {
            self.periods = [self.periods[1], self.periods[2], self.since];
            self.drops_seen = (self.drops_seen + 1).min(4);
            self.since = T::zero();
        } else if verdict == SlipVerdict::NotPressing && sound {
            self.forget();
        }
    }

    fn forget(&mut self) {
        self.since = T::zero();
        self.drops_seen = 0;
    }
}

stored! {
    StickSlipDetector<T>, [T: Real],
    |detector| { drops: DropDetector<T> = detector.drops },
    Ok::<_, crate::BadParameter>(Self::new(drops))
}
