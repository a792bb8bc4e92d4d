//! A: decoupled solver, sphere, Coulomb friction, ratio threshold.

use fingertip::contact::PointContact;
use fingertip::friction::{Coulomb, NormalForceGate, RatioThreshold};
use fingertip::surfaces::Sphere;
use fingertip::wrench::{BicchiDario, Decoupled, SensorMatrix, Tare};
use fingertip::{Fingertip, Present};
use nalgebra::Vector6;

use crate::{FRICTION, Felt, LEAST_FORCE, STEP, Scene, noise, sensor, session};

/// The least: the paper's six gauges and sphere.
pub struct SceneA {
    /// All its stages.
    pub fingertip: Fingertip<
        Decoupled<f32, BicchiDario, 6>,
        Sphere<f32>,
        PointContact<f32>,
        Present<Coulomb<f32>>,
        Present<RatioThreshold<f32>>,
        Tare<f32, 6>,
    >,
}

impl Scene<6> for SceneA {
    const NAME: &'static str = "a";
    type Answer = Felt;

    fn session() -> &'static [[u16; 6]] {
        &session::A
    }

    fn sensor() -> Option<SensorMatrix<f32, 6>> {
        sensor(&session::PAPER)
    }

    fn new() -> Option<Self> {
        let gate = NormalForceGate::from_noise(&noise()?);
        let fingertip = Fingertip::builder()
            .zero(Self::tare()?)
            .solver(Decoupled::new(&Self::sensor()?).ok()?)
            .contact(Sphere::centred(13e-3).ok()?, PointContact::new(LEAST_FORCE).ok()?)
            .friction(Coulomb::new(FRICTION).ok()?)
            .slip_detector(RatioThreshold::new(gate, FRICTION).ok()?.with_warning_share(0.75).ok()?)
            .build();
        Some(Self { fingertip })
    }

    #[inline(always)]
    fn sense(&mut self, volts: &Vector6<f32>) -> Felt {
        Felt::of(&self.fingertip.sense(volts, STEP))
    }
}
