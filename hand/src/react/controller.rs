//! Normal forces to command, sample by sample.

use fingertip_wrench::{Frame, Real};

use crate::{
    BadHandSettings, CannotHold, FingerLimits, FingerState, FrictionBelief, Grasp, GripOutcome, Hand,
    HandLoad, HandSettings, LeastGrip, SlipFactor,
};

/// What the commands rest on.
///
/// ```
/// use fingertip_friction::SlipVerdict;
/// use fingertip_hand::*;
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let touching = |x: f64| {
///     let contact = GraspContact::<f64, Hand>::soft(Vector3::x() * x, -Vector3::x() * x, 0.6, 3e-3)?;
///     let force = ContactForce::new(3.0, -Vector3::z(), 0.0);
///     Ok::<_, BadContact>(FingerState::Touching(FingerSample { contact, force, slip: SlipVerdict::Holding }))
/// };
/// let mut hand = HandController::new(HandSettings::default(), [FingerLimits::<f64, 2>::none(); 2])?;
/// let mut state = |fingers| hand.command(&fingers, &HandLoad::FromFingers, 1e-3).state;
/// assert_eq!(state([touching(-0.02)?, touching(0.02)?]), HandState::Holding);
/// // One sensor says what cannot be; then nothing is felt at all.
/// assert_eq!(state([touching(-0.02)?, FingerState::Unexplained]), HandState::Doubtful);
/// assert_eq!(state([FingerState::Free, FingerState::Free]), HandState::Blind);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        rename_all = "snake_case",
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
pub enum HandState<T: Real, F: Frame = Hand> {
    /// The least grip for the load.
    Holding,
    /// No forces within friction and limits hold the load. The commands are those of before: pressing harder does not
    /// help.
    CannotHold(CannotHold<T, F>),
    /// A finger feels what cannot be, so that what it bears is not known, and no load was
    /// [stated](HandLoad::Known): the commands are those of before.
    Doubtful,
    /// A number is not finite, no plausible contact is left, or the program was not decided: the commands are those of
    /// before.
    Blind,
}

/// Normal forces to command.
///
/// ```
/// use fingertip_hand::{FingerLimits, FingerState, HandController, HandLoad, HandSettings, HandState};
///
/// let limits = FingerLimits::<f64, 2>::none().with_least_normal(0.2)?;
/// let mut hand = HandController::new(HandSettings::default(), [limits; 2])?;
/// let fingers: [FingerState<f64>; 2] = [FingerState::Free, FingerState::Unexplained];
/// let command = hand.command(&fingers, &HandLoad::FromFingers, 1e-3);
/// // Nothing drives the fingers: they keep to their least force. The second one is named.
/// assert_eq!(command.normal, [0.2, 0.2]);
/// assert_eq!((command.implausible, command.state), ([false, true], HandState::Blind));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct HandCommand<T: Real, const N: usize, F: Frame = Hand> {
    /// For each finger \[N\].
    #[cfg_attr(feature = "serde", serde(with = "serde_big_array::BigArray"))]
    pub normal: [T; N],
    /// What they rest on.
    pub state: HandState<T, F>,
    /// The fingers that were not believed in this sample: their contact cannot be, or they feel a force without one.
    #[cfg_attr(feature = "serde", serde(with = "serde_big_array::BigArray"))]
    pub implausible: [bool; N],
}

/// Keeps the grip of a hand just firm enough, and answers slip in the same sample: the finger's friction is taken as
/// less, and the least grip is solved anew for the load that is measured (`docs/theory/hand.md#reaction`).
///
/// What is safe: commands change no faster than the settings say, and never leave the limits of the fingers. A finger
/// that says what cannot be (a force that does not press, is not finite, asks for more friction than there is, or is felt
/// without a contact) is left out, keeps its command, and drives no other one: as long as there is one, what the others
/// are to bear is not known, and all commands stay, unless the [load](HandLoad) is known without the fingers. All stay,
/// too, when the program has no answer.
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
    least: LeastGrip<T, N, ROWS>,
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
        Ok(Self { settings, limits, least: LeastGrip::new(), commands, beliefs })
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
            *contact = finger.contact.with_friction(friction / self.settings.safety);
        }
        let commands = self.commands;
        let unchanged = |state| HandCommand { normal: commands, state, implausible };
        if !timed || contacts.iter().flatten().count() == 0 {
            return unchanged(HandState::Blind);
        }
        let Some(load) = load.wrench(fingers, self.settings.greatest_ratio) else {
            return unchanged(HandState::Doubtful);
        };
        let grip = match self.least.solve(&Grasp::new(contacts), &self.limits, &load) {
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
    }
}
