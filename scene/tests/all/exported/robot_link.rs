// tip of a robot's finger: a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "reaction", rest_s = 0.5, sample_rate_Hz = 500.0
//   surface      link = "tip", sensor_link = "sensor", urdf = "robot_link.urdf"
//   contact      point, a contact transmits a force and no torque of its own; least_force_N = 0.1
//   friction     coulomb, one coefficient in all directions; static_coefficient = 0.6
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
// The sensor is unloaded for 0.5 s at the start: the mean of force and torque there is to be taken off both.

use fingertip::nalgebra::{Matrix3, Vector3};
use fingertip::{Absent, Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::Posed<f64, surfaces::Capsule<f64>>,
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
    let surface = surfaces::Posed::new(
        surfaces::Capsule::new(Vector3::zeros(), Vector3::z(), 0.008, 0.008)?,
        wrench::RigidTransform::from_matrix(
            Matrix3::new(
                0.9396926207859084,
                0.0,
                0.3420201433256687,
                0.0,
                1.0,
                0.0,
                -0.3420201433256687,
                0.0,
                0.9396926207859084,
            ),
            Vector3::new(0.0, 0.0, 0.015),
        )?,
    );
    let model = contact::PointContact::new(0.1)?;
    Ok(Fingertip::builder()
        .contact(surface, model)
        .friction(friction::Coulomb::new(0.6)?)
        .build())
}

/// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
    wrench::Wrench::from_reaction(force, torque)
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
