//! The simulated hand: fingertips, an object, and what else there is, step by step.

use fingertip_hand::Hand;
use fingertip_surfaces::SignedDistance;
use fingertip_wrench::{ContactForce, Frame, GaugesAndDummy, RigidTransform, Sensor, SensorMatrix, Wrench};
use nalgebra::{UnitQuaternion, Vector3, Vector6};

use super::body::RigidBody;
use super::finger::{Finger, FingerPlace};
use super::object::HeldObject;
use super::script::{HandMotion, HandScript, HandSegment, HandTimeline};
use super::skin::SkinSettings;
use super::surroundings::{OtherHand, Table};
use crate::error::{SimulationError, positive};
use crate::fingertip::Options;

/// The frame in which the world stands still: that of the hand and of the object at the start.
///
/// ```
/// use fingertip_simulation::hand::World;
/// use fingertip_wrench::Frame;
///
/// assert_eq!(World::NAME, "world");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct World;

impl Frame for World {
    const NAME: &'static str = "world";
}

/// Everything that can be chosen about a simulated hand.
///
/// ```
/// use fingertip_simulation::hand::{HandOptions, SkinSettings};
///
/// let mut options = HandOptions::<3>::default();
/// options.skins[2] = SkinSettings { static_friction: 0.3, ..SkinSettings::default() };
/// assert_eq!(options.gravity.z, -9.81);
/// assert_eq!(options.skins[0], SkinSettings::default());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandOptions<const K: usize> {
    /// The sensors, all of one kind: the seed of each is drawn from this one's.
    pub sensors: Options,
    /// The skin and the friction of each fingertip on the object.
    pub skins: [SkinSettings; K],
    /// Gravity \[m/s²\]: 9.81 downwards.
    pub gravity: Vector3<f64>,
    /// Time constant with which the drives follow \[s\]: 2 ms.
    pub drive_lag: f64,
    /// Steps of the bodies in a sample: 20, of 50 µs at 1 kHz. The stiffest thing, a light object (20 g) on a table and
    /// in a firm grip, swings with 0.6 ms/rad.
    pub steps: u32,
}

impl<const K: usize> Default for HandOptions<K> {
    fn default() -> Self {
        Self {
            sensors: Options::default(),
            skins: [SkinSettings::default(); K],
            gravity: Vector3::new(0.0, 0.0, -9.81),
            drive_lag: 2e-3,
            steps: 20,
        }
    }
}

/// What the hand's electronics know in a sample, and what was really so.
///
/// ```
/// use fingertip_simulation::hand::{FingerPlace, HandOptions, HandScript, HeldObject, SimulatedHand};
///
/// let jar = HeldObject::cylinder(0.03, 0.05, 0.2)?;
/// let script = HandScript::default().open(0.1);
/// let mut hand = SimulatedHand::new(jar, FingerPlace::ring::<2>(0.05), &script, HandOptions::default())?;
/// let first = hand.sample().expect("the script is not over");
/// // It is read at 1 kHz, and the fingers stand on a ring of 5 cm around the jar.
/// let second = hand.sample().expect("the script is not over");
/// assert!((second.time - first.time - 1e-3).abs() < 1e-12 && first.open);
/// assert!((first.tips[0].origin() - first.tips[1].origin()).norm() > 0.09);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HandSample<const K: usize> {
    /// Time \[s\].
    pub time: f64,
    /// What each sensor reports \[V\].
    pub raw: [GaugesAndDummy<f64, 6>; K],
    /// Where each fingertip is in the hand, from its joints.
    pub tips: [RigidTransform<f64, Hand, Sensor>; K],
    /// How far each finger has closed \[m\], from its joints.
    pub closed: [f64; K],
    /// Gravity less the acceleration of the hand, in its frame \[m/s²\].
    pub gravity: Vector3<f64>,
    /// Whether the script has the fingers open.
    pub open: bool,
    /// Index of the segment of the script.
    pub phase: usize,
    /// What was really so.
    pub truth: HandTruth<K>,
}

/// What was really so when a sample was taken.
///
/// ```
/// use fingertip_simulation::hand::{FingerPlace, HandOptions, HandScript, HeldObject, SimulatedHand};
///
/// let jar = HeldObject::cylinder(0.03, 0.05, 0.2)?;
/// let script = HandScript::default().open(0.1);
/// let mut hand = SimulatedHand::new(jar, FingerPlace::ring::<2>(0.05), &script, HandOptions::default())?;
/// let truth = hand.sample().expect("the script is not over").truth;
/// // The jar of 0.2 kg has not been touched, and nothing is on the fingertips.
/// assert!((truth.mass - 0.2).abs() < 1e-12);
/// assert!(truth.contacts.iter().all(Option::is_none) && truth.slipping == [false; 2]);
/// assert!(truth.wrenches[0].force().norm() < 1e-12);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct HandTruth<const K: usize> {
    /// The load on each fingertip.
    pub wrenches: [Wrench<f64>; K],
    /// The contact of each fingertip; `None` where it touches nothing.
    pub contacts: [Option<TrueTouch>; K],
    /// Whether each contact slides.
    pub slipping: [bool; K],
    /// The mass of the object \[kg\].
    pub mass: f64,
    /// Its centre of mass in the frame of the hand \[m\].
    pub centre: Vector3<f64>,
    /// Where its origin is in the frame of the hand \[m\].
    pub origin: Vector3<f64>,
    /// How it is turned in the frame of the hand.
    pub attitude: UnitQuaternion<f64>,
    /// With what force the table bears it \[N\].
    pub table: f64,
    /// Momentum \[kg·m/s\] and angular momentum about the centre of mass \[kg·m²/s\], in the world.
    pub momenta: (Vector3<f64>, Vector3<f64>),
    /// Kinetic energy, height, and what skin and bristles hold \[J\].
    pub energy: f64,
}

/// The contact of a fingertip as it is, in the frame of its sensor.
///
/// ```
/// use fingertip_simulation::hand::{FingerPlace, HandOptions, HandScript, HeldObject, SimulatedHand};
///
/// let jar = HeldObject::cylinder(0.03, 0.05, 0.2)?;
/// let script = HandScript::default().open(0.01).hold(0.3);
/// let mut hand = SimulatedHand::new(jar, FingerPlace::ring::<2>(0.05), &script, HandOptions::default())?;
/// // The fingers close at 5 cm/s until the first touches.
/// let touch = loop {
///     let sample = hand.sample().expect("the script is not over");
///     hand.drive([0.05; 2]);
///     if let Some(touch) = sample.truth.contacts[0] {
///         break touch;
///     }
/// };
/// // It touches with the sphere of the fingertip, and presses.
/// let radius = hand.options().sensors.design.sphere()?.radius();
/// assert!((touch.point.norm() - radius).abs() < 1e-4 && touch.force.normal > 0.0);
/// assert!((touch.normal - touch.point.normalize()).norm() < 1e-9);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueTouch {
    /// Where \[m\].
    pub point: Vector3<f64>,
    /// The outward unit normal of the fingertip there.
    pub normal: Vector3<f64>,
    /// The force on the fingertip.
    pub force: ContactForce<f64>,
}

/// Fingertips on one object: gives samples, takes speeds.
///
/// Momenta change before places (semi-implicit Euler) in [`HandOptions::steps`] steps a sample; the forces of skin and
/// bristles are those of the start of a step.
///
/// ```
/// use fingertip_simulation::hand::{FingerPlace, HandOptions, HandScript, HeldObject, SimulatedHand};
///
/// let jar = HeldObject::cylinder(0.03, 0.05, 0.2)?;
/// let script = HandScript::default().open(0.1);
/// let mut hand = SimulatedHand::new(jar, FingerPlace::ring::<2>(0.05), &script, HandOptions::default())?;
/// let mut sample = hand.sample().expect("the script is not over");
/// while let Some(next) = hand.sample() {
///     sample = next;
///     hand.drive([0.05; 2]);
/// }
/// // 99 ms at 5 cm/s: 5 mm less the lag of the drives. It stands on the table.
/// assert!((sample.closed[0] - 4.8e-3).abs() < 1e-4);
/// assert!((sample.truth.table - 0.2 * 9.81).abs() < 0.05);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SimulatedHand<Shape, const K: usize> {
    options: HandOptions<K>,
    shape: Shape,
    fingers: [Finger; K],
    body: RigidBody,
    table: Table,
    other: OtherHand,
    timeline: HandTimeline,
    samples: u32,
}

impl<Shape: SignedDistance<f64>, const K: usize> SimulatedHand<Shape, K> {
    /// The object stands on a table with its origin at that of the hand, the fingers are open.
    ///
    /// # Errors
    /// [`SimulationError`] for parameters out of range, a script that cannot be played, or fingers that touch the
    /// object while they are open.
    pub fn new(
        object: HeldObject<Shape>,
        fingers: [FingerPlace; K],
        script: &HandScript,
        options: HandOptions<K>,
    ) -> Result<Self, SimulationError> {
        let bad = |parameter, requirement| SimulationError::BadParameter { parameter, requirement };
        positive(options.sensors.sample_rate, "sample rate")?;
        positive(options.drive_lag, "lag of the drives")?;
        if options.steps == 0 {
            return Err(bad("number of steps in a sample", "at least 1"));
        }
        if !options.gravity.iter().all(|x| x.is_finite()) {
            return Err(bad("gravity", "finite"));
        }
        if !(script.duration() * options.sensors.sample_rate < f64::from(u32::MAX)) {
            return Err(bad("length of the script", "less than 2³² samples"));
        }
        let HeldObject { shape, made_of, feet } = object;
        let radius = options.sensors.design.sphere()?.radius();
        if fingers.iter().any(|finger| !(shape.signed_distance(&finger.tip().origin()).distance > radius)) {
            return Err(bad("place of a finger", "clear of the object while it is open"));
        }
        let mut built = Vec::with_capacity(K);
        for ((index, place), skin) in (1_u64..).zip(fingers).zip(options.skins) {
            let seed = options.sensors.seed.wrapping_mul(1_000_003).wrapping_add(index);
            built.push(Finger::new(place, skin, Options { seed, ..options.sensors })?);
        }
        let fingers = built.try_into().map_err(|_| bad("number of fingers", "the one stated"))?;
        let timeline = HandTimeline::new(script, made_of)?;
        let table = Table::below(&feet)?;
        let body = RigidBody::at_rest(made_of, Vector3::zeros());
        let other = OtherHand::default();
        Ok(Self { options, shape, fingers, body, table, other, timeline, samples: 0 })
    }

    /// What was chosen.
    #[must_use]
    pub const fn options(&self) -> &HandOptions<K> {
        &self.options
    }

    /// The segments of the script, each with its start \[s\].
    pub fn phases(&self) -> impl Iterator<Item = (HandSegment, f64)> {
        self.timeline.phases()
    }

    /// How long the script takes \[s\].
    #[must_use]
    pub const fn duration(&self) -> f64 {
        self.timeline.end()
    }

    /// The sensor matrices \[V\] as calibrations found them: what a user of the hand has.
    #[must_use]
    pub fn calibrated_matrices(&self) -> [SensorMatrix<f64, 6>; K] {
        self.fingers.each_ref().map(|finger| *finger.sensor.calibrated_matrix())
    }

    /// At what speed each finger closes \[m/s\] from now on.
    pub fn drive(&mut self, speeds: [f64; K]) {
        for (finger, speed) in self.fingers.iter_mut().zip(speeds) {
            finger.drive(speed);
        }
    }

    /// The bodies move on by a sample, and the sensors are read; `None` at the end of the script.
    pub fn sample(&mut self) -> Option<HandSample<K>> {
        let period = self.options.sensors.sample_rate.recip();
        let time = f64::from(self.samples) * period;
        // Half a step of the end is the end: times are not exact.
        if time > self.timeline.end() - 0.5 * period {
            return None;
        }
        if self.samples > 0 {
            let step = period / f64::from(self.options.steps);
            for index in 0..self.options.steps {
                self.step(time - period + f64::from(index) * step, step);
            }
        }
        self.samples += 1;
        let now = self.timeline.at(time);
        let raw = self.fingers.each_mut().map(|finger| {
            let felt = finger.felt;
            let [v1, v2, v3, v4, v5, v6, dummy] = finger.sensor.convert(&felt).raw.into();
            GaugesAndDummy { gauges: Vector6::new(v1, v2, v3, v4, v5, v6), dummy }
        });
        Some(HandSample {
            time,
            raw,
            tips: self.fingers.each_ref().map(Finger::tip),
            closed: self.fingers.each_ref().map(|finger| finger.closed),
            gravity: now
                .motion
                .attitude
                .inverse_transform_vector(&(self.options.gravity - now.motion.acceleration)),
            open: now.open,
            phase: now.phase,
            truth: self.truth(&now.motion),
        })
    }

    fn step(&mut self, time: f64, time_step: f64) {
        let now = self.timeline.at(time);
        self.body.set_made_of(now.object);
        let centre = self.body.centre();
        let weight = self.options.gravity * self.body.mass();
        let (mut force, mut torque) = (weight, Vector3::zeros());
        for finger in &mut self.fingers {
            finger.advance(self.options.drive_lag, time_step);
            if let Some(on) = finger.touch(&self.shape, &self.body, &now.motion, time_step) {
                force += on.force;
                torque += (on.at - centre).cross(&on.force) + on.torque;
            }
        }
        if let Some((push, at)) = now.push {
            force += push;
            torque += (self.body.place(&at) - centre).cross(&push);
        }
        for (f, t) in [self.table.step(&self.body, time_step), self.other.act(&self.body, &weight, now.taken)]
        {
            force += f;
            torque += t;
        }
        self.body.step(&force, &torque, time_step);
    }

    fn truth(&self, hand: &HandMotion) -> HandTruth<K> {
        let into_hand = |place: Vector3<f64>| hand.attitude.inverse_transform_vector(&(place - hand.origin));
        let stored: f64 = self.fingers.iter().map(Finger::energy).sum();
        let height = -self.body.mass() * self.options.gravity.dot(&self.body.centre());
        HandTruth {
            wrenches: self.fingers.each_ref().map(|finger| finger.felt),
            contacts: self.fingers.each_ref().map(|finger| {
                let (contact, _) = finger.contact?;
                let (point, normal) = (contact.point, contact.normal);
                Some(TrueTouch { point, normal, force: finger.contact_force()? })
            }),
            slipping: self.fingers.each_ref().map(Finger::slipping),
            mass: self.body.mass(),
            centre: into_hand(self.body.centre()),
            origin: into_hand(self.body.origin()),
            attitude: hand.attitude.inverse() * self.body.attitude(),
            table: self.table.bears,
            momenta: (self.body.momentum(), self.body.spin()),
            energy: self.body.kinetic_energy() + height + stored + self.table.energy(),
        }
    }
}
