//! The scene of the simulated fingertip.

use core::error::Error;

use fingertip::contact::PointContact;
use fingertip::friction::{Coulomb, DropDetector, ForceNoise};
use fingertip::surfaces::SphericalCap;
use fingertip_simulation::{Options, Segment, SimulatedFingertip, standard_session};
use nalgebra::Vector3;

use super::{Convention, Friction, Scene, SlipWatch};
use crate::error::CliError;
use crate::shape::{Projection, Shape};

/// The paper's threshold of contact \[N\].
const LEAST_FORCE: f64 = 0.1;
/// Noise of a force component \[N\].
const NOISE: f64 = 0.02;

/// The sphere on its beam, with the friction that is safe for every drag of the session.
pub(super) fn scene() -> Result<Scene, CliError> {
    build().map_err(|error| CliError::Simulate { message: error.to_string() })
}

fn build() -> Result<Scene, Box<dyn Error>> {
    let simulated = SimulatedFingertip::new(&standard_session(), Options::default())?;
    let (sphere, pole) = (simulated.sphere(), Vector3::x());
    let rim = simulated.options().design.greatest_angle();
    let frame = [Vector3::x(), Vector3::y(), Vector3::z()];
    let coefficient = least_static_coefficient(&simulated).ok_or("the session has no drag")?;
    let noise = ForceNoise::isotropic(NOISE)?;
    Ok(Scene {
        name: "simulated fingertip".to_owned(),
        convention: Convention::OnFingertip,
        sensor: None,
        sample_rate: None,
        rest: None,
        shape: Shape::Sphere(SphericalCap::new(sphere, pole, rim.cos())?),
        projection: Projection::sphere(sphere.centre(), pole, Some(rim), &frame),
        model: PointContact::new(LEAST_FORCE)?,
        friction: Friction::known(Coulomb::new(coefficient)?),
        slip: SlipWatch::falls(DropDetector::new(noise)?),
    })
}

/// The friction coefficient that is safe for every drag of the script.
pub(crate) fn least_static_coefficient(simulated: &SimulatedFingertip) -> Option<f64> {
    let drags = simulated.phases().iter().filter_map(|phase| match phase.segment {
        Segment::Drag { static_coefficient, .. } => Some(static_coefficient),
        _ => None,
    });
    drags.min_by(f64::total_cmp)
}
