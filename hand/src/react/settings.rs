//! The habits of a gripping hand.

use fingertip_wrench::Real;
use thiserror::Error;

/// Limits and habits of a hand; [`HandController::new`](crate::HandController::new) validates them.
///
/// Where nothing is known of the hand there is a default for each: presses by 1.3 times what friction needs, which is what
/// people do (Johansson & Westling 1984), rises by 200 N/s and falls by 2 N/s, takes friction as 0.8 times as large at each
/// slip and never below 0.1, without recovery, and believes no contact beyond a friction ratio of 3.
///
/// ```
/// use fingertip_hand::HandSettings;
///
/// let careful = HandSettings::<f32> { safety: 2.0, ..HandSettings::default() };
/// assert_eq!((careful.safety, careful.fall), (2.0, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HandSettings<T> {
    /// Factor of safety on friction, at least 1.
    pub safety: T,
    /// How fast a normal force may rise \[N/s\].
    pub rise: T,
    /// How fast it may fall \[N/s\]; slower than the rise, so that a grip is not lost to noise.
    pub fall: T,
    /// By what a finger's friction coefficient is multiplied when it slips, between 0 and 1.
    pub at_slip: T,
    /// Below what friction coefficient it is never taken, however often it slips.
    pub least_friction: T,
    /// The greatest friction ratio that a contact can have: a contact that asks for more is implausible, and its
    /// force is not used.
    pub greatest_ratio: T,
    /// With what rate the factor that slips have taught goes back to one \[1/s\]; zero for never. A grip that loosens again
    /// may slip again.
    pub recovery: T,
}

impl<T: Real> Default for HandSettings<T> {
    fn default() -> Self {
        Self {
            safety: T::literal(1.3),
            rise: T::literal(200.0),
            fall: T::literal(2.0),
            at_slip: T::literal(0.8),
            least_friction: T::literal(0.1),
            greatest_ratio: T::literal(3.0),
            recovery: T::zero(),
        }
    }
}

/// Why settings are none.
///
/// ```
/// use fingertip_hand::{HandController, HandSettings, FingerLimits};
///
/// let settings = HandSettings { safety: 0.5, ..HandSettings::default() };
/// let error = HandController::new(settings, [FingerLimits::<f64, 1>::none(); 2]).unwrap_err();
/// assert_eq!(error.to_string(), "the factor of safety must be at least 1 and finite");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the {parameter} must be {requirement}")]
pub struct BadHandSettings {
    /// Which number.
    pub parameter: &'static str,
    /// What it must be.
    pub requirement: &'static str,
}

impl<T: Real> HandSettings<T> {
    /// The settings if they are some.
    pub(crate) fn checked(self) -> Result<Self, BadHandSettings> {
        let check = |good: bool, parameter, requirement| {
            if good { Ok(()) } else { Err(BadHandSettings { parameter, requirement }) }
        };
        let positive = |x: T| x > T::zero() && x.is_number();
        let one = T::one();
        check(self.safety >= one && self.safety.is_number(), "factor of safety", "at least 1 and finite")?;
        check(positive(self.rise), "rate of rise", "positive and finite")?;
        check(positive(self.fall), "rate of fall", "positive and finite")?;
        check(positive(self.at_slip) && self.at_slip < one, "factor at slip", "between 0 and 1")?;
        check(positive(self.least_friction), "least friction coefficient", "positive and finite")?;
        check(positive(self.greatest_ratio), "greatest friction ratio", "positive and finite")?;
        let recovers = self.recovery >= T::zero() && self.recovery.is_number();
        check(recovers, "rate of recovery", "finite and not negative")?;
        Ok(self)
    }
}
