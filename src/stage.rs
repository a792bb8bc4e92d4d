//! The optional stages of the pipeline and their absence.

#[cfg(feature = "friction")]
use fingertip_friction::{FrictionModel, SlipDetector, SlipMargin, SlipVerdict};
use fingertip_wrench::{Compensation, ContactForce, Real, Wrench};

/// A stage that is left out: zero-sized, and its calls vanish.
///
/// ```
/// use fingertip::prelude::*;
/// use fingertip::{Absent, Fingertip};
///
/// type Bare = Fingertip<Absent, Sphere<f64>, PointContact<f64>>;
/// let bare: Bare = Fingertip::builder().contact(Sphere::centred(13e-3)?, PointContact::new(0.1)?).build();
/// assert_eq!(size_of_val(&bare), size_of::<(Sphere<f64>, PointContact<f64>)>());
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Absent;

/// A stage that is there, in types that are written out.
///
/// ```
/// use fingertip::prelude::*;
/// use fingertip::{Absent, Present};
///
/// struct Finger {
///     tip: Fingertip<Absent, Sphere<f64>, PointContact<f64>, Present<Coulomb<f64>>>,
/// }
///
/// let (ball, model) = (Sphere::centred(13e-3)?, PointContact::new(0.1)?);
/// let mut finger = Finger { tip: Fingertip::builder().contact(ball, model).friction(Coulomb::new(0.5)?).build() };
/// let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
/// assert!(finger.tip.sense_wrench(push, 1e-3).grip.is_some());
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Present<Stage>(pub Stage);

/// Judges the contact force of one sample. Every friction model is one, wrapped in [`Present`].
///
/// ```
/// use fingertip::prelude::*;
///
/// /// Tells how hard it presses, and nothing else.
/// struct Scales;
///
/// impl GripStage<f64> for Scales {
///     type Reading = f64;
///
///     fn judge(&self, force: &ContactForce<f64>) -> f64 {
///         force.normal
///     }
/// }
///
/// let (ball, model) = (Sphere::centred(13e-3)?, PointContact::new(0.1)?);
/// let mut tip = Fingertip::builder().contact(ball, model).friction_stage(Scales).build();
/// let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
/// assert_eq!(tip.sense_wrench(push, 1e-3).grip, Some(2.0));
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot judge a contact force of `{T}`",
    note = "give a friction model to `.friction(…)`, which wraps it in `Present`, or a `GripStage` to `.friction_stage(…)`"
)]
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
///
/// ```
/// use fingertip::prelude::*;
///
/// /// Counts the samples of a touch.
/// #[derive(Default)]
/// struct Count(u32);
///
/// impl SlipStage<f64> for Count {
///     type Verdict = u32;
///
///     fn follow(&mut self, force: Option<&ContactForce<f64>>, _: f64) -> u32 {
///         self.0 = if force.is_some() { self.0 + 1 } else { 0 };
///         self.0
///     }
/// }
///
/// let (ball, model) = (Sphere::centred(13e-3)?, PointContact::new(0.1)?);
/// let mut tip = Fingertip::builder().contact(ball, model).slip_stage(Count::default()).build();
/// let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
/// assert_eq!([tip.sense_wrench(push, 1e-3).slip, tip.sense_wrench(push, 1e-3).slip], [1, 2]);
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot follow contact forces of `{T}`",
    note = "give a slip detector to `.slip_detector(…)`, which wraps it in `Present`, or a `SlipStage` to `.slip_stage(…)`"
)]
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
