// ball gripped on two sides: a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip", sample_rate_Hz = 200.0
//   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
//   contact      point, a contact transmits a force and no torque of its own; least_force_N = 0.1
//   uncertainty  force_noise_N = 0.01, torque_noise_Nm = 0.0001
//   fusion       normal_deviation_N = 0.05, places = 2, position_deviation_m = 0.001, relative_deviation =
//                0.1
//   friction     coulomb, one coefficient in all directions; static_coefficient = 0.6
//
// It needs neither heap nor standard library, and in Cargo.toml:
//
//   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction", "fusion"] }
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
// With `let noise = wrench_noise()?`, the covariance of the contact is
//     covariance(&tip, &touch, &noise)
// whose `ellipse(0.95)` is that of the scene.
//
// With `let noise = wrench_noise()?`, wrench and array together are
//     fused(&tip, &touch, &noise, &[(centroid, normal_force)])

use fingertip::nalgebra::{Matrix3, Vector3, Vector6};
use fingertip::{Absent, Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::Sphere<f64>,
    contact::PointContact<f64>,
    Present<friction::Coulomb<f64>>,
    Absent,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
    let model = contact::PointContact::new(0.1)?;
    Ok(Fingertip::builder()
        .contact(surface, model)
        .friction(friction::Coulomb::new(0.6)?)
        .build())
}

/// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
    wrench::Wrench::on_fingertip(force, torque)
}

/// How sure a wrench is: standard deviations at rest, and relative ones under load.
///
/// # Errors
/// Never for the numbers below.
pub fn wrench_noise() -> Result<contact::WrenchNoise<f64>, BadTip> {
    let noise = contact::WrenchNoise::new(Vector6::from([0.01, 0.01, 0.01, 0.0001, 0.0001, 0.0001]), 0.0)?;
    Ok(noise)
}

/// How sure the contact of a sample is; `None` without one, and where that cannot be said, as at grazing.
pub fn covariance<Reading, Verdict>(
    tip: &Tip,
    touch: &fingertip::Touch<f64, Reading, Verdict>,
    noise: &contact::WrenchNoise<f64>,
) -> Option<contact::ContactCovariance<f64>> {
    let surface = tip.surface();
    let found = touch.resolution.contact()?;
    let jacobian = contact::ContactJacobian::of_point_contact(
        found,
        &touch.wrench,
        &surfaces::SmoothSurface::shape_operator(surface, &found.point),
    )?;
    let covariance = contact::ContactCovariance::new(&jacobian, &noise.covariance(&touch.wrench));
    Some(covariance)
}

/// What the wrench of a sample and a tactile array tell together; of each place of the array that is pressed the centroid
/// [m] and the normal force [N], one to four.
///
/// # Errors
/// For a reading that is not finite or not near the surface, and for a wrench that is not finite.
pub fn fused<Reading, Verdict, const K: usize>(
    tip: &Tip,
    touch: &fingertip::Touch<f64, Reading, Verdict>,
    noise: &contact::WrenchNoise<f64>,
    readings: &[(Vector3<f64>, f64); K],
) -> Result<contact::Fused<f64, K>, surfaces::BadShape> {
    let fusion = contact::Fusion::new(noise.covariance(&touch.wrench), 0.6)?;
    let array = readings.map(|(centroid, normal_force)| {
        let relative = 0.1 * normal_force;
        contact::ArrayContact {
            centroid,
            centroid_covariance: Matrix3::from_diagonal_element(1e-6),
            normal_force,
            normal_deviation: wrench::Real::root(0.05 * 0.05 + relative * relative),
        }
    });
    fusion.estimate(tip.surface(), &touch.wrench, &array)
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
