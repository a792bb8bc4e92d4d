// skinned "tip": a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "reaction", rest_s = 1.0, sample_rate_Hz = 500.0
//   surface      compound, the union of several shapes; parts = [{ active_half_angle_deg = 140.0, pole =
//                [0.1, 0.7, 0.3], ra …
//   pose         rotation_deg = [10.0, 20.0, 30.0], translation_m = [0.001, 0.0, 0.002]
//   contact      soft_finger, a contact transmits a force and a torque about the normal, as a soft tip does;
//                skin_share = 0.5
//   contact.skin linear, depth in proportion to the force; radius_m = 0.013, stiffness_N_per_m = 8000
//   uncertainty  force_noise_N = 0.01, torque_noise_Nm = 0.0001
//   friction     soft_finger, tangential force and spin torque together; conservative = true,
//                static_coefficient = 0.5, torque_arm_m = 0.003
//   slip         drop, the friction ratio falls suddenly; false_alarms_per_minute = 2.0, noise_N = 0.01
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
// The sensor is unloaded for 1.0 s at the start: the mean of force and torque there is to be taken off both.
//
// After a pause, `last = None` and `friction::SlipDetector::<f64>::reset(&mut tip.detector_mut().0)`.
//
// With `let noise = wrench_noise()?`, the covariance of the contact is
//     covariance(&tip, &touch, before, &noise)
// whose `ellipse(0.95)` is that of the scene; `before` is the last contact before this sample.
//
// With `let mut grip = grip()?`, the normal force to command next [N] is
//     match &touch.force {
//         Some(force) => grip.command(&tip.friction().0, force, touch.slip, time_step),
//         None => grip.present(),
//     }

use fingertip::nalgebra::{Matrix3, Vector3, Vector6};
use fingertip::{Absent, Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::Posed<
        f64,
        surfaces::Compound<
            surfaces::Compound<surfaces::SphericalCap<f64>, surfaces::Posed<f64, surfaces::Cone<f64>>>,
            surfaces::Compound<surfaces::EllipticCylinder<f64>, surfaces::EllipticCylinder<f64>>,
        >,
    >,
    contact::Compliant<f64, contact::SoftFinger<f64>, contact::LinearStiffness<f64>>,
    Present<friction::SoftFingerLimit<f64>>,
    Present<friction::DropDetector<f64>>,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Posed::new(
        surfaces::Compound::new(
            surfaces::Compound::new(
                surfaces::SphericalCap::new(
                    surfaces::Sphere::new(Vector3::zeros(), 0.01)?,
                    Vector3::new(0.1, 0.7, 0.3),
                    -0.7660444431189779,
                )?,
                surfaces::Posed::new(
                    surfaces::Cone::new(
                        Vector3::zeros(),
                        Vector3::z(),
                        0.5410520681182421,
                    )?.with_depth(0.02)?,
                    wrench::RigidTransform::from_matrix(
                        Matrix3::new(
                            0.838670567945424,
                            0.0,
                            0.544639035015027,
                            0.0,
                            1.0,
                            0.0,
                            -0.544639035015027,
                            0.0,
                            0.838670567945424,
                        ),
                        Vector3::new(0.0, 0.0, 0.0),
                    )?,
                ),
            ),
            surfaces::Compound::new(
                surfaces::EllipticCylinder::new([0.008, 0.01], surfaces::CylinderEnds::Unbounded)?,
                surfaces::EllipticCylinder::new([0.009, 0.007], surfaces::CylinderEnds::Open(0.012))?,
            ),
        ),
        wrench::RigidTransform::from_matrix(
            Matrix3::new(
                0.8089361145249915,
                -0.4577738486383615,
                0.3688705275839105,
                0.5165627364768257,
                0.8530277804038395,
                -0.07420609909483492,
                -0.28068719582621426,
                0.25057276261022743,
                0.9265138902019198,
            ),
            Vector3::new(0.001, 0.0, 0.002),
        )?,
    );
    let model = contact::Compliant::new(
        contact::SoftFinger::new(0.0)?,
        contact::LinearStiffness::new(8000.0, 0.013)?,
    ).with_share(0.5)?;
    Ok(Fingertip::builder()
        .contact(surface, model)
        .friction(friction::SoftFingerLimit::conservative(0.5, 0.003)?)
        .slip_detector(
            friction::DropDetector::with_sum(
                friction::ForceNoise::isotropic(0.01)?,
                friction::Cusum::new(0.75, 5.339682943800724)?,
            )?,
        )
        .build())
}

/// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
    wrench::Wrench::from_reaction(force, torque)
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
    last: Option<&Vector3<f64>>,
    noise: &contact::WrenchNoise<f64>,
) -> Option<contact::ContactCovariance<f64>> {
    let surface = tip.surface();
    let indented = tip.model().resolve_indented(&touch.wrench, surface, last).ok()?;
    let jacobian = tip.model().jacobian(&indented, surface)?;
    let covariance = contact::ContactCovariance::new(&jacobian, &noise.covariance(&touch.wrench));
    Some(covariance)
}

/// What commands the grip.
///
/// # Errors
/// Never for the numbers below.
pub fn grip() -> Result<friction::GripController<f64>, BadTip> {
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
    /// A pose.
    Pose(wrench::TransformError),
}

impl core::fmt::Display for BadTip {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Shape(bad) => bad.fmt(f),
            Self::Friction(bad) => bad.fmt(f),
            Self::Pose(bad) => bad.fmt(f),
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

impl From<wrench::TransformError> for BadTip {
    fn from(bad: wrench::TransformError) -> Self {
        Self::Pose(bad)
    }
}
