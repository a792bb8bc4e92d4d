// scene: a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
//   payload      centre_of_mass_m = [0.001, -0.002, 0.015], inertia_kg_m2 = [[0.000004, 0.0000001, 0.0],
//                [0.0000001, 0.000005, 0.0], [0. …, mass_kg = 0.021
//   filter       low_pass, noise above a frequency is taken off the wrench, by a Butterworth filter of second
//                order; cutoff_Hz = 120.0; what changes slowly comes 1.8 ms late
//   surface      sphere, a sphere, or a part of it around a pole; radius_m = 0.013
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
//     let touch = tip.sense_wrench(filter.follow(unloaded(&payload, load(force, torque), &motion)), step);
//     last = touch.point();
//
// `let payload = payload()?` is what the sensor carries, and `motion` a `wrench::Motion` that tells how it lies
// and moves. A zero that was taken with it on holds its weight as it hung then: take `payload.load` of the
// change of gravity alone off, and no bias.
//
// `let mut filter = Filter::default()` is the filter; after a pause, `filter.start_anew()`.

use fingertip::nalgebra::{Matrix3, Vector3, Vector6};
use fingertip::{Absent, Fingertip};
use fingertip::{contact, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    Absent,
    surfaces::Sphere<f64>,
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
    let surface = surfaces::Sphere::new(Vector3::zeros(), 0.013)?;
    let model = contact::PointContact::new(0.0)?;
    Ok(Fingertip::builder()
        .contact(surface, model)
        .build())
}

/// The load on the fingertip of a force [N] and a torque [N·m] as the sensor reports them.
pub fn load(force: Vector3<f64>, torque: Vector3<f64>) -> wrench::Wrench<f64> {
    wrench::Wrench::on_fingertip(force, torque)
}

/// What the sensor carries.
///
/// # Errors
/// Never for the numbers below.
pub fn payload() -> Result<wrench::Payload<f64>, BadTip> {
    let body = wrench::Payload::new(0.021, Vector3::new(0.001, -0.002, 0.015))?;
    Ok(body.with_inertia(Matrix3::from([[4e-6, 1e-7, 0.0], [1e-7, 5e-6, 0.0], [0.0, 0.0, 2e-6]]))?)
}

/// A wrench without what the sensor carries, and without what it reads of no load.
pub fn unloaded(
    payload: &wrench::Payload<f64>,
    measured: wrench::Wrench<f64>,
    motion: &wrench::Motion<f64>,
) -> wrench::Wrench<f64> {
    let bias = wrench::Wrench::from_components(&Vector6::from([0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    measured - bias - payload.load(motion)
}

/// A filter of second order on each component of the wrench: what changes slowly comes 0.00178594786293032 s late.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Filter {
    /// The first wrench, from which all are counted, and what is held of those before.
    state: Option<[Vector6<f64>; 3]>,
}

impl Filter {
    /// The next wrench, filtered. One that is not finite is given back as it is and forgotten.
    pub fn follow(&mut self, wrench: wrench::Wrench<f64>) -> wrench::Wrench<f64> {
        if !wrench.is_finite() {
            return wrench;
        }
        let components = wrench.components();
        let fresh = [components, Vector6::zeros(), Vector6::zeros()];
        let [first, one, two] = self.state.get_or_insert(fresh);
        let entering = components - *first;
        let leaving = *one + entering * 0.09131490043583197;
        *one = *two + entering * 0.18262980087166394 - leaving * -0.9824057931083953;
        *two = entering * 0.09131490043583197 - leaving * 0.3476653948517234;
        let filtered = wrench::Wrench::from_components(&(leaving + *first));
        if filtered.is_finite() {
            return filtered;
        }
        // Differences of huge wrenches overflow.
        self.state = None;
        wrench
    }

    /// As after a pause: the next wrench is the first.
    pub fn start_anew(&mut self) {
        self.state = None;
    }
}

/// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
#[derive(Clone, Debug, PartialEq)]
pub enum BadTip {
    /// A shape, a contact model or an uncertainty.
    Shape(surfaces::BadShape),
    /// What the sensor carries.
    Payload(wrench::BadPayload),
}

impl core::fmt::Display for BadTip {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Shape(bad) => bad.fmt(f),
            Self::Payload(bad) => bad.fmt(f),
        }
    }
}

impl core::error::Error for BadTip {}

impl From<surfaces::BadShape> for BadTip {
    fn from(bad: surfaces::BadShape) -> Self {
        Self::Shape(bad)
    }
}

impl From<wrench::BadPayload> for BadTip {
    fn from(bad: wrench::BadPayload) -> Self {
        Self::Payload(bad)
    }
}
