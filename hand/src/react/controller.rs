//! Normal forces to command, sample by sample.

use fingertip_friction::SlipVerdict;
use fingertip_wrench::{ContactForce, Frame, Real, Wrench};

use crate::{
    BadHandSettings, CannotHold, FingerLimits, Grasp, GraspContact, GripOutcome, Hand, HandSettings,
    LeastGrip,
};

/// What a finger knows in one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerSample<T: Real, F: Frame = Hand> {
    /// Where it touches, with the friction coefficient as far as it is known (a low quantile, not the mean).
    pub contact: GraspContact<T, F>,
    /// The force that it feels there.
    pub force: ContactForce<T>,
    /// What its slip detector says.
    pub slip: SlipVerdict,
}

/// What the commands rest on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HandState<T: Real, F: Frame = Hand> {
    /// The least grip for the load.
    Holding,
    /// No forces within friction and limits hold the load. The commands are those of before: pressing harder does not
    /// help.
    CannotHold(CannotHold<T, F>),
    /// A number is not finite, no plausible contact is left, or the program was not decided: the commands are those of
    /// before.
    Blind,
}

/// Normal forces to command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandCommand<T: Real, const N: usize, F: Frame = Hand> {
    /// For each finger \[N\].
    pub normal: [T; N],
    /// What they rest on.
    pub state: HandState<T, F>,
    /// The fingers of which the contact was not believed in this sample.
    pub implausible: [bool; N],
}

/// Keeps the grip of a hand just firm enough, and answers slip in the same sample: the finger's friction is taken as
/// less, and the least grip is solved anew for the load that is measured (`docs/theory/hand.md#reaction`).
///
/// What is safe: commands change no faster than the settings say, and never leave the limits of the fingers. A contact
/// that cannot be (a force that does not press, is not finite, or asks for more friction than there is) is left out, and
/// its finger keeps its command; it never drives a grip. So does every finger when the program has no answer.
///
/// ```
/// use fingertip_friction::SlipVerdict;
/// use fingertip_hand::{FingerLimits, FingerSample, GraspContact, Hand, HandController, HandSettings};
/// use fingertip_wrench::{ContactForce, Wrench};
/// use nalgebra::Vector3;
///
/// let settings = HandSettings {
///     safety: 1.5, rise: 500.0, fall: 2.0, at_slip: 0.8, least_friction: 0.1, greatest_ratio: 3.0,
/// };
/// let limits = FingerLimits::<f64, 2>::none().with_least_normal(0.2)?.with_greatest_normal(20.0)?;
/// let mut hand = HandController::new(settings, [limits; 2])?;
///
/// let weight = Wrench::<f64, Hand>::on_fingertip(-Vector3::z() * 1.96, Vector3::zeros());
/// let finger = |x: f64, slip| {
///     let contact = GraspContact::soft(Vector3::x() * x, -Vector3::x() * x, 0.6, 3e-3)?;
///     let force = ContactForce::new(3.0, -Vector3::z() * 0.98, 0.0);
///     Ok::<_, fingertip_hand::BadContact>(Some(FingerSample { contact, force, slip }))
/// };
/// let mut command = [0.0; 2];
/// for _ in 0..20 {
///     let fingers = [finger(-0.02, SlipVerdict::Holding)?, finger(0.02, SlipVerdict::Holding)?];
///     command = hand.command(&fingers, &weight, 1e-3).normal;
/// }
/// assert!((command[0] - 0.98 * 1.5 / 0.6).abs() < 1e-6);
/// // The left one slips: both press harder at once, by what 1 ms allows.
/// let fingers = [finger(-0.02, SlipVerdict::Slipping)?, finger(0.02, SlipVerdict::Holding)?];
/// assert!(hand.command(&fingers, &weight, 1e-3).normal[1] > command[1] + 0.1);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandController<T: Real, const N: usize, const ROWS: usize> {
    settings: HandSettings<T>,
    limits: [FingerLimits<T, ROWS>; N],
    least: LeastGrip<T, N, ROWS>,
    commands: [T; N],
    /// By what slip has multiplied the friction coefficient of each finger.
    learnt: [T; N],
}

impl<T: Real, const N: usize, const ROWS: usize> HandController<T, N, ROWS> {
    /// Starts at the fingers' least normal forces.
    ///
    /// # Errors
    /// [`BadHandSettings`].
    pub fn new(
        settings: HandSettings<T>,
        limits: [FingerLimits<T, ROWS>; N],
    ) -> Result<Self, BadHandSettings> {
        let commands = limits.map(|limits| limits.least_normal().unwrap_or_else(T::zero));
        let settings = settings.checked()?;
        Ok(Self { settings, limits, least: LeastGrip::new(), commands, learnt: [T::one(); N] })
    }

    /// The normal forces \[N\] to command for the next sample.
    ///
    /// `load` is what the object loads the fingertips with, as measured: the sum of all wrenches on them
    /// ([`UncertainWrench::total`](crate::UncertainWrench::total)); so it is kept while internal forces change. A
    /// finger that touches nothing is `None` and keeps its command. A time step that is not positive and finite
    /// leaves all commands.
    pub fn command<F: Frame>(
        &mut self,
        fingers: &[Option<FingerSample<T, F>>; N],
        load: &Wrench<T, F>,
        time_step: T,
    ) -> HandCommand<T, N, F> {
        let mut implausible = [false; N];
        let mut contacts = [None; N];
        let each = fingers.iter().zip(&mut contacts).zip(&mut implausible).zip(&mut self.learnt);
        for (((finger, contact), implausible), learnt) in each {
            let Some(finger) = finger else { continue };
            *implausible = !self.settings.believes(finger);
            if *implausible {
                continue;
            }
            if finger.slip == SlipVerdict::Slipping {
                *learnt *= self.settings.at_slip;
            }
            let wanted = finger.contact.friction() * *learnt;
            let friction = wanted.max(self.settings.least_friction.min(finger.contact.friction()));
            // What was learnt does not sink out of reach.
            *learnt = friction / finger.contact.friction();
            *contact = finger.contact.with_friction(friction / self.settings.safety);
        }
        let commands = self.commands;
        let unchanged = |state| HandCommand { normal: commands, state, implausible };
        if !(time_step > T::zero() && time_step.is_number()) || contacts.iter().flatten().count() == 0 {
            return unchanged(HandState::Blind);
        }
        let grip = match self.least.solve(&Grasp::new(contacts), &self.limits, load) {
            GripOutcome::Held(grip) => grip,
            GripOutcome::CannotHold(why) => return unchanged(HandState::CannotHold(why)),
            GripOutcome::NotFinite | GripOutcome::Undecided => return unchanged(HandState::Blind),
        };
        let each = self.commands.iter_mut().zip(&contacts).zip(&grip.forces).zip(&self.limits);
        for (((command, contact), force), limits) in each {
            if contact.is_none() {
                continue;
            }
            let (lowest, highest) =
                (*command - self.settings.fall * time_step, *command + self.settings.rise * time_step);
            let mut wanted = force.normal.max(lowest).min(highest).max(T::zero());
            if let Some(greatest) = limits.greatest_normal() {
                wanted = wanted.min(greatest);
            }
            if wanted.is_number() {
                *command = wanted;
            }
        }
        HandCommand { normal: self.commands, state: HandState::Holding, implausible }
    }

    /// The commands now in force \[N\].
    #[must_use]
    pub const fn present(&self) -> [T; N] {
        self.commands
    }

    /// Forgets what slip has taught of a finger's friction, as when another object is grasped.
    pub fn forget_friction(&mut self) {
        self.learnt = [T::one(); N];
        self.least.forget();
    }
}

impl<T: Real> HandSettings<T> {
    /// Whether a contact can be: it presses, with finite numbers, and asks for no more friction than there is.
    fn believes<F: Frame>(&self, finger: &FingerSample<T, F>) -> bool {
        let force = &finger.force;
        let arm = finger.contact.arm();
        let most = self.greatest_ratio * force.normal;
        let within =
            force.tangential_magnitude() <= most && (!(arm > T::zero()) || force.spin.abs() <= most * arm);
        force.is_finite() && force.normal > T::zero() && within
    }
}
