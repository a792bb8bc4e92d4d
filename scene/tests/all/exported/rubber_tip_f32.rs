// rubber tip: a fingertip as a type, in f32.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
//   surface      sphere, a sphere, or a part of it around a pole; pole = [1.0, 0.0, 0.0], radius_m = 0.013
//   contact      point, a contact transmits a force and no torque of its own; least_force_N = 0.1
//   contact.skin hertz, an elastic body with the same curvature everywhere; poisson_ratios = [0.49, 0.3],
//                radii_m = [0.013, 0.013], young_moduli_Pa = [1500000.0, inf]
//   friction     uncertain, a coefficient with a standard deviation; deviation = 0.05, noise_N = 0.01,
//                static_coefficient = 0.5
//   slip         likelihood_ratio, the friction ratio falls, suddenly or not; false_alarms_per_minute = 0.1,
//                noise_N = 0.01
//   estimate     noise_N = 0.01
//   grip         fall_N_per_s = 2.0, greatest_N = 20.0, least_N = 0.2, rise_N_per_s = 100.0
//
// It needs neither heap nor standard library, and in Cargo.toml:
//
//   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction", "skin"] }
//
// With a standard library, "std" in the place of "libm".
//
// Once, and then for each sample, `time_step` seconds after the one before:
//
//     let (mut tip, mut last) = (tip()?, None);
//
//     let step = fingertip::Step::of(time_step).with_last(last);
//     let touch = tip.sense_wrench(load(force, torque), step);
//     last = touch.point();
//
// After a pause, `last = None` and `friction::SlipDetector::<f32>::reset(&mut tip.detector_mut().0)`.
//
// With `let model = friction_model()?`, the probability that the contact slips is
//     model.slip_probability(&force)
//
// With `let (mut at_rest, mut sliding) = (static_friction()?, kinetic_friction()?)`
// and `let mut left = 0.0`, the friction is learnt by
//     let slips = touch.slip == friction::SlipVerdict::Slipping;
//     left = if slips { SLIDE_S } else { left - time_step };
//     match &touch.force {
//         Some(force) if left > 0.0 => {
//             if slips {
//                 let _ = at_rest.onset();
//             }
//             sliding.observe(force, time_step);
//         }
//         Some(force) => at_rest.observe(force),
//         None => left = 0.0,
//     }
// and told by `at_rest.estimate()` and `sliding.estimate()`.
//
// With `let mut grip = grip()?`, the normal force to command next [N] is
//     match &touch.force {
//         Some(force) => grip.command(&tip.friction().0, force, touch.slip, time_step),
//         None => grip.present(),
//     }

use fingertip::nalgebra::Vector3;
use fingertip::{Absent, Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::Sphere<f32>,
    contact::Compliant<f32, contact::PointContact<f32>, contact::Hertz<f32>>,
    Present<friction::Coulomb<f32>>,
    Present<friction::LikelihoodRatioDetector<f32, 32>>,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
    let model = contact::Compliant::new(
        contact::PointContact::new(0.1)?,
        contact::Hertz::new(
            [0.013, 0.013],
            contact::contact_modulus([1500000.0, f32::INFINITY], [0.49, 0.3])?,
        )?,
    );
    Ok(Fingertip::builder()
        .contact(surface, model)
        .friction(friction::Coulomb::new(0.3836826)?)
        .slip_detector(
            friction::LikelihoodRatioDetector::with_ratio(
                friction::ForceNoise::isotropic(0.01)?,
                friction::LikelihoodRatio::new(12.729563)?,
            )?,
        )
        .build())
}

/// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
pub fn load(force: Vector3<f32>, torque: Vector3<f32>) -> wrench::Wrench<f32> {
    wrench::Wrench::on_fingertip(force, torque)
}

/// What is known of the friction: `slip_probability` of a contact's force.
///
/// # Errors
/// Never for the numbers below.
pub fn friction_model() -> Result<friction::UncertainCoulomb<f32>, BadTip> {
    Ok(friction::UncertainCoulomb::new(0.5, 0.05, Some(friction::ForceNoise::isotropic(0.01)?))?)
}

/// For so long after a slip begins the fingertip is taken to slide [s].
pub const SLIDE_S: f32 = 0.05;

/// Learns the static friction from the peak before each slip.
///
/// # Errors
/// Never for the numbers below.
pub fn static_friction() -> Result<friction::StaticFriction<f32>, BadTip> {
    Ok(friction::StaticFriction::new(friction::ForceNoise::isotropic(0.01)?, 0.05, 0.01)?)
}

/// Learns the kinetic friction while the fingertip slides.
///
/// # Errors
/// Never for the numbers below.
pub fn kinetic_friction() -> Result<friction::KineticFriction<f32>, BadTip> {
    Ok(friction::KineticFriction::new(friction::ForceNoise::isotropic(0.01)?, 0.1)?)
}

/// What commands the grip.
///
/// # Errors
/// Never for the numbers below.
pub fn grip() -> Result<friction::GripController<f32>, BadTip> {
    Ok(friction::GripController::new(friction::GripSettings {
        safety: 1.5,
        least: 0.2,
        greatest: 20.0,
        rise: 100.0,
        fall: 2.0,
        slip_boost: 1.25,
    })?)
}

/// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
#[derive(Clone, Debug, PartialEq)]
pub enum BadTip {
    /// A shape, a contact model or an uncertainty.
    Shape(surfaces::BadShape),
    /// A friction, a detector or a grip.
    Friction(friction::BadParameter),
}

impl core::fmt::Display for BadTip {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Shape(bad) => bad.fmt(f),
            Self::Friction(bad) => bad.fmt(f),
        }
    }
}

impl core::error::Error for BadTip {}

impl From<surfaces::BadShape> for BadTip {
    fn from(bad: surfaces::BadShape) -> Self {
        Self::Shape(bad)
    }
}

impl From<friction::BadParameter> for BadTip {
    fn from(bad: friction::BadParameter) -> Self {
        Self::Friction(bad)
    }
}
