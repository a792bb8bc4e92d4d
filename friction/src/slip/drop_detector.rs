//! The paper's second mode: slip seen in the sudden drop of the friction ratio.

use fingertip_wrench::{ContactForce, Real, stored};

use super::ratio_tracker::RatioTracker;
use crate::{BadParameter, Cusum, ForceNoise, SlipDetector, SlipVerdict};

/// Finds the fall of the friction ratio from its static peak to its kinetic level, without knowing
/// either.
///
/// An α-β tracker (α = 0.15) follows the ratio, and another the tangential force; a one-sided
/// cumulative sum ([`Cusum`], Page 1954; `docs/theory/friction.md#cumulative-sum`) of the standardised fall
/// below the forecast rises when the ratio falls faster than the tracker foretells, and calls slip when it
/// passes the threshold. Each drop gives one [`SlipVerdict::Slipping`]; the detector then starts anew, so
/// that the next drop of a stick-slip motion is found too.
///
/// # What it bears
/// - Steps of the normal force, up or down: the ratio moves without the tangential force, or the
///   other way round; only a fall of both counts.
/// - Drift: the tracker follows a line without lag.
/// - Sample rates above 2 kHz: samples are averaged over half a millisecond.
/// - Irregular time steps, and dropped samples up to 16 sample times; after a longer gap it starts
///   anew.
/// - Samples that repeat the one before (a sensor slower than the loop): no evidence is counted
///   twice. A time step that is not positive is taken as the same sample again.
/// - Converters of 12 bits and more.
///
/// It gives no evidence in the first 8 samples after contact, after a gap, or after an alarm, and none of a contact
/// counts in the next.
///
/// # What it does not bear
/// Noise above the stated, or not white. It learns the size of the noise anew in each contact: white noise of three
/// times the stated gives 0.4 false alarms a minute in a hold at 1 kHz, of five times 1, at 10 kHz 2 and 6, but on
/// touches of a second 34 and 106. Noise whose neighbouring samples are correlated by 0.5 gives 3 a minute at 1 kHz, by
/// 0.9 12, and 70 at 10 kHz; a hum of two stated deviations at 60 Hz 0.4 and 84, of ten at 50 Hz 5 and one a cycle,
/// and on touches hundreds. [`AdaptiveDropDetector`](crate::AdaptiveDropDetector) holds what was asked in all of these.
///
/// # What it can't tell
/// - A load that is taken off, or a drag that turns around, while the normal force stays: from the
///   force alone it looks like slip, be it in a few samples or, where it sets in at once and falls by
///   a deviation of the noise or so per sample, in some hundred milliseconds. Where the motion is
///   known, [`IncipientSlip`](crate::IncipientSlip) is not deceived.
/// - A faint drop, because the tracker follows it: all of those by five deviations of the ratio
///   ([`ForceNoise::ratio_deviation`]) and 94 % of those by four are found, but 40 % of those by
///   three and 2 % of those by two. A friction ratio falling from 0.5 to 0.4 is five deviations at
///   56 times the noise in normal force, so press harder or average the sensor. A longer window
///   does not help: by the tenth sample the tracker's forecast has come down too.
///
/// ```
/// use fingertip_friction::{DropDetector, ForceNoise, SlipDetector, SlipVerdict};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let mut detector = DropDetector::new(ForceNoise::isotropic(0.01)?)?;
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
pub struct DropDetector<T> {
    tracker: RatioTracker<T>,
    sum: Cusum<T>,
}

impl<T: Real> DropDetector<T> {
    /// From the noise of the contact force, with allowance 0.75 and threshold 7. With these, white
    /// noise of the stated size gives less than one false alarm in ten minutes at 1 kHz, and a
    /// drop of five deviations of the ratio is found within about two samples
    /// (`docs/theory/friction.md#drop-of-the-ratio`).
    ///
    /// # Errors
    /// [`BadParameter`] unless both deviations, and their squares, are positive and finite.
    pub fn new(noise: ForceNoise<T>) -> Result<Self, BadParameter> {
        Self::with_sum(noise, Cusum::drop_default())
    }

    /// With another cumulative sum, as from [`Cusum::for_false_alarms`].
    ///
    /// # Errors
    /// [`BadParameter`] unless both deviations, and their squares, are positive and finite.
    pub fn with_sum(noise: ForceNoise<T>, sum: Cusum<T>) -> Result<Self, BadParameter> {
        Ok(Self { tracker: RatioTracker::new(noise)?, sum })
    }

    /// The friction ratio as followed so far; `None` without contact.
    #[inline]
    #[must_use]
    pub fn ratio(&self) -> Option<T> {
        self.tracker.ratio()
    }
}

impl<T: Real> SlipDetector<T> for DropDetector<T> {
    #[inline]
    fn update(&mut self, force: &ContactForce<T>, time_step: T) -> SlipVerdict {
        self.tracker.update(&mut self.sum, force, time_step)
    }

    #[inline]
    fn update_open(&mut self, time_step: T) -> SlipVerdict {
        self.tracker.update_open(&mut self.sum, time_step)
    }

    fn reset(&mut self) {
        self.tracker.reset();
        self.sum.reset();
    }
}

stored! {
    DropDetector<T>, [T: Real],
    |detector| { noise: ForceNoise<T> = detector.tracker.noise(), sum: Cusum<T> = detector.sum },
    Self::with_sum(noise, sum)
}

#[cfg(test)]
#[path = "drop_detector_tests.rs"]
mod tests;
