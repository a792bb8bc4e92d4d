//! The scene of the simulated fingertip.

use core::error::Error;

use fingertip_scene::Scene;
use fingertip_simulation::{Options, Segment, SimulatedFingertip, standard_session};

use crate::error::CliError;

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
    let (sphere, rim) = (simulated.sphere(), simulated.options().design.greatest_angle());
    let coefficient = least_static_coefficient(&simulated).ok_or("the session has no drag")?;
    let [x, y, z]: [f64; 3] = sphere.centre().into();
    let text = format!(
        "version = 2\nname = \"simulated fingertip\"\n[input]\nconvention = \"on_fingertip\"\n\
         [surface]\nshape = \"sphere\"\ncentre_m = [{x:?}, {y:?}, {z:?}]\nradius_m = {radius:?}\n\
         pole = [1.0, 0.0, 0.0]\nactive_half_angle_deg = {rim:?}\n[contact]\nleast_force_N = {LEAST_FORCE:?}\n\
         [friction]\nstatic_coefficient = {coefficient:?}\n[slip]\ndetector = \"drop\"\nnoise_N = {NOISE:?}\n",
        radius = sphere.radius(),
        rim = rim.to_degrees(),
    );
    Ok(Scene::from_text(&text)?)
}

/// The friction coefficient that is safe for every drag of the script.
pub(crate) fn least_static_coefficient(simulated: &SimulatedFingertip) -> Option<f64> {
    let drags = simulated.phases().iter().filter_map(|phase| match phase.segment {
        Segment::Drag { static_coefficient, .. } => Some(static_coefficient),
        _ => None,
    });
    drags.min_by(f64::total_cmp)
}
