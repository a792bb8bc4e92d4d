// pillow with a flat top: a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip"
//   surface      formula, a shape of your own: where a formula of x, y and z is zero, within a ball; outside
//                = "max((x/a)^4 + (y/a)^4 + (z/b)^2 - 1, (z - top)/b)", parameters = { a = 0.01, b = 0.013,
//                top = 0.011 }, reach_m = 0.019
//   contact      least_force_N = 0.1
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

use fingertip::nalgebra::{ComplexField, RealField, Vector3};
use fingertip::{Absent, Fingertip};
use fingertip::{contact, surfaces, wrench};

/// The shape: zero on the surface, negative inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape;

#[allow(clippy::approx_constant)]
impl surfaces::ImplicitSurface<f64> for Shape {
    fn formula(&self, [x, y, z]: [surfaces::Term<f64>; 3]) -> surfaces::Term<f64> {
        let number = surfaces::Term::constant;
        (((x / number(0.01)).powi(4) + (y / number(0.01)).powi(4)) + ((z / number(0.013)).powi(2) - number(1.0))).max(
            (z - number(0.011)) / number(0.013),
        )
    }

    fn ball(&self) -> (Vector3<f64>, f64) {
        (Vector3::zeros(), 0.019)
    }

    fn value(&self, point: &Vector3<f64>) -> f64 {
        let [x, y, z]: [f64; 3] = (*point).into();
        RealField::max(
            (ComplexField::powi(x / 0.01, 4) + ComplexField::powi(y / 0.01, 4)) + (ComplexField::powi(z / 0.013, 2) - 1.0),
            (z - 0.011) / 0.013,
        )
    }

    fn topology(&self) -> surfaces::Topology {
        surfaces::Topology::Unknown
    }
}

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::Implicit<f64, Shape>,
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
    let surface = surfaces::Implicit::new(Shape)?;
    let model = contact::PointContact::new(0.1)?;
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
