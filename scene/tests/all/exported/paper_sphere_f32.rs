// Sphere of Bicchi & Dario 1987: a fingertip as a type, in f32.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip", rest_s = 1.0, sample_rate_Hz = 1000.0
//   surface      sphere, a sphere, or a part of it around a pole; active_half_angle_deg = 147.4, pole = [1.0,
//                0.0, 0.0], radius_m = 0.013
//   contact      least_force_N = 0.1
//   friction     coulomb, one coefficient in all directions; static_coefficient = 0.6
//   slip         drop, the friction ratio falls suddenly; noise_N = 0.01
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
// The sensor is unloaded for 1.0 s at the start: the mean of force and torque there is to be taken off both.
//
// After a pause, `last = None` and `friction::SlipDetector::<f32>::reset(&mut tip.detector_mut().0)`.

use fingertip::nalgebra::Vector3;
use fingertip::{Absent, Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::SphericalCap<f32>,
    contact::PointContact<f32>,
    Present<friction::Coulomb<f32>>,
    Present<friction::DropDetector<f32>>,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::SphericalCap::new(
        surfaces::Sphere::new(Vector3::zeros(), 0.013)?,
        Vector3::x(),
        -0.8424523,
    )?;
    let model = contact::PointContact::new(0.1)?;
    Ok(Fingertip::builder()
        .contact(surface, model)
        .friction(friction::Coulomb::new(0.6)?)
        .slip_detector(friction::DropDetector::new(friction::ForceNoise::isotropic(0.01)?)?)
        .build())
}

/// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
pub fn load(force: Vector3<f32>, torque: Vector3<f32>) -> wrench::Wrench<f32> {
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
