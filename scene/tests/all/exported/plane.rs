// Flat pad: a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
//   surface      plane, a plane; normal = [0.0, 0.0, 1.0], point_m = [0.0, 0.0, 0.005]
//   contact      least_force_N = 0.2
//   friction     coulomb, one coefficient in all directions; static_coefficient = 0.5
//   slip         threshold, the friction ratio passes the coefficient of [friction]; noise_N = 0.01,
//                warning_share = 0.8
//
// It needs neither heap nor standard library, and in Cargo.toml:
//
//   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
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
// After a pause, `last = None` and `friction::SlipDetector::<f64>::reset(&mut tip.detector_mut().0)`.

use fingertip::nalgebra::Vector3;
use fingertip::{Absent, Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::Plane<f64>,
    contact::PointContact<f64>,
    Present<friction::Coulomb<f64>>,
    Present<friction::RatioThreshold<f64>>,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Plane::new(Vector3::new(0.0, 0.0, 0.005), Vector3::z())?;
    let model = contact::PointContact::new(0.2)?;
    Ok(Fingertip::builder()
        .contact(surface, model)
        .friction(friction::Coulomb::new(0.5)?)
        .slip_detector(
            friction::RatioThreshold::new(
                friction::NormalForceGate::from_noise(&friction::ForceNoise::isotropic(0.01)?),
                0.5,
            )?.with_warning_share(0.8)?,
        )
        .build())
}

/// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
    wrench::Wrench::on_fingertip(force, torque)
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
