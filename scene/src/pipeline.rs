//! The pipeline of a scene, chosen at run time.

use fingertip::contact::Contact;
use fingertip::friction::{SlipMargin, SlipVerdict, StickSlip};
use fingertip::surfaces::DynSurface;
use fingertip::wrench::{ContactForce, Real, Uncompensated, Wrench};
use fingertip::{Absent, Fingertip, Step, Touch};
use nalgebra::Vector3;

use crate::estimate::{Estimate, Learnt};
use crate::friction::{Friction, Limit};
use crate::grip::Grip;
use crate::model::Model;
use crate::slip::SlipWatch;
use crate::uncertainty::{Spread, Uncertainty};

/// A longer step than this is a pause \[s\]: what follows from sample to sample starts anew.
const PAUSE: f64 = 0.5;

/// The typed pipeline over choices at run time: the same stages in the same order, so the same bits.
type Stages<T> = Fingertip<Absent, DynSurface<T>, Model<T>, Friction<T>, SlipWatch<T>, Uncompensated, Absent>;

/// A fingertip that a scene describes: every stage is chosen when it is made, once.
///
/// Made by [`Scene::pipeline`](crate::Scene::pipeline). One sample at a time: it keeps the last contact, what the
/// slip detector saw, and what was learnt of the friction. After a pause of more than half a second, and after
/// [`reset`](Self::reset), the next sample is the first.
#[derive(Clone, Debug, PartialEq)]
pub struct Pipeline<T: Real> {
    stages: Stages<T>,
    uncertainty: Option<Uncertainty<T>>,
    estimate: Option<Estimate<T>>,
    grip: Option<Grip<T>>,
    last: Option<Vector3<T>>,
}

/// What one sample says: of a stage that the scene has not, nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Felt<T: Real> {
    /// Wrench, contact, force, slip margin and slip verdict.
    pub touch: Touch<T, Option<SlipMargin<T>>, Option<SlipVerdict>>,
    /// How sure the contact is, with `[uncertainty]`; `None` also where it cannot be said, as at grazing.
    pub spread: Option<Spread<T>>,
    /// The probability that the contact slips, where the friction is known with a deviation.
    pub slip_probability: Option<T>,
    /// The stick-slip motion that goes on, where it is looked for.
    pub stick_slip: Option<StickSlip<T>>,
    /// What was learnt of the friction so far, with `[estimate]`.
    pub friction: Option<Learnt<T>>,
    /// The normal force to command next \[N\], with `[grip]`.
    pub grip_force: Option<T>,
}

impl<T: Real> Felt<T> {
    /// Where it touches, and how.
    pub const fn contact(&self) -> Option<&Contact<T>> {
        self.touch.resolution.contact()
    }

    /// The force of the contact, split at its tangent plane.
    pub const fn force(&self) -> Option<&ContactForce<T>> {
        self.touch.force.as_ref()
    }

    /// How far the contact is from slipping, with `[friction]`.
    pub fn margin(&self) -> Option<SlipMargin<T>> {
        self.touch.grip.flatten()
    }
}

/// What a scene tells of a sample beside contact, forces, margin and verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tells {
    /// A spin torque: the contact model knows one.
    pub spin_torque: bool,
    /// How sure the contact is: there is an `[uncertainty]`.
    pub spread: bool,
    /// The probability of slip: the friction has a deviation.
    pub slip_probability: bool,
    /// What was learnt of the friction: there is an `[estimate]`.
    pub friction: bool,
    /// The normal force to command: there is a `[grip]`.
    pub grip_force: bool,
}

/// The parts that a scene builds.
pub(crate) struct Parts<T: Real> {
    pub(crate) surface: DynSurface<T>,
    pub(crate) model: Model<T>,
    pub(crate) uncertainty: Option<Uncertainty<T>>,
    pub(crate) friction: Friction<T>,
    pub(crate) slip: SlipWatch<T>,
    pub(crate) estimate: Option<Estimate<T>>,
    pub(crate) grip: Option<Grip<T>>,
}

impl<T: Real> Pipeline<T> {
    pub(crate) fn new(parts: Parts<T>) -> Self {
        let Parts { surface, model, uncertainty, friction, slip, estimate, grip } = parts;
        let stages =
            Fingertip::builder().contact(surface, model).friction_stage(friction).slip_stage(slip).build();
        Self { stages, uncertainty, estimate, grip, last: None }
    }

    /// Takes a wrench on the fingertip and the time since the one before \[s\]; a time that is not positive
    /// counts as none.
    #[inline]
    pub fn sense(&mut self, wrench: Wrench<T>, time_step: T) -> Felt<T> {
        let time_step = if time_step > T::zero() { time_step } else { T::zero() };
        if time_step > T::literal(PAUSE) {
            self.start_anew();
        }
        let before = self.last;
        let touch = self.stages.sense_wrench(wrench, Step::of(time_step).with_last(before));
        self.last = touch.point();
        let mut felt = Felt {
            touch,
            spread: None,
            slip_probability: None,
            stick_slip: None,
            friction: None,
            grip_force: None,
        };
        if self.has_more() {
            self.say_more(&mut felt, before, time_step);
        }
        felt
    }

    /// Whether a stage beside those of every scene is there.
    #[inline]
    fn has_more(&self) -> bool {
        self.uncertainty.is_some()
            || self.estimate.is_some()
            || self.grip.is_some()
            || matches!(self.limit(), Some(Limit::Uncertain { .. }))
            || self.stages.detector().is_on()
    }

    fn say_more(&mut self, felt: &mut Felt<T>, before: Option<Vector3<T>>, time_step: T) {
        let (force, slip) = (felt.touch.force, felt.touch.slip);
        felt.stick_slip = self.stages.detector().stick_slip();
        felt.slip_probability = force.as_ref().and_then(|force| self.limit()?.slip_probability(force));
        if let (Some(uncertainty), Some(contact)) = (&self.uncertainty, felt.contact()) {
            let surface = self.stages.surface();
            let jacobian =
                self.stages.model().jacobian(contact, &felt.touch.wrench, surface, before.as_ref());
            felt.spread = jacobian.and_then(|jacobian| uncertainty.of(&jacobian, &felt.touch.wrench));
        }
        if let Some(estimate) = &mut self.estimate {
            estimate.follow(force.as_ref(), slip, time_step);
            felt.friction = Some(estimate.learnt());
        }
        if let (Some(grip), Some(limit)) = (&mut self.grip, self.stages.friction().0.as_ref()) {
            felt.grip_force = Some(grip.command(limit, force.as_ref(), slip, time_step));
        }
    }

    /// Forgets all samples: the next is the first.
    pub fn reset(&mut self) {
        self.start_anew();
        if let Some(estimate) = &mut self.estimate {
            estimate.reset();
        }
        if let Some(grip) = &mut self.grip {
            grip.reset();
        }
    }

    /// Forgets the last contact and what the slip detector saw, as after a gap in a recording; what was learnt of
    /// the friction stays.
    pub fn start_anew(&mut self) {
        self.stages.detector_mut().reset();
        self.last = None;
    }

    /// What is told of each sample beside contact, forces, margin and verdict.
    pub fn tells(&self) -> Tells {
        Tells {
            spin_torque: self.model().knows_spin(),
            spread: self.uncertainty.is_some(),
            slip_probability: matches!(self.limit(), Some(Limit::Uncertain { .. })),
            friction: self.estimate.is_some(),
            grip_force: self.grip.is_some(),
        }
    }

    /// The surface, in the sensor frame.
    pub const fn surface(&self) -> &DynSurface<T> {
        self.stages.surface()
    }

    /// The contact model.
    pub const fn model(&self) -> &Model<T> {
        self.stages.model()
    }

    /// The friction limit, if the scene has one.
    pub const fn limit(&self) -> Option<&Limit<T>> {
        self.stages.friction().0.as_ref()
    }
}
