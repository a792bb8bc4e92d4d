//! What every slip detector does.

use fingertip_wrench::{ContactForce, Real};

/// What a detector says after a sample.
///
/// ```
/// use fingertip_friction::{ForceNoise, NormalForceGate, RatioThreshold, SlipDetector, SlipVerdict};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.01)?);
/// let mut detector = RatioThreshold::new(gate, 0.5)?;
/// let mut judged = |normal, sideways: f64| detector.update(&ContactForce::new(normal, Vector3::x() * sideways, 0.0), 1e-3);
/// assert_eq!(judged(0.05, 0.0), SlipVerdict::NotPressing);
/// assert_eq!(judged(2.0, 0.5), SlipVerdict::Holding);
/// assert_eq!(judged(2.0, 0.9), SlipVerdict::Warning);
/// assert_eq!(judged(2.0, 1.1), SlipVerdict::Slipping);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[repr(u8)]
pub enum SlipVerdict {
    /// The normal force is too small, or the sample not finite: nothing can be said.
    NotPressing,
    /// The contact holds, as far as this detector sees.
    Holding,
    /// Slip is near: the contact still holds.
    Warning,
    /// The contact slips.
    Slipping,
}

impl SlipVerdict {
    /// The verdict that has a number where it crosses a border to another language, which is its number here; `None` for a number
    /// that no verdict has.
    ///
    /// ```
    /// use fingertip_friction::SlipVerdict;
    ///
    /// assert_eq!(SlipVerdict::of_number(SlipVerdict::Slipping as u32), Some(SlipVerdict::Slipping));
    /// assert_eq!(SlipVerdict::of_number(4), None);
    /// ```
    #[must_use]
    pub const fn of_number(number: u32) -> Option<Self> {
        Some(match number {
            0 => Self::NotPressing,
            1 => Self::Holding,
            2 => Self::Warning,
            3 => Self::Slipping,
            _ => return None,
        })
    }

    /// The word that files and messages have for it.
    ///
    /// ```
    /// use fingertip_friction::SlipVerdict;
    ///
    /// assert_eq!(SlipVerdict::NotPressing.word(), "not_pressing");
    /// ```
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::NotPressing => "not_pressing",
            Self::Holding => "holding",
            Self::Warning => "warning",
            Self::Slipping => "slipping",
        }
    }
}

/// Finds slip in a stream of contact forces.
///
/// # For implementers
/// One update is bounded work without allocation; the state is part of the value, so that cloning
/// a detector clones its memory. A sample that is not finite must leave the state as it was and
/// answer [`SlipVerdict::NotPressing`]. With the feature `testing`, `testing::detector_laws` tries a detector of your
/// own.
///
/// ```
/// use fingertip_friction::{DropDetector, ForceNoise, SlipDetector, SlipVerdict};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let mut chosen = DropDetector::new(ForceNoise::isotropic(0.01)?)?;
/// let detector: &mut dyn SlipDetector<f64> = &mut chosen;
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
#[diagnostic::on_unimplemented(
    message = "`{Self}` detects no slip in contact forces of `{T}`",
    note = "take a detector as `DropDetector`, or implement `SlipDetector`: `update` and `reset`; its scalar must be that of the contact force"
)]
pub trait SlipDetector<T: Real> {
    /// Takes the contact force of one sample and the time since the one before \[s\].
    fn update(&mut self, force: &ContactForce<T>, time_step: T) -> SlipVerdict;

    /// Takes a sample without contact, and the time since the one before \[s\]: an update with no
    /// force, which the default makes of it.
    #[inline]
    fn update_open(&mut self, time_step: T) -> SlipVerdict {
        self.update(&ContactForce::zero(), time_step)
    }

    /// Forgets all samples, as after a change of grasp.
    fn reset(&mut self);
}

impl<T: Real, D: SlipDetector<T> + ?Sized> SlipDetector<T> for &mut D {
    #[inline]
    fn update(&mut self, force: &ContactForce<T>, time_step: T) -> SlipVerdict {
        (**self).update(force, time_step)
    }

    #[inline]
    fn update_open(&mut self, time_step: T) -> SlipVerdict {
        (**self).update_open(time_step)
    }

    #[inline]
    fn reset(&mut self) {
        (**self).reset();
    }
}
