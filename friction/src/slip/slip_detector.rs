//! What every slip detector does.

use fingertip_wrench::{ContactForce, Real};

/// What a detector says after a sample.
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

/// Finds slip in a stream of contact forces.
///
/// # For implementers
/// One update is bounded work without allocation; the state is part of the value, so that cloning
/// a detector clones its memory. A sample that is not finite must leave the state as it was and
/// answer [`SlipVerdict::NotPressing`].
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
