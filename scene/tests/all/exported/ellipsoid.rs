// Ellipsoid: a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
//   surface      ellipsoid, an ellipsoid; semi_axes_m = [0.008, 0.01, 0.015]
//   pose         translation_m = [0.0, 0.0, 0.02]
//   contact      least_force_N = 0.2
//
// It needs neither heap nor standard library, and in Cargo.toml:
//
//   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision"] }
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

use fingertip::nalgebra::{Matrix3, Vector3};
use fingertip::{Absent, Fingertip};
use fingertip::{contact, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::Posed<f64, surfaces::Ellipsoid<f64>>,
    contact::PointContact<f64>,
    Absent,
    Absent,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Posed::new(
        surfaces::Ellipsoid::new(Vector3::new(0.008, 0.01, 0.015))?,
        wrench::RigidTransform::from_matrix(
            Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
            Vector3::new(0.0, 0.0, 0.02),
        )?,
    );
    let model = contact::PointContact::new(0.2)?;
    Ok(Fingertip::builder()
        .contact(surface, model)
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
    /// A pose.
    Pose(wrench::TransformError),
}

impl core::fmt::Display for BadTip {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Shape(bad) => bad.fmt(f),
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

impl From<wrench::TransformError> for BadTip {
    fn from(bad: wrench::TransformError) -> Self {
        Self::Pose(bad)
    }
}
