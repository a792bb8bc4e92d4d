//! The closed loop: from volts to the speeds of the drives.

use fingertip::contact::SoftFinger;
use fingertip::{Absent, Fingertip, Present};
use fingertip_friction::{DropDetector, ForceNoise};
use fingertip_hand::{
    ContactFriction, FingerLimits, FingerSample, FingerState, Grasp, Hand, HandCommand, HandController,
    HandLoad, HandSettings, UncertainWrench,
};
use fingertip_surfaces::{SignedDistance, Sphere};
use fingertip_wrench::{
    Compensation, ContactForce, DummyGauge, DummyGaugeAccumulator, GaussianElimination, Wrench, WrenchSolver,
};
use nalgebra::{Matrix6, Vector3, Vector6};

use super::weighing::{Doubt, Weighing};
use super::world::{HandSample, SimulatedHand};
use crate::error::SimulationError;

/// What the hand is told beforehand.
///
/// ```
/// use fingertip_simulation::hand::GrippingSettings;
///
/// // A careful hand with a slippery object.
/// let settings = GrippingSettings::<3> { friction: [0.3; 3], normal: (0.5, 10.0), ..GrippingSettings::default() };
/// assert_eq!(settings.friction[2], 0.3);
/// assert!(settings.hand.safety > 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrippingSettings<const K: usize> {
    /// The friction coefficient of each finger on the object, as far as it is known (a low quantile).
    pub friction: [f64; K],
    /// The torque arm of the contacts \[m\].
    pub arm: f64,
    /// Habits of the grip.
    pub hand: HandSettings<f64>,
    /// Least and greatest normal force of a finger \[N\].
    pub normal: (f64, f64),
    /// How fast normal forces follow what is commanded \[1/s\].
    pub bandwidth: f64,
    /// The stiffness of the skin, as far as it is known \[N/m\].
    pub stiffness: f64,
    /// At what speed the fingers close until they touch, and open \[m/s\].
    pub approach: f64,
    /// How far they close at most \[m\].
    pub reach: f64,
}

impl<const K: usize> Default for GrippingSettings<K> {
    fn default() -> Self {
        Self {
            friction: [0.5; K],
            arm: 3e-3,
            hand: HandSettings::default(),
            normal: (0.5, 20.0),
            bandwidth: 150.0,
            stiffness: 5000.0,
            approach: 0.03,
            reach: 0.04,
        }
    }
}

/// What the hand makes of a sample.
///
/// ```
/// # use fingertip_simulation::hand::{FingerPlace, GrippingHand, GrippingSettings, HandOptions};
/// # use fingertip_simulation::hand::{HandScript, HeldObject, SimulatedHand};
/// # let jar = HeldObject::cylinder(0.03, 0.05, 0.2)?;
/// # let script = HandScript::default().open(0.3).hold(0.4).lift(0.03, 0.3);
/// # let mut hand = SimulatedHand::new(jar, FingerPlace::ring::<2>(0.05), &script, HandOptions::default())?;
/// let (mut first, mut last) = (None, None);
/// GrippingHand::play(&mut hand, &GrippingSettings::default(), |_, felt, _| {
///     first.get_or_insert(*felt);
///     last = Some(*felt);
/// })?;
/// // At first the fingers close through the air, at 3 cm/s, and there is nothing to command.
/// let first = first.expect("the script has samples");
/// assert!(first.command.is_none() && first.speeds == [0.03; 2]);
/// // At last each finger presses the jar with at least the 0.5 N that it may not fall below.
/// let last = last.expect("the script has samples");
/// assert!(last.command.expect("it holds").normal.iter().all(|newton| *newton >= 0.5));
/// assert!(last.wrenches.iter().all(|wrench| wrench.force().norm() > 0.4));
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Felt<const K: usize> {
    /// The wrench on each fingertip, in its own frame.
    pub wrenches: [Wrench<f64>; K],
    /// What each finger says, in the frame of the hand.
    pub fingers: [FingerState<f64>; K],
    /// The sum of what all sensors feel, in the frame of the hand: what the object loads the fingertips with, if none of
    /// them is wrong.
    pub load: Wrench<f64, Hand>,
    /// What the controller wants; `None` while the fingers are open or not all have touched yet.
    pub command: Option<HandCommand<f64, K>>,
    /// The speeds at which the fingers shall close \[m/s\].
    pub speeds: [f64; K],
}

type TipPipeline = Fingertip<
    GaussianElimination<f64>,
    Sphere<f64>,
    SoftFinger<f64>,
    Absent,
    Present<DropDetector<f64>>,
    DummyGauge<f64, 6>,
>;

/// A hand that grips: a pipeline for each fingertip, and one [`HandController`].
///
/// Fingers close until all touch. From then on each closes at a speed that is the bandwidth times what its normal force
/// lacks over the stiffness of the skin; only the internal part of what they lack counts ([`Grasp::split`]), so that
/// the object is squeezed and not pushed about.
///
/// What it can answer: a finger that slides feels of the load what friction lets through, and a grip that is worked out
/// of that is firm enough only if friction is then believed to be less than it is while sliding. So what is believed
/// beforehand may exceed the kinetic coefficient by at most [`safety`](HandSettings::safety) over
/// [`at_slip`](HandSettings::at_slip), 1.6 by default. A load that is taken off looks like slip ([`DropDetector`]), and
/// may make the grip firmer than it need be, until [`forget_friction`](Self::forget_friction).
///
/// ```
/// use fingertip_simulation::hand::{
///     FingerPlace, GrippingHand, GrippingSettings, HandOptions, HandScript, HeldObject, SimulatedHand,
/// };
///
/// let jar = HeldObject::cylinder(0.03, 0.05, 0.2)?;
/// let script = HandScript::default().open(0.3).hold(0.4).lift(0.03, 0.5).hold(0.2);
/// let mut hand = SimulatedHand::new(jar, FingerPlace::ring::<2>(0.05), &script, HandOptions::default())?;
/// let mut last = None;
/// GrippingHand::play(&mut hand, &GrippingSettings::default(), |sample, felt, _| last = Some((*sample, *felt)))?;
/// let (sample, felt) = last.expect("the script has samples");
/// // It hangs in the air, by its weight.
/// assert_eq!(sample.truth.table, 0.0);
/// assert!((felt.load.force().z + 0.2 * 9.81).abs() < 0.1);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct GrippingHand<const K: usize> {
    settings: GrippingSettings<K>,
    friction: [ContactFriction<f64>; K],
    tips: [TipPipeline; K],
    doubts: [Doubt; K],
    controller: HandController<f64, K, 2>,
    holds: bool,
    time_step: f64,
}

fn bad(reason: impl ToString) -> SimulationError {
    SimulationError::Hand { reason: reason.to_string() }
}

impl<const K: usize> GrippingHand<K> {
    /// For a hand, from what its sensors reported at rest: zeros and noise.
    ///
    /// # Errors
    /// [`SimulationError`] for settings out of range, or a rest too short to tare.
    pub fn new<S: SignedDistance<f64>>(
        hand: &SimulatedHand<S, K>,
        rest: &[HandSample<K>],
        settings: &GrippingSettings<K>,
    ) -> Result<Self, SimulationError> {
        let positive = [
            (settings.bandwidth, "bandwidth of the grip"),
            (settings.stiffness, "stiffness of the skin"),
            (settings.approach, "speed of approach"),
            (settings.reach, "reach of the fingers"),
            (settings.arm, "torque arm"),
        ];
        for (value, parameter) in positive {
            crate::error::positive(value, parameter)?;
        }
        let mut friction = Vec::with_capacity(K);
        for coefficient in settings.friction {
            crate::error::positive(coefficient, "friction coefficient")?;
            friction.push(ContactFriction::soft(coefficient, settings.arm).map_err(bad)?);
        }
        let sensors = &hand.options().sensors;
        let sphere = sensors.design.sphere()?;
        let (mut tips, mut doubts) = (Vec::with_capacity(K), Vec::with_capacity(K));
        for (index, matrix) in hand.calibrated_matrices().iter().enumerate() {
            let readings = rest.iter().filter_map(|sample| sample.raw.get(index));
            let solver = GaussianElimination::new(matrix).map_err(bad)?;
            let mut accumulator = DummyGaugeAccumulator::default();
            for reading in readings.clone() {
                accumulator.add(reading);
            }
            let zero = accumulator.finish().map_err(bad)?;
            let mut noise = Matrix6::zeros();
            for reading in readings {
                let left: Vector6<f64> = solver.solve(&zero.compensate(reading)).components();
                noise += left * left.transpose();
            }
            #[allow(clippy::cast_precision_loss, reason = "exact for 10^15 samples")]
            let count = rest.len() as f64;
            noise /= (count - 1.0).max(1.0);
            let deviation = noise.diagonal().fixed_rows::<3>(0).max().sqrt();
            let detector = DropDetector::new(ForceNoise::isotropic(deviation).map_err(bad)?).map_err(bad)?;
            tips.push(
                Fingertip::builder()
                    .zero(zero)
                    .solver(solver)
                    .contact(sphere, SoftFinger::new(5.0 * deviation).map_err(bad)?)
                    .slip_detector(detector)
                    .build(),
            );
            let doubt = Doubt::new(matrix, &sensors.imperfections, noise, count);
            doubts.push(doubt.ok_or_else(|| bad("a sensor matrix has no inverse"))?);
        }
        let limits = FingerLimits::none()
            .with_greatest_normal(settings.normal.1)
            .and_then(|limits| limits.with_least_normal(settings.normal.0))
            .map_err(bad)?;
        let counted = |_| bad("a finger is missing");
        Ok(Self {
            settings: *settings,
            friction: friction.try_into().map_err(|_| bad("a finger is missing"))?,
            tips: tips.try_into().map_err(counted)?,
            doubts: doubts.try_into().map_err(|_| bad("a finger is missing"))?,
            controller: HandController::new(settings.hand, [limits; K]).map_err(bad)?,
            holds: false,
            time_step: sensors.sample_rate.recip(),
        })
    }

    /// Plays the whole script of a hand: the first segment is rest, and gives the zeros; from then on every sample goes
    /// to the loop and to `each`, and what it wants to the drives.
    ///
    /// # Errors
    /// [`SimulationError`] as [`new`](Self::new).
    pub fn play<S: SignedDistance<f64>>(
        hand: &mut SimulatedHand<S, K>,
        settings: &GrippingSettings<K>,
        mut each: impl FnMut(&HandSample<K>, &Felt<K>, &Self),
    ) -> Result<Self, SimulationError> {
        let mut rest = Vec::new();
        let mut next = hand.sample();
        while let Some(sample) = next.filter(|sample| sample.phase == 0) {
            rest.push(sample);
            next = hand.sample();
        }
        let mut gripping = Self::new(hand, &rest, settings)?;
        while let Some(sample) = next {
            let felt = gripping.feel(&sample);
            each(&sample, &felt, &gripping);
            hand.drive(felt.speeds);
            next = hand.sample();
        }
        Ok(gripping)
    }

    /// What a sample says, and what to do.
    pub fn feel(&mut self, sample: &HandSample<K>) -> Felt<K> {
        let mut wrenches = [Wrench::zero(); K];
        let mut fingers = [FingerState::Free; K];
        let mut loads = [None; K];
        let each = self.tips.iter_mut().zip(&sample.raw).zip(&sample.tips).zip(&self.friction);
        let answers = wrenches.iter_mut().zip(&mut fingers).zip(&mut loads);
        for ((((tip, raw), pose), friction), ((wrench, finger), load)) in each.zip(answers) {
            let touch = tip.sense(raw, self.time_step);
            *wrench = touch.wrench;
            *load = Some(UncertainWrench {
                wrench: touch.wrench.expressed_in(pose),
                covariance: Matrix6::zeros(),
            });
            *finger = touch.finger(friction).expressed_in(pose);
        }
        let load = UncertainWrench::total(&loads).wrench;
        let touching = fingers.iter().all(|finger| finger.sample().is_some());
        self.holds = !sample.open && (self.holds || touching);
        let command =
            self.holds.then(|| self.controller.command(&fingers, &HandLoad::FromFingers, self.time_step));
        let speeds = match &command {
            Some(command) => self.squeeze(&fingers, command, &sample.closed),
            None => self.approach(&fingers, sample),
        };
        Felt { wrenches, fingers, load, command, speeds }
    }

    /// Forgets what slip has taught, as for another object.
    pub fn forget_friction(&mut self) {
        self.controller.forget_friction();
    }

    /// A weighing with all that this hand's sensors leave uncertain.
    #[must_use]
    pub fn weighing(&self) -> Weighing<K> {
        Weighing::new(self.doubts)
    }

    /// Opens, or closes what does not touch yet.
    fn approach(&self, fingers: &[FingerState<f64>; K], sample: &HandSample<K>) -> [f64; K] {
        let (speed, reach) = (self.settings.approach, self.settings.reach);
        let mut speeds = [0.0; K];
        for ((wanted, finger), closed) in speeds.iter_mut().zip(fingers).zip(sample.closed) {
            *wanted = match finger {
                _ if sample.open => -(closed / self.time_step).clamp(0.0, speed),
                FingerState::Free if closed < reach => speed,
                _ => 0.0,
            };
        }
        speeds
    }

    /// Squeezes by what the normal forces lack. A finger that is not believed stays where it is.
    fn squeeze(
        &self,
        fingers: &[FingerState<f64>; K],
        command: &HandCommand<f64, K>,
        closed: &[f64; K],
    ) -> [f64; K] {
        let believed = |finger: &FingerState<f64>, implausible: bool| -> Option<FingerSample<f64>> {
            finger.sample().filter(|_| !implausible).copied()
        };
        let mut contacts = [None; K];
        let mut lacks = [ContactForce::zero(); K];
        let each = contacts.iter_mut().zip(&mut lacks).zip(fingers);
        for (((contact, lack), finger), (wanted, implausible)) in
            each.zip(command.normal.iter().zip(command.implausible))
        {
            if let Some(finger) = believed(finger, implausible) {
                *contact = Some(finger.contact);
                *lack = ContactForce::new(wanted - finger.force.normal, Vector3::zeros(), 0.0);
            }
        }
        let parts = Grasp::new(contacts).split(&lacks);
        let gain = self.settings.bandwidth / self.settings.stiffness;
        let mut speeds = [0.0; K];
        for (((speed, finger), part), (contact, closed)) in
            speeds.iter_mut().zip(fingers).zip(&parts.internal).zip(contacts.iter().zip(closed))
        {
            *speed = match finger {
                _ if contact.is_some() => gain * part.normal,
                // It has lost the object, and goes after it.
                FingerState::Free if *closed < self.settings.reach => self.settings.approach,
                _ => 0.0,
            };
        }
        speeds
    }
}
