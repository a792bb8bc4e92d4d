//! What the fingers tell the controller.

use fingertip_friction::SlipVerdict;
use fingertip_wrench::{ContactForce, Frame, Real, RigidTransform, Wrench};

use crate::{GraspContact, Hand};

/// A contact of a finger in one sample.
///
/// ```
/// use fingertip_friction::SlipVerdict;
/// use fingertip_hand::{FingerSample, GraspContact, Hand};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let contact = GraspContact::<f64, Hand>::point(-Vector3::x() * 0.02, Vector3::x(), 0.6)?;
/// let force = ContactForce::new(2.0, Vector3::z() * -1.0, 0.0);
/// let sample = FingerSample { contact, force, slip: SlipVerdict::Holding };
/// // What the object does to the fingertip: it presses outward, and its weight hangs on it.
/// let wrench = sample.wrench();
/// assert_eq!(wrench.force().z, -1.0);
/// assert!(sample.is_plausible(3.0) && !sample.is_plausible(0.4));
/// # Ok::<(), fingertip_hand::BadContact>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerSample<T: Real, F: Frame = Hand> {
    /// Where it touches, with the friction coefficient as far as it is known (a low quantile, not the mean).
    pub contact: GraspContact<T, F>,
    /// The force that it feels there.
    pub force: ContactForce<T>,
    /// What its slip detector says.
    pub slip: SlipVerdict,
}

/// What a finger says in one sample.
///
/// ```
/// use fingertip_friction::SlipVerdict;
/// use fingertip_hand::{FingerSample, FingerState, GraspContact, Hand};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let contact = GraspContact::<f64, Hand>::point(-Vector3::x() * 0.02, Vector3::x(), 0.6)?;
/// let felt = |normal, sideways| {
///     let force = ContactForce::new(normal, Vector3::z() * sideways, 0.0);
///     FingerState::Touching(FingerSample { contact, force, slip: SlipVerdict::Holding })
/// };
/// // A friction ratio of 15 cannot be, where 3 is the greatest.
/// assert!(felt(2.0, 1.0).believed(3.0).is_some() && felt(0.1, 1.5).believed(3.0).is_none());
/// assert!(FingerState::<f64>::Free.is_plausible(3.0) && !FingerState::<f64>::Unexplained.is_plausible(3.0));
/// # Ok::<(), fingertip_hand::BadContact>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum FingerState<T: Real, F: Frame = Hand> {
    /// It touches nothing.
    #[default]
    Free,
    /// It touches here.
    Touching(FingerSample<T, F>),
    /// It feels a force that no contact of its surface explains, or numbers that are not finite: the sensor is wrong, or
    /// something else than its surface is touched.
    Unexplained,
}

impl<T: Real, F: Frame> FingerState<T, F> {
    /// The contact, if there is one.
    #[must_use]
    pub const fn sample(&self) -> Option<&FingerSample<T, F>> {
        match self {
            Self::Touching(sample) => Some(sample),
            _ => None,
        }
    }

    /// The contact, if there is one that [can be](FingerSample::is_plausible).
    #[must_use]
    pub fn believed(&self, greatest_ratio: T) -> Option<&FingerSample<T, F>> {
        self.sample().filter(|sample| sample.is_plausible(greatest_ratio))
    }

    /// The same in another frame, as the finger's pose of this sample gives it.
    #[must_use]
    pub fn expressed_in<To: Frame>(&self, to_from_here: &RigidTransform<T, To, F>) -> FingerState<T, To> {
        match self {
            Self::Free => FingerState::Free,
            Self::Touching(sample) => FingerState::Touching(sample.expressed_in(to_from_here)),
            Self::Unexplained => FingerState::Unexplained,
        }
    }

    /// Of a sensor that is in the object: what the finger would say.
    #[must_use]
    pub fn reversed(&self) -> Self {
        match self {
            Self::Touching(sample) => Self::Touching(sample.reversed()),
            other => *other,
        }
    }

    /// Whether what it says can be: that it touches nothing, or a contact that [can be](FingerSample::is_plausible).
    #[must_use]
    pub fn is_plausible(&self, greatest_ratio: T) -> bool {
        matches!(self, Self::Free) || self.believed(greatest_ratio).is_some()
    }
}

impl<T: Real, F: Frame> From<FingerSample<T, F>> for FingerState<T, F> {
    fn from(sample: FingerSample<T, F>) -> Self {
        Self::Touching(sample)
    }
}

/// A finger that has no contact touches nothing.
impl<T: Real, F: Frame> From<Option<FingerSample<T, F>>> for FingerState<T, F> {
    fn from(sample: Option<FingerSample<T, F>>) -> Self {
        sample.map_or(Self::Free, Self::Touching)
    }
}

impl<T: Real, F: Frame> FingerSample<T, F> {
    /// Whether the contact can be: it presses, with finite numbers, and asks for no more than this friction ratio, of a
    /// tangential force or of a spin torque over the arm.
    #[must_use]
    pub fn is_plausible(&self, greatest_ratio: T) -> bool {
        let force = &self.force;
        let arm = self.contact.arm();
        let most = greatest_ratio * force.normal;
        let within =
            force.tangential_magnitude() <= most && (!(arm > T::zero()) || force.spin.abs() <= most * arm);
        force.is_finite() && force.normal > T::zero() && within
    }

    /// The same in another frame, as the finger's pose of this sample gives it.
    #[must_use]
    pub fn expressed_in<To: Frame>(&self, to_from_here: &RigidTransform<T, To, F>) -> FingerSample<T, To> {
        let Self { contact, force, slip } = self;
        let tangential = to_from_here.rotate(&force.tangential.vector());
        let force = ContactForce::new(force.normal, tangential, force.spin);
        FingerSample { contact: contact.expressed_in(to_from_here), force, slip: *slip }
    }

    /// Of a sensor that is in the object: what the finger feels is the opposite, along the opposite normal. Normal force
    /// and spin torque keep their numbers.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let Self { contact, force, slip } = self;
        let force = ContactForce::new(force.normal, -force.tangential.vector(), force.spin);
        Self { contact: contact.reversed(), force, slip: *slip }
    }

    /// What it feels as a wrench on the fingertip, about the origin of the frame.
    #[must_use]
    pub fn wrench(&self) -> Wrench<T, F> {
        self.contact.wrench(&self.force)
    }
}

/// Where a controller has the load from: what the object hands on to the fingertips together.
///
/// A sensor that is wrong must not drive the other fingers, so it matters whether its reading is part of the load.
///
/// ```
/// use fingertip_hand::{FingerState, HandLoad};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let fingers = [FingerState::Free, FingerState::Unexplained];
/// let weight = Wrench::on_fingertip(Vector3::z() * -1.96, Vector3::zeros());
/// assert!(HandLoad::<f64>::FromFingers.wrench(&fingers, 3.0).is_none());
/// assert_eq!(HandLoad::Known(weight).wrench(&fingers, 3.0), Some(weight));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum HandLoad<T: Real, F: Frame = Hand> {
    /// The sum of what the fingers feel, of those that can be believed. While there is one that cannot, what it bears is
    /// not known, and commands stay.
    #[default]
    FromFingers,
    /// Known without the fingers, about the origin of the frame: from the mass of the object and its motion, or from a
    /// sensor in the wrist. Fingers that cannot be believed are left out, and the others are to bear it all.
    Known(Wrench<T, F>),
}

impl<T: Real, F: Frame> HandLoad<T, F> {
    /// The load, about the origin of the frame; `None` while it is that of the fingers and one of them says what cannot be,
    /// with a friction ratio beyond the greatest or otherwise.
    #[must_use]
    pub fn wrench<const N: usize>(
        &self,
        fingers: &[FingerState<T, F>; N],
        greatest_ratio: T,
    ) -> Option<Wrench<T, F>> {
        match self {
            Self::Known(wrench) => Some(*wrench),
            Self::FromFingers => fingers.iter().try_fold(Wrench::zero(), |sum, finger| match finger {
                FingerState::Free => Some(sum),
                _ => finger.believed(greatest_ratio).map(|sample| sum + sample.wrench()),
            }),
        }
    }
}
