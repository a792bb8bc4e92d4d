//! Page's cumulative sum.

use fingertip_wrench::{Real, stored};

use super::change_test::{ChangeTest, test_of_falls};
use super::followed_lines::State;
use crate::BadParameter;
use crate::bad_parameter::{not_negative, positive};

/// A one-sided cumulative sum `S ← max(0, S + x − k)` that passes at `S > h` (Page 1954). The
/// Page-Hinkley test is the same statistic.
///
/// The inputs are standardised: zero mean and unit variance as long as nothing happens. The
/// allowance `k` is half the smallest change of the mean worth finding; the threshold `h` sets the
/// rate of false alarms ([`for_false_alarms`](Self::for_false_alarms),
/// `docs/theory/friction.md#cumulative-sum`).
///
/// ```
/// use fingertip_friction::Cusum;
///
/// let mut sum = Cusum::new(0.5, 5.0)?; // what a sample may be without counting, and where it alarms
/// assert!((0..100).all(|_| !sum.add(0.4_f64)));
/// assert!((0..10).any(|_| sum.add(1.5)));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cusum<T> {
    allowance: T,
    threshold: T,
    sum: T,
}

impl<T: Real> Cusum<T> {
    /// From the allowance and the threshold, both in standard deviations.
    ///
    /// # Errors
    /// [`BadParameter`] unless the allowance is finite and not negative and the threshold positive
    /// and finite.
    pub fn new(allowance: T, threshold: T) -> Result<Self, BadParameter> {
        let allowance = not_negative(allowance, "allowance")?;
        Ok(Self { allowance, threshold: positive(threshold, "threshold")?, sum: T::zero() })
    }

    /// With the threshold for a wanted rate of false alarms, were the samples independent
    /// (`run_length::cusum_threshold`: good to 0.7 % or better, from a table, so that it needs no standard
    /// library).
    ///
    /// # Errors
    /// [`BadParameter`] unless the allowance is from 0.125 to 1.5 and the rates positive, finite and
    /// not too wild for it.
    pub fn for_false_alarms(
        allowance: T,
        false_alarms_per_minute: f64,
        sample_rate: f64,
    ) -> Result<Self, BadParameter> {
        let length = crate::slip::run_length::run_length_for(false_alarms_per_minute, sample_rate);
        let threshold = crate::slip::run_length::cusum_threshold(allowance.to_f64(), length)?;
        Self::new(allowance, T::literal(threshold))
    }

    /// Allowance 0.75, threshold 7.
    pub(crate) fn drop_default() -> Self {
        Self { allowance: T::literal(0.75), threshold: T::literal(7.0), sum: T::zero() }
    }

    /// Takes one standardised sample and tells whether the sum is above the threshold. A NaN is
    /// ignored.
    #[inline]
    pub fn add(&mut self, sample: T) -> bool {
        // False for a NaN alone.
        if sample.abs() >= T::zero() {
            // Choices between values, not branches: the sum is above zero in no foreseeable way.
            // In this order, the sum of before is waited for last.
            let sum = self.sum + (sample - self.allowance);
            let sum = if sum > T::zero() { sum } else { T::zero() };
            // Twice the threshold bounds it, so that it comes down again from an infinite sample.
            let greatest = self.threshold + self.threshold;
            self.sum = if sum < greatest { sum } else { greatest };
        }
        self.sum > self.threshold
    }

    /// The sum as it stands.
    #[inline]
    #[must_use]
    pub const fn sum(&self) -> T {
        self.sum
    }

    /// The allowance k.
    #[inline]
    #[must_use]
    pub const fn allowance(&self) -> T {
        self.allowance
    }

    /// The threshold h.
    #[inline]
    #[must_use]
    pub const fn threshold(&self) -> T {
        self.threshold
    }

    /// Sets the sum to zero.
    #[inline]
    pub fn reset(&mut self) {
        self.sum = T::zero();
    }
}

test_of_falls! { Cusum<T>, [T: Real] }

stored! {
    Cusum<T>, [T: Real],
    |sum| { allowance: T = sum.allowance, threshold: T = sum.threshold },
    Self::new(allowance, threshold)
}
