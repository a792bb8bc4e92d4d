//! What drawings of a contact have in common, in whatever messages they are sent. Lengths in metres.

use core::f64::consts::TAU;

use fingertip::wrench::tangents;
use nalgebra::Vector3;

use crate::{Pressed, Sample};

/// Length of the arrow of a newton \[m\].
pub(crate) const NEWTON: f64 = 0.004;

/// Red, green, blue and opacity, from 0 to 1.
pub(crate) type Colour = [f64; 4];

pub(crate) const SURFACE: Colour = [0.72, 0.75, 0.79, 0.8];
pub(crate) const FORCE: Colour = [0.1, 0.11, 0.13, 1.0];
const HOLDING: Colour = [0.0, 0.5, 0.37, 1.0];
const NEAR: Colour = [0.78, 0.32, 0.05, 1.0];
const SLIPPING: Colour = [0.78, 0.12, 0.27, 1.0];

/// The colour of a contact, by how much of the friction limit is used.
pub(crate) fn colour(sample: &Sample) -> Colour {
    match sample.felt.and_then(|felt| felt.margin).map_or(0.0, |margin| margin.utilisation) {
        used if used >= 1.0 => SLIPPING,
        used if used > 0.8 => NEAR,
        _ => HOLDING,
    }
}

/// Points of an ellipse about a middle, with two vectors as its semi-axes; the first is not there again at the end.
pub(crate) fn ring(
    middle: &Vector3<f64>,
    one: &Vector3<f64>,
    other: &Vector3<f64>,
    corners: u32,
) -> Vec<Vector3<f64>> {
    let angle = |corner: u32| TAU * f64::from(corner) / f64::from(corners);
    (0..corners).map(|corner| middle + one * angle(corner).cos() + other * angle(corner).sin()).collect()
}

/// The rim of the cone of friction, at the height of the normal force.
pub(crate) fn rim(contact: &Pressed, coefficient: f64, corners: u32) -> Vec<Vector3<f64>> {
    let length = NEWTON * contact.normal_force;
    let (right, up) = tangents(&contact.normal);
    let (middle, radius) = (contact.point + contact.normal * length, coefficient * length);
    ring(&middle, &(right * radius), &(up * radius), corners)
}
