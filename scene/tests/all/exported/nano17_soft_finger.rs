// Nano17 on an 80 mm cylinder, soft finger: a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip", sample_rate_Hz = 53.4
//   surface      cylinder, the side of a round cylinder; axis = [0.0, 1.0, 0.0], centre_m = [0.0, 0.0,
//                -0.027347], half_length_m = 0.0109965, radius_m = 0.04
//   pose         rotation_deg = [0.0, 0.0, 42.0]
//   contact      soft_finger, a contact transmits a force and a torque about the normal, as a soft tip does;
//                least_force_N = 1.0
//   uncertainty  attitude_deg = 0.5, force_noise_N = 0.0125, offset_m = 0.00005, position_m = 0.0001,
//                relative = 0.005, torque_noise_Nm = 0.0000625
//   friction     load_dependent, tangential force and spin torque on a patch that grows with the force;
//                growth_exponent = 0.33, reference_force_N = 4.0, static_coefficient = 0.6, torque_arm_m =
//                0.0024
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
// With `let (noise, geometry) = (wrench_noise()?, geometry()?)`, the covariance of the contact is
//     covariance(&tip, &touch, &noise, &geometry)
// whose `ellipse(0.95)` is that of the scene.

use fingertip::nalgebra::{Matrix3, Vector3, Vector6};
use fingertip::{Absent, Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::Cylinder<f64>,
    contact::SoftFinger<f64>,
    Present<friction::LoadDependentLimit<f64>>,
    Absent,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Cylinder::new(
        Vector3::new(0.0, 0.0, -0.027347),
        Vector3::new(-0.6691306063588582, 0.7431448254773942, 0.0),
        0.04,
    )?.with_half_length(0.0109965)?;
    let model = contact::SoftFinger::new(1.0)?;
    Ok(Fingertip::builder()
        .contact(surface, model)
        .friction(friction::LoadDependentLimit::new(0.6, 0.0024, 4.0, 0.33)?)
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
    let noise = contact::WrenchNoise::new(
        Vector6::from([0.0125, 0.0125, 0.0125, 6.25e-5, 6.25e-5, 6.25e-5]),
        0.005,
    )?;
    Ok(noise)
}

/// How sure the size and the place of the surface are.
///
/// # Errors
/// Never for the numbers below.
pub fn geometry() -> Result<contact::GeometryUncertainty<f64>, BadTip> {
    let geometry = contact::GeometryUncertainty {
        offset: 2.5e-9,
        position: Matrix3::from_diagonal_element(1e-8),
        attitude: Matrix3::from_diagonal_element(7.615435494667714e-5),
        pivot: Vector3::zeros(),
    }
    .checked()?;
    Ok(geometry)
}

/// How sure the contact of a sample is; `None` without one, and where that cannot be said, as at grazing.
pub fn covariance<Reading, Verdict>(
    tip: &Tip,
    touch: &fingertip::Touch<f64, Reading, Verdict>,
    noise: &contact::WrenchNoise<f64>,
    geometry: &contact::GeometryUncertainty<f64>,
) -> Option<contact::ContactCovariance<f64>> {
    let surface = tip.surface();
    let found = touch.resolution.contact()?;
    let jacobian = contact::ContactJacobian::of_soft_finger_on(found, surface)?;
    let covariance = contact::ContactCovariance::new(&jacobian, &noise.covariance(&touch.wrench));
    Some(covariance.with_geometry(&jacobian, geometry))
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
