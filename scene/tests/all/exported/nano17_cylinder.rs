// Nano17 on an 80 mm cylinder: a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip", sample_rate_Hz = 53.4
//   surface      cylinder, the side of a round cylinder; axis = [0.0, 1.0, 0.0], centre_m = [0.0, 0.0,
//                -0.027347], half_length_m = 0.0109965, radius_m = 0.04
//   pose         rotation_deg = [0.0, 0.0, 42.0]
//   contact      least_force_N = 1.0
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

use fingertip::nalgebra::Vector3;
use fingertip::{Absent, Fingertip};
use fingertip::{contact, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::Cylinder<f64>,
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
    let surface = surfaces::Cylinder::new(
        Vector3::new(0.0, 0.0, -0.027347),
        Vector3::new(-0.6691306063588582, 0.7431448254773942, 0.0),
        0.04,
    )?.with_half_length(0.0109965)?;
    let model = contact::PointContact::new(1.0)?;
    Ok(Fingertip::builder()
        .contact(surface, model)
        .build())
}

/// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
    wrench::Wrench::on_fingertip(force, torque)
}

/// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
pub type BadTip = surfaces::BadShape;
