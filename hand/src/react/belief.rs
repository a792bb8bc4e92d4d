//! What the friction of a finger is taken to be, from sample to sample.

use fingertip_friction::{BadParameter, ForceNoise, FrictionEstimate, SlipVerdict, StaticFriction};
use fingertip_wrench::{ContactForce, Real};

use crate::HandSettings;

/// Which friction coefficient to rely on at a finger. [`HandController`](crate::HandController) has one for each.
///
/// ```
/// use fingertip_friction::SlipVerdict;
/// use fingertip_hand::{FrictionBelief, HandSettings, SlipFactor};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// /// How often a finger has slipped, by any belief.
/// struct Counted<B>(B, u32);
///
/// impl<B: FrictionBelief<f64>> FrictionBelief<f64> for Counted<B> {
///     fn rely(&mut self, known: f64, force: &ContactForce<f64>, slip: SlipVerdict, step: f64, habits: &HandSettings<f64>) -> f64 {
///         self.1 += u32::from(slip == SlipVerdict::Slipping);
///         self.0.rely(known, force, slip, step, habits)
///     }
///     fn forget(&mut self) {
///         self.0.forget();
///     }
/// }
///
/// let mut belief = Counted(SlipFactor::default(), 0);
/// let force = ContactForce::new(2.0, Vector3::x(), 0.0);
/// assert_eq!(belief.rely(0.5, &force, SlipVerdict::Slipping, 1e-3, &HandSettings::default()), 0.4);
/// assert_eq!(belief.1, 1);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` believes nothing about friction in `{T}`",
    note = "take `SlipFactor`, `LearntFriction` or `AnyBelief`, of the scalar of the hand"
)]
pub trait FrictionBelief<T: Real> {
    /// Takes a sample of a contact that is believed: what is known of the friction beforehand (a low quantile), force,
    /// verdict and the time since the last one \[s\], not negative. Returns the coefficient to rely on, positive.
    fn rely(
        &mut self,
        beforehand: T,
        force: &ContactForce<T>,
        slip: SlipVerdict,
        time_step: T,
        settings: &HandSettings<T>,
    ) -> T;

    /// Forgets the object.
    fn forget(&mut self);
}

/// Takes what is known beforehand, multiplied by [`at_slip`](HandSettings::at_slip) at each slip; the factor goes back to
/// one with the rate of [`recovery`](HandSettings::recovery).
///
/// ```
/// use fingertip_friction::SlipVerdict;
/// use fingertip_hand::{FrictionBelief, HandSettings, SlipFactor};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let (force, settings) = (ContactForce::new(2.0, Vector3::x(), 0.0), HandSettings::default());
/// let mut belief = SlipFactor::default();
/// let mut after = |slip| belief.rely(0.5, &force, slip, 1e-3, &settings);
/// assert_eq!(after(SlipVerdict::Holding), 0.5);
/// assert_eq!(after(SlipVerdict::Slipping), 0.4); // by a factor of 0.8
/// assert_eq!(after(SlipVerdict::Holding), 0.4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipFactor<T> {
    factor: T,
}

impl<T: Real> Default for SlipFactor<T> {
    fn default() -> Self {
        Self { factor: T::one() }
    }
}

impl<T: Real> FrictionBelief<T> for SlipFactor<T> {
    #[inline]
    fn rely(
        &mut self,
        beforehand: T,
        _force: &ContactForce<T>,
        slip: SlipVerdict,
        time_step: T,
        settings: &HandSettings<T>,
    ) -> T {
        if slip == SlipVerdict::Slipping {
            self.factor *= settings.at_slip;
        } else {
            self.factor += (T::one() - self.factor) * (settings.recovery * time_step).min(T::one());
        }
        let least = settings.least_friction.min(beforehand);
        let friction = (beforehand * self.factor).max(least);
        // What was learnt does not sink out of reach.
        self.factor = friction / beforehand;
        friction
    }

    fn forget(&mut self) {
        *self = Self::default();
    }
}

/// Either of the beliefs, chosen at run time.
///
/// ```
/// use fingertip_friction::ForceNoise;
/// use fingertip_hand::{AnyBelief, FingerLimits, HandController, HandSettings, LearntFriction};
///
/// let learns = LearntFriction::new(ForceNoise::isotropic(0.01)?, 0.05, 0.01)?;
/// let beliefs = [AnyBelief::Learnt(learns), AnyBelief::default()];
/// let hand = HandController::with_beliefs(HandSettings::default(), [FingerLimits::<f64, 2>::none(); 2], beliefs)?;
/// // Nothing has slipped so far.
/// assert!(hand.beliefs().iter().all(|belief| belief.estimate().is_none()));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyBelief<T> {
    /// What is known beforehand, less at each slip.
    SlipFactor(SlipFactor<T>),
    /// What slips have taught.
    Learnt(LearntFriction<T>),
}

impl<T: Real> Default for AnyBelief<T> {
    fn default() -> Self {
        Self::SlipFactor(SlipFactor::default())
    }
}

impl<T: Real> AnyBelief<T> {
    /// How break-away scatters on one surface, as a share, where nothing better is known.
    pub const SCATTER: f64 = 0.05;
    /// With what probability the friction may be less than what is relied on, where nothing better is wished.
    pub const PROBABILITY: f64 = 0.01;

    /// What slips will teach, from the standard deviation of each component of the contact force \[N\], the scatter of break-away
    /// as a share, and the probability with which the friction may be less than what is relied on.
    ///
    /// # Errors
    /// As [`LearntFriction::new`].
    ///
    /// ```
    /// use fingertip_hand::AnyBelief;
    ///
    /// let belief = AnyBelief::learning(0.01, AnyBelief::<f64>::SCATTER, AnyBelief::<f64>::PROBABILITY)?;
    /// assert!(matches!(belief, AnyBelief::Learnt(_)) && belief.estimate().is_none());
    /// assert!(AnyBelief::learning(-0.01, 0.05, 0.01).is_err());
    /// # Ok::<(), fingertip_friction::BadParameter>(())
    /// ```
    pub fn learning(noise: T, scatter: T, probability: f64) -> Result<Self, BadParameter> {
        Ok(Self::Learnt(LearntFriction::new(ForceNoise::isotropic(noise)?, scatter, probability)?))
    }

    /// What slips have taught; `None` before the first, and without learning.
    #[must_use]
    pub fn estimate(&self) -> Option<FrictionEstimate<T>> {
        match self {
            Self::SlipFactor(_) => None,
            Self::Learnt(learnt) => learnt.estimate(),
        }
    }
}

impl<T: Real> FrictionBelief<T> for AnyBelief<T> {
    fn rely(
        &mut self,
        beforehand: T,
        force: &ContactForce<T>,
        slip: SlipVerdict,
        time_step: T,
        settings: &HandSettings<T>,
    ) -> T {
        match self {
            Self::SlipFactor(belief) => belief.rely(beforehand, force, slip, time_step, settings),
            Self::Learnt(belief) => belief.rely(beforehand, force, slip, time_step, settings),
        }
    }

    fn forget(&mut self) {
        match self {
            Self::SlipFactor(belief) => belief.forget(),
            Self::Learnt(belief) => belief.forget(),
        }
    }
}

/// How many ratios the estimator of a finger keeps.
const KEPT: usize = 64;
/// How many samples a contact holds in a row to have held.
const HELD: u32 = 32;

/// Learns the friction of a finger: at each slip the peak of the friction ratio is measured
/// ([`StaticFriction`]), and a low quantile of the estimate is relied on from then on, be it less or more than what was known
/// beforehand. A slip that tells nothing (too soon after the contact) counts as with [`SlipFactor`]. What holds for 32
/// samples at a ratio above the one that is relied on raises it to the least of these (`docs/theory/hand.md#reaction`).
///
/// Friction can be learnt before the weight is lifted: with a light grip and the object still on the table, the hand moves
/// up slowly until the fingers slide. Where the motion is known, [`IncipientSlip`](fingertip_friction::IncipientSlip) says
/// when, and needs no fall of the friction.
///
/// ```
/// use fingertip_friction::{ForceNoise, SlipVerdict};
/// use fingertip_hand::{FrictionBelief, HandSettings, LearntFriction};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let mut belief = LearntFriction::new(ForceNoise::isotropic(0.01)?, 0.05, 0.01)?;
/// let settings = HandSettings::default();
/// let mut pull = |sideways: f64, slip| {
///     let force = ContactForce::new(2.0, Vector3::x() * sideways, 0.0);
///     belief.rely(0.3, &force, slip, 1e-3, &settings)
/// };
/// for step in 0..100 {
///     pull(0.012 * f64::from(step), SlipVerdict::Holding);
/// }
/// // It slips at a ratio of 0.6, and 0.3 was known: 0.6 ± 5 % is relied on by what is undercut once in a hundred slips.
/// assert!((pull(1.2, SlipVerdict::Slipping) - 0.53).abs() < 0.02);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LearntFriction<T> {
    estimator: StaticFriction<T, KEPT>,
    quantile: f64,
    factor: SlipFactor<T>,
    /// What is relied on, once something was learnt.
    learnt: Option<T>,
    /// Samples since a slip was measured, while it goes on.
    slipping: Option<u32>,
    /// Samples in a row at a greater ratio than the one relied on, and the least of these.
    held: (u32, T),
}

impl<T: Real> LearntFriction<T> {
    /// From the noise of the contact force, the relative scatter of break-away on one surface (such as 0.05), and the
    /// probability with which the friction may be less than what is relied on (such as 0.01).
    ///
    /// # Errors
    /// [`BadParameter`] unless the noise is positive and finite, the scatter finite and not negative, and the probability
    /// between 0 and one half.
    pub fn new(noise: ForceNoise<T>, scatter: T, quantile: f64) -> Result<Self, BadParameter> {
        if !(quantile > 0.0 && quantile <= 0.5) {
            let requirement = "above 0 and at most 0.5";
            return Err(BadParameter { parameter: "probability of less friction", requirement });
        }
        let estimator = StaticFriction::new(noise, scatter, T::literal(0.01))?;
        let factor = SlipFactor::default();
        Ok(Self { estimator, quantile, factor, learnt: None, slipping: None, held: (0, T::zero()) })
    }

    /// What slips have taught; `None` before the first.
    #[must_use]
    pub fn estimate(&self) -> Option<FrictionEstimate<T>> {
        self.estimator.estimate()
    }

    /// Measures a slip. Whether it told something.
    fn measure(&mut self) -> bool {
        let Some(estimate) = self.estimator.onset() else { return false };
        let quantile = estimate.quantile(self.quantile);
        if !(quantile > T::zero()) {
            return false;
        }
        self.learnt = Some(quantile);
        self.factor.forget();
        true
    }
}

impl<T: Real> FrictionBelief<T> for LearntFriction<T> {
    fn rely(
        &mut self,
        beforehand: T,
        force: &ContactForce<T>,
        slip: SlipVerdict,
        time_step: T,
        settings: &HandSettings<T>,
    ) -> T {
        self.estimator.observe(force);
        let mut verdict = SlipVerdict::Holding;
        if slip == SlipVerdict::Slipping {
            self.held.0 = 0;
            match self.slipping {
                // One that goes on is measured again when all that is remembered is new.
                Some(since) if (since as usize) < KEPT => self.slipping = Some(since + 1),
                Some(_) => {
                    self.measure();
                    self.slipping = Some(0);
                }
                None => {
                    self.slipping = Some(0);
                    if !self.measure() {
                        verdict = SlipVerdict::Slipping;
                    }
                }
            }
        } else {
            self.slipping = None;
        }
        let most = settings.greatest_ratio;
        let known = self.learnt.unwrap_or(beforehand).min(most);
        let friction = self.factor.rely(known, force, verdict, time_step, settings);
        let ratio = force.friction_ratio().filter(|ratio| slip == SlipVerdict::Holding && *ratio > friction);
        match ratio {
            Some(ratio) => {
                let least = if self.held.0 == 0 { ratio } else { self.held.1.min(ratio) };
                self.held = (self.held.0 + 1, least);
            }
            None => self.held.0 = 0,
        }
        if self.held.0 < HELD {
            return friction;
        }
        let held = self.held.1.min(most);
        self.learnt = Some(held);
        self.factor.forget();
        self.held.0 = 0;
        held
    }

    fn forget(&mut self) {
        self.estimator.reset();
        self.factor.forget();
        (self.learnt, self.slipping, self.held) = (None, None, (0, T::zero()));
    }
}
