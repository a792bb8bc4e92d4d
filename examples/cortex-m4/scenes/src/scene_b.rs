//! B: Gaussian elimination, ellipsoid, soft finger, limit surface, ratio threshold.

use fingertip::contact::SoftFinger;
use fingertip::friction::{NormalForceGate, RatioThreshold, SoftFingerLimit};
use fingertip::surfaces::Ellipsoid;
use fingertip::wrench::{GaussianElimination, SensorMatrix, Tare};
use fingertip::{Fingertip, Present};
use nalgebra::{Vector3, Vector6};

use crate::{FRICTION, Felt, LEAST_FORCE, STEP, Scene, noise, sensor, session};

/// A soft ellipsoid: any six gauges, spin torque, an elliptic limit surface.
pub struct SceneB {
    fingertip: Fingertip<
        GaussianElimination<f32>,
        Ellipsoid<f32>,
        SoftFinger<f32>,
        Present<SoftFingerLimit<f32>>,
        Present<RatioThreshold<f32>>,
        Tare<f32, 6>,
    >,
}

impl Scene<6> for SceneB {
    const NAME: &'static str = "b";
    type Answer = Felt;

    fn session() -> &'static [[u16; 6]] {
        &session::B
    }

    fn sensor() -> Option<SensorMatrix<f32, 6>> {
        sensor(&session::SIX)
    }

    fn new() -> Option<Self> {
        let gate = NormalForceGate::from_noise(&noise()?);
        let fingertip = Fingertip::builder()
            .zero(Self::tare()?)
            .solver(GaussianElimination::new(&Self::sensor()?).ok()?)
            .contact(
                Ellipsoid::new(Vector3::new(14e-3, 11e-3, 9e-3)).ok()?,
                SoftFinger::new(LEAST_FORCE).ok()?,
            )
            .friction(SoftFingerLimit::new(FRICTION, 2e-3).ok()?)
            .slip_detector(RatioThreshold::new(gate, FRICTION).ok()?.with_warning_share(0.75).ok()?)
            .build();
        Some(Self { fingertip })
    }

    #[inline(always)]
    fn sense(&mut self, volts: &Vector6<f32>) -> Felt {
        Felt::of(&self.fingertip.sense(volts, STEP))
    }
}
