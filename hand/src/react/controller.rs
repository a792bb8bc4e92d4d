//! Normal forces to command, sample by sample.

use fingertip_wrench::{Frame, Real, Wrench};

use crate::react::squeeze::squeezed;
use crate::{
    BadHandSettings, FingerLimits, FingerState, FrictionBelief, Grasp, GraspContact, GripOutcome,
    HandCommand, HandLoad, HandSettings, HandState, LeastGrip, SlipFactor,
};

/// Keeps the grip of a hand just firm enough, and answers slip in the same sample: the finger's friction is taken as
/// less, and the least grip is solved anew for the load that is measured (`docs/theory/hand.md#reaction`).
///
/// What is safe: commands change no faster than the settings say, and never leave the limits of the fingers. A finger
/// that says what cannot be (a force that does not press, is not finite, asks for more friction than there is, or is felt
/// without a contact) is left out, keeps its command, and drives no other one: as long as there is one, what the others
/// are to bear is not known, and all commands stay, unless the [load](HandLoad) is known without the fingers. All stay,
/// too, when the program has no answer. Where the load can be held, but not with the factor of safety, the command is what
/// holds [without](HandState::WithoutSafety) it.
///
/// ```
/// use fingertip_friction::SlipVerdict;
/// use fingertip_hand::{
///     FingerLimits, FingerSample, FingerState, GraspContact, Hand, HandController, HandLoad, HandSettings,
/// };
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let settings = HandSettings { safety: 1.5, rise: 500.0, ..HandSettings::default() };
/// let limits = FingerLimits::<f64, 2>::none().with_least_normal(0.2)?.with_greatest_normal(20.0)?;
/// let mut hand = HandController::new(settings, [limits; 2])?;
///
/// // Each feels half of the 200 g that they hold.
/// let finger = |x: f64, slip| {
///     let contact = GraspContact::<_, Hand>::soft(Vector3::x() * x, -Vector3::x() * x, 0.6, 3e-3)?;
///     let force = ContactForce::new(3.0, -Vector3::z() * 0.98, 0.0);
///     Ok::<_, fingertip_hand::BadContact>(FingerState::Touching(FingerSample { contact, force, slip }))
/// };
/// let mut command = [0.0; 2];
/// for _ in 0..20 {
///     let fingers = [finger(-0.02, SlipVerdict::Holding)?, finger(0.02, SlipVerdict::Holding)?];
///     command = hand.command(&fingers, &HandLoad::FromFingers, 1e-3).normal;
/// }
/// assert!((command[0] - 0.98 * 1.5 / 0.6).abs() < 1e-6);
/// // The left one slips: both press harder at once, by what 1 ms allows.
/// let fingers = [finger(-0.02, SlipVerdict::Slipping)?, finger(0.02, SlipVerdict::Holding)?];
/// assert!(hand.command(&fingers, &HandLoad::FromFingers, 1e-3).normal[1] > command[1] + 0.1);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandController<T: Real, const N: usize, const ROWS: usize, Belief = SlipFactor<T>> {
    settings: HandSettings<T>,
    limits: [FingerLimits<T, ROWS>; N],
    /// Starts from the last grip: one with safety, or one [without](Self::without_safety).
    least: LeastGrip<T, N, ROWS>,
    without_safety: bool,
    commands: [T; N],
    beliefs: [Belief; N],
}

impl<T: Real, const N: usize, const ROWS: usize> HandController<T, N, ROWS> {
    /// Starts at the fingers' least normal forces. Slip multiplies the friction of a finger by a [factor](SlipFactor).
    ///
    /// # Errors
    /// [`BadHandSettings`].
    pub fn new(
        settings: HandSettings<T>,
        limits: [FingerLimits<T, ROWS>; N],
    ) -> Result<Self, BadHandSettings> {
        Self::with_beliefs(settings, limits, [SlipFactor::default(); N])
    }
}

impl<T: Real, const N: usize, const ROWS: usize, Belief: FrictionBelief<T>>
    HandController<T, N, ROWS, Belief>
{
    /// The same with another belief about the friction of each finger, such as one that [learns](crate::LearntFriction).
    ///
    /// # Errors
    /// [`BadHandSettings`].
    pub fn with_beliefs(
        settings: HandSettings<T>,
        limits: [FingerLimits<T, ROWS>; N],
        beliefs: [Belief; N],
    ) -> Result<Self, BadHandSettings> {
        let commands = limits.map(|limits| limits.least_normal().unwrap_or_else(T::zero));
        let settings = settings.checked()?;
        Ok(Self { settings, limits, least: LeastGrip::new(), without_safety: false, commands, beliefs })
    }

    /// Other limits from now on, as of joints that have turned.
    pub fn set_limits(&mut self, limits: [FingerLimits<T, ROWS>; N]) {
        self.limits = limits;
    }

    /// What is believed of the friction of each finger.
    #[must_use]
    pub const fn beliefs(&self) -> &[Belief; N] {
        &self.beliefs
    }

    /// The normal forces \[N\] to command for the next sample, that hold the load while internal forces change.
    ///
    /// A finger that touches nothing keeps its command. A time step that is not positive and finite leaves all commands.
    pub fn command<F: Frame>(
        &mut self,
        fingers: &[FingerState<T, F>; N],
        load: &HandLoad<T, F>,
        time_step: T,
    ) -> HandCommand<T, N, F> {
        let safety = self.settings.safety;
        let mut implausible = [false; N];
        let mut contacts = [None; N];
        let timed = time_step > T::zero() && time_step.is_number();
        let passed = if timed { time_step } else { T::zero() };
        let each = fingers.iter().zip(&mut contacts).zip(&mut implausible).zip(&mut self.beliefs);
        for (((finger, contact), implausible), belief) in each {
            *implausible = !finger.is_plausible(self.settings.greatest_ratio);
            let Some(finger) = finger.sample().filter(|_| !*implausible) else { continue };
            let known = finger.contact.friction();
            let friction = belief.rely(known, &finger.force, finger.slip, passed, &self.settings);
            // One whose friction over the factor of safety is no number holds nothing.
            *contact =
                finger.contact.with_friction(friction).filter(|contact| contact.with_safety(safety).is_ok());
        }
        let commands = self.commands;
        let unchanged = |state| HandCommand { normal: commands, state, implausible };
        if !timed || contacts.iter().flatten().count() == 0 {
            return unchanged(HandState::Blind);
        }
        let Some(load) = load.wrench(fingers, self.settings.greatest_ratio) else {
            return unchanged(HandState::Doubtful);
        };
        let (normal, state) = match self.grip(&contacts, &load) {
            (Some(normal), state) => (normal, state),
            (None, state) => return unchanged(state),
        };
        let each = self.commands.iter_mut().zip(&contacts).zip(&normal).zip(&self.limits);
        for (((command, contact), wanted), limits) in each {
            if contact.is_none() {
                continue;
            }
            let (lowest, highest) =
                (*command - self.settings.fall * time_step, *command + self.settings.rise * time_step);
            let mut wanted = wanted.max(lowest).min(highest).max(T::zero());
            if let Some(greatest) = limits.greatest_normal() {
                wanted = wanted.min(greatest);
            }
            if wanted.is_number() {
                *command = wanted;
            }
        }
        HandCommand { normal: self.commands, state, implausible }
    }

    /// Normal forces that hold the load at contacts with this friction, if there are some: with the factor of safety, or else
    /// without it.
    fn grip<F: Frame>(
        &mut self,
        contacts: &[Option<GraspContact<T, F>>; N],
        load: &Wrench<T, F>,
    ) -> (Option<[T; N]>, HandState<T, F>) {
        let safety = self.settings.safety;
        let careful = Grasp::new(contacts.map(|contact| contact?.with_safety(safety).ok()));
        let outcome = if self.without_safety {
            // What it starts from is kept for the grip without safety.
            let mut least = LeastGrip::new();
            let outcome = least.solve(&careful, &self.limits, load);
            if outcome.grip().is_some() {
                (self.least, self.without_safety) = (least, false);
            }
            outcome
        } else {
            self.least.solve(&careful, &self.limits, load)
        };
        match outcome {
            GripOutcome::Held(grip) => {
                return (Some(grip.forces.map(|force| force.normal)), HandState::Holding);
            }
            GripOutcome::CannotHold(why) if safety <= T::one() => return (None, HandState::CannotHold(why)),
            GripOutcome::NotFinite => return (None, HandState::Blind),
            GripOutcome::CannotHold(_) | GripOutcome::Undecided => {}
        }
        let grasp = Grasp::new(*contacts);
        let outcome = self.least.solve(&grasp, &self.limits, load);
        self.without_safety = outcome.grip().is_some();
        match outcome {
            GripOutcome::Held(grip) => {
                let normal = squeezed(&grasp, &self.limits, &grip.forces, safety);
                (Some(normal), HandState::WithoutSafety)
            }
            GripOutcome::CannotHold(why) => (None, HandState::CannotHold(why)),
            GripOutcome::NotFinite | GripOutcome::Undecided => (None, HandState::Blind),
        }
    }

    /// The settings.
    #[must_use]
    pub const fn settings(&self) -> &HandSettings<T> {
        &self.settings
    }

    /// The commands now in force \[N\].
    #[must_use]
    pub const fn present(&self) -> [T; N] {
        self.commands
    }

    /// Forgets what was learnt of the fingers' friction, as when another object is grasped.
    pub fn forget_friction(&mut self) {
        self.beliefs.iter_mut().for_each(Belief::forget);
        self.least.forget();
        self.without_safety = false;
    }
}
