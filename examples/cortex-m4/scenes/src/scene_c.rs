//! C: eight gauges, capsule, covariance of the contact, cumulative sum of the drop.

use fingertip::contact::{ContactCovariance, PointContact};
use fingertip::friction::{Coulomb, DropDetector};
use fingertip::surfaces::Capsule;
use fingertip::wrench::{LeastSquares, SensorMatrix, Tare, WrenchCovariance};
use fingertip::{Fingertip, Present};
use nalgebra::{SVector, Vector3};

use crate::felt::spread;
use crate::{FRICTION, Felt, LEAST_FORCE, STEP, Scene, Spread, Words, noise, sensor, session};

/// Standard deviation of a signal \[V\], as the tare of the simulated electronics finds it.
const SIGNAL_NOISE: f32 = 4e-4;

/// Redundant gauges, and how far the contact may be off.
pub struct SceneC {
    fingertip: Fingertip<
        LeastSquares<f32, 8>,
        Capsule<f32>,
        PointContact<f32>,
        Present<Coulomb<f32>>,
        Present<DropDetector<f32>>,
        Tare<f32, 8>,
    >,
    noise: WrenchCovariance<f32, 8>,
}

/// What is felt and how sure that is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Estimate {
    /// What is felt.
    pub felt: Felt,
    /// How sure the position is.
    pub spread: Spread,
}

impl Words for Estimate {
    fn words(&self, mut visit: impl FnMut(u32)) {
        self.felt.words(&mut visit);
        self.spread.iter().for_each(|x| visit(x.to_bits()));
    }
}

impl Scene<8> for SceneC {
    const NAME: &'static str = "c";
    type Answer = Estimate;

    fn session() -> &'static [[u16; 8]] {
        &session::C
    }

    fn sensor() -> Option<SensorMatrix<f32, 8>> {
        sensor(&session::EIGHT)
    }

    fn new() -> Option<Self> {
        let sensor = Self::sensor()?;
        let solver = LeastSquares::new(&sensor).ok()?;
        let noise_of_wrench =
            WrenchCovariance::from_noise(&sensor, &solver, &SVector::repeat(SIGNAL_NOISE)).ok()?;
        let fingertip = Fingertip::builder()
            .zero(Self::tare()?)
            .solver(solver)
            .contact(
                Capsule::new(Vector3::zeros(), Vector3::x(), 9e-3, 4e-3).ok()?,
                PointContact::new(LEAST_FORCE).ok()?,
            )
            .friction(Coulomb::new(FRICTION).ok()?)
            .slip_detector(DropDetector::new(noise()?).ok()?)
            .build();
        Some(Self { fingertip, noise: noise_of_wrench })
    }

    #[inline(always)]
    fn sense(&mut self, volts: &SVector<f32, 8>) -> Estimate {
        let touch = self.fingertip.sense(volts, STEP);
        let spread = touch.resolution.contact().and_then(|contact| {
            let covariance =
                ContactCovariance::point_contact_position(contact, &touch.wrench, self.noise.floor())?;
            Some(spread(&covariance))
        });
        Estimate { felt: Felt::of(&touch), spread: spread.unwrap_or_default() }
    }
}
