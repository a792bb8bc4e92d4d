//! E: scene A, its contact followed over time.

use fingertip::contact::{Continuity, Sighting, Tracked, Tracker, WrenchSpread};
use fingertip::wrench::{BicchiDario, Decoupled, SensorMatrix, WrenchCovariance};
use nalgebra::{Matrix6, Vector6};

use crate::{Felt, STEP, Scene, SceneA, Words, session};

/// Standard deviation of a signal \[V\], as the tare of the simulated electronics finds it.
const SIGNAL_NOISE: f32 = 4e-4;
/// How fast the contact moves, about \[m/s\], and how soon it may turn round \[s\].
const SPEED: f32 = 0.01;
const WITHIN: f32 = 0.1;

/// Scene A and a tracker.
pub struct SceneE {
    /// What is felt of a sample.
    pub alone: SceneA,
    /// Covariance of a wrench by the noise of the signals.
    noise: Matrix6<f32>,
    tracker: Tracker<f32>,
}

/// What is felt, and where the contact is by all samples so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Followed {
    /// What is felt of this sample.
    pub felt: Felt,
    /// 1 new, 2 followed, 3 doubted, 4 bridged; 0 without a contact that is followed, and all that follows is zero then.
    pub continuity: u32,
    /// Where \[m\].
    pub point: [f32; 3],
    /// How fast it moves \[m/s\].
    pub velocity: [f32; 3],
    /// Covariance of the position along its tangents \[m²\]: 11, 22 and 12.
    pub spread: [f32; 3],
    /// How far off the sample was, squared over its variance.
    pub surprise: f32,
}

impl Followed {
    #[inline(always)]
    fn of(felt: Felt, tracked: Option<Tracked<f32>>) -> Self {
        let Some(tracked) = tracked else { return Self { felt, ..Self::default() } };
        let continuity = match tracked.continuity {
            Continuity::New => 1,
            Continuity::Followed => 2,
            Continuity::Doubted => 3,
            Continuity::Bridged => 4,
        };
        Self {
            felt,
            continuity,
            point: tracked.point.into(),
            velocity: tracked.velocity.into(),
            spread: crate::felt::spread(&tracked.position_covariance),
            surprise: tracked.surprise,
        }
    }
}

impl Words for Followed {
    fn words(&self, mut visit: impl FnMut(u32)) {
        self.felt.words(&mut visit);
        visit(self.continuity);
        let numbers = self.point.iter().chain(&self.velocity).chain(&self.spread);
        numbers.chain([&self.surprise]).for_each(|x| visit(x.to_bits()));
    }
}

impl Scene<6> for SceneE {
    const NAME: &'static str = "e";
    type Answer = Followed;

    fn session() -> &'static [[u16; 6]] {
        &session::A
    }

    fn sensor() -> Option<SensorMatrix<f32, 6>> {
        SceneA::sensor()
    }

    fn new() -> Option<Self> {
        let sensor = Self::sensor()?;
        let solver = Decoupled::<f32, BicchiDario, 6>::new(&sensor).ok()?;
        let noise = WrenchCovariance::from_noise(&sensor, &solver, &Vector6::repeat(SIGNAL_NOISE)).ok()?;
        let tracker = Tracker::new(SPEED, WITHIN).ok()?;
        Some(Self { alone: SceneA::new()?, noise: *noise.floor(), tracker })
    }

    #[inline(always)]
    fn sense(&mut self, volts: &Vector6<f32>) -> Followed {
        let touch = self.alone.fingertip.sense(volts, STEP);
        let contact = touch.resolution.contact();
        let sighting = contact.and_then(|contact| {
            Sighting::of_point_contact(contact, &touch.wrench, WrenchSpread::Full(&self.noise))
        });
        let surface = self.alone.fingertip.surface();
        let tracked = self.tracker.follow(surface, sighting.as_ref(), STEP);
        Followed::of(Felt::of(&touch), tracked)
    }
}
