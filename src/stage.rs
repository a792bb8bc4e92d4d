//! The optional stages of the pipeline and their absence.

#[cfg(feature = "friction")]
use fingertip_friction::{FrictionModel, SlipDetector, SlipMargin, SlipVerdict};
use fingertip_wrench::{Compensation, ContactForce, Real, Wrench};

/// A stage that is left out: zero-sized, and its calls vanish.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Absent;

/// A stage that is there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Present<Stage>(pub Stage);

/// Judges the contact force of one sample. Every friction model is one, wrapped in [`Present`].
pub trait GripStage<T: Real> {
    /// What it says of a contact.
    type Reading;

    /// Judges a contact force.
    fn judge(&self, force: &ContactForce<T>) -> Self::Reading;

    /// The margin that a reading tells, for the columns of a batch; `None`, as the default answers, if none.
    #[cfg(feature = "friction")]
    #[inline]
    fn margin(reading: &Self::Reading) -> Option<SlipMargin<T>> {
        let _ = reading;
        None
    }
}

/// Follows the contact force from sample to sample. Every slip detector is one,
/// wrapped in [`Present`].
pub trait SlipStage<T: Real> {
    /// What it says after a sample.
    type Verdict;

    /// Takes the next sample, if there is a contact, and the time since the one before \[s\].
    fn follow(&mut self, force: Option<&ContactForce<T>>, time_step: T) -> Self::Verdict;

    /// Forgets the samples before; the default has nothing to forget.
    #[inline]
    fn start_anew(&mut self) {}

    /// What a verdict says in the words of the column of a batch; `None`, as the default answers, if nothing.
    #[cfg(feature = "friction")]
    #[inline]
    fn slip(verdict: &Self::Verdict) -> Option<SlipVerdict> {
        let _ = verdict;
        None
    }
}

/// Nothing hangs on the sensor.
impl<T: Real> Compensation<Wrench<T>> for Absent {
    type Raw = (Wrench<T>, ());

    #[inline(always)]
    fn compensate(&self, (measured, ()): &(Wrench<T>, ())) -> Wrench<T> {
        *measured
    }
}

impl<T: Real> GripStage<T> for Absent {
    type Reading = ();

    #[inline]
    fn judge(&self, _force: &ContactForce<T>) {}
}

impl<T: Real> SlipStage<T> for Absent {
    type Verdict = ();

    #[inline]
    fn follow(&mut self, _force: Option<&ContactForce<T>>, _time_step: T) {}
}

#[cfg(feature = "friction")]
impl<T: Real, M: FrictionModel<T>> GripStage<T> for Present<M> {
    type Reading = SlipMargin<T>;

    #[inline]
    fn judge(&self, force: &ContactForce<T>) -> SlipMargin<T> {
        self.0.slip_margin(force)
    }

    #[inline]
    fn margin(reading: &SlipMargin<T>) -> Option<SlipMargin<T>> {
        Some(*reading)
    }
}

#[cfg(feature = "friction")]
impl<T: Real, D: SlipDetector<T>> SlipStage<T> for Present<D> {
    type Verdict = SlipVerdict;

    #[inline]
    fn follow(&mut self, force: Option<&ContactForce<T>>, time_step: T) -> SlipVerdict {
        match force {
            Some(force) => self.0.update(force, time_step),
            None => self.0.update_open(time_step),
        }
    }

    #[inline]
    fn start_anew(&mut self) {
        self.0.reset();
    }

    #[inline]
    fn slip(verdict: &SlipVerdict) -> Option<SlipVerdict> {
        Some(*verdict)
    }
}
