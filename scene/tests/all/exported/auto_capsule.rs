// capsule, model by the wrench: a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip"
//   surface      capsule, a cylinder with round ends; half_length_m = 0.01, radius_m = 0.008
//   pose         translation_m = [0.0, 0.0, 0.02]
//   contact      auto, point contact or soft finger, whichever the wrench speaks for, given the noise in
//                [uncertainty]; greatest_pitch_m = 0.01, least_force_N = 0.1
//   uncertainty  force_noise_N = 0.01, position_m = 0.0002, torque_noise_Nm = 0.0001
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
//
// With `let (noise, geometry) = (wrench_noise()?, geometry()?)`, the covariance of the contact is
//     covariance(&tip, &touch, &noise, &geometry)
// whose `ellipse(0.95)` is that of the scene.

use fingertip::nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use fingertip::{Absent, Fingertip};
use fingertip::{contact, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::Capsule<f64>,
    contact::Auto<f64>,
    Absent,
    Absent,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Capsule::new(Vector3::new(0.0, 0.0, 0.02), Vector3::z(), 0.008, 0.01)?;
    let model = contact::Auto::new(
        contact::PointContact::new(0.1)?,
        contact::SoftFinger::new(0.1)?,
        Matrix6::from_diagonal(&Vector6::from([0.0001, 0.0001, 0.0001, 1e-8, 1e-8, 1e-8])),
    )?.with_greatest_pitch(0.01, 3.0)?;
    Ok(Fingertip::builder()
        .contact(surface, model)
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

/// How sure the size and the place of the surface are.
///
/// # Errors
/// Never for the numbers below.
pub fn geometry() -> Result<contact::GeometryUncertainty<f64>, BadTip> {
    let geometry = contact::GeometryUncertainty {
        offset: 0.0,
        position: Matrix3::from_diagonal_element(4e-8),
        attitude: Matrix3::from_diagonal_element(0.0),
        pivot: Vector3::new(0.0, 0.0, 0.02),
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
    let jacobian = match tip.model().test(&touch.wrench)?.choice {
        contact::Choice::SoftFinger => contact::ContactJacobian::of_soft_finger_on(found, surface)?,
        _ => contact::ContactJacobian::of_point_contact(
            found,
            &touch.wrench,
            &surfaces::SmoothSurface::shape_operator(surface, &found.point),
        )?,
    };
    let covariance = contact::ContactCovariance::new(&jacobian, &noise.covariance(&touch.wrench));
    Some(covariance.with_geometry(&jacobian, geometry))
}

/// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
pub type BadTip = surfaces::BadShape;
