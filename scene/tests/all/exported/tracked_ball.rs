// tracked ball: a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
//   surface      sphere, a sphere, or a part of it around a pole; pole = [1.0, 0.0, 0.0], radius_m = 0.013
//   contact      point, a contact transmits a force and no torque of its own; least_force_N = 0.05
//   uncertainty  force_noise_N = 0.005, torque_noise_Nm = 0.00015
//   tracking     least_touch_N = 0.04, speed_m_per_s = 0.01, turns_within_s = 0.1
//
// It needs neither heap nor standard library, and in Cargo.toml:
//
//   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "track"] }
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
// With `let (mut tracker, noise) = (tracker()?, wrench_noise()?)`, the contact over time is
//     let sighting = sighting(&tip, &touch, &noise);
//     tracker.follow(tip.surface(), sighting.as_ref(), time_step)
// and `tracker.reset()` is to be called after a pause.
// With `let mut events = contact_events()?`, touch, release and blow are told by
//     events.observe(&touch.wrench.force(), time_step)

use fingertip::nalgebra::{Vector3, Vector6};
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
    let model = contact::PointContact::new(0.05)?;
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
    let noise = contact::WrenchNoise::new(
        Vector6::from([0.005, 0.005, 0.005, 0.00015, 0.00015, 0.00015]),
        0.0,
    )?;
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

/// Follows the contact over time.
///
/// # Errors
/// Never for the numbers below.
pub fn tracker() -> Result<contact::Tracker<f64>, BadTip> {
    Ok(contact::Tracker::new(0.01, 0.1)?.with_gate(0.001)?)
}

/// Where the contact of a sample is, and how sure; `None` without one, and where that cannot be said.
pub fn sighting<Reading, Verdict>(
    tip: &Tip,
    touch: &fingertip::Touch<f64, Reading, Verdict>,
    noise: &contact::WrenchNoise<f64>,
) -> Option<contact::Sighting<f64>> {
    let surface = tip.surface();
    let found = touch.resolution.contact()?;
    let jacobian = contact::ContactJacobian::of_point_contact(
        found,
        &touch.wrench,
        &surfaces::SmoothSurface::shape_operator(surface, &found.point),
    )?;
    contact::Sighting::of(found, &jacobian, &noise.covariance(&touch.wrench))
}

/// Tells when something touches, lets go or strikes.
///
/// # Errors
/// Never for the numbers below.
pub fn contact_events() -> Result<contact::ContactEvents<f64>, BadTip> {
    let events = contact::ContactEvents::new(0.005, 0.04, 1000000.0)?;
    Ok(events.with_longest_impact(0.05)?)
}

/// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
#[derive(Clone, Debug, PartialEq)]
pub enum BadTip {
    /// A shape, a contact model or an uncertainty.
    Shape(surfaces::BadShape),
    /// What follows a contact over time.
    Track(contact::BadTrack),
}

impl core::fmt::Display for BadTip {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Shape(bad) => bad.fmt(f),
            Self::Track(bad) => bad.fmt(f),
        }
    }
}

impl core::error::Error for BadTip {}

impl From<surfaces::BadShape> for BadTip {
    fn from(bad: surfaces::BadShape) -> Self {
        Self::Shape(bad)
    }
}

impl From<contact::BadTrack> for BadTip {
    fn from(bad: contact::BadTrack) -> Self {
        Self::Track(bad)
    }
}
