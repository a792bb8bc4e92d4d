//! Scenes: every choice can be made, runs, and gives the bits of the typed pipeline.

// Helpers of tests are tests too.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

extern crate alloc;

mod calibrated_spread;
mod choices;
mod collada;
mod curved;
mod export;
mod export_before;
mod export_beside;
mod export_c;
#[allow(dead_code, unreachable_pub)]
mod exported;
mod formula;
mod front;
mod fusion;
mod hostile;
mod inertial;
mod keys;
mod noise;
mod parts;
mod sensor;
mod stages;
mod typed;
mod urdf;
mod wrong;

use fingertip::wrench::Wrench;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// The beginning of a scene, up to its surface.
pub(crate) const HEAD: &str =
    "version = 2\n[input]\nconvention = \"on_fingertip\"\nsample_rate_Hz = 1000.0\n";
/// A tip of 13 mm.
pub(crate) const BALL: &str = "[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// Standard deviations of a good sensor.
pub(crate) const NOISE: &str = "[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n";

/// Wrenches that come and go: random pushes towards the origin, one in ten too light to be a contact.
pub(crate) fn pushes(seed: u64, count: usize) -> impl Iterator<Item = Wrench<f64>> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    (0..count).map(move |k| {
        let mut vector = |size: f64| Vector3::from_fn(|_, _| random.random_range(-size..size));
        let (at, aside) = (vector(0.006), vector(0.4));
        let strength = if k % 10 == 9 { 1e-4 } else { 1.0 };
        let force = (aside - Vector3::new(0.0, 0.0, 1.0)) * strength;
        let spin = vector(1e-3) * strength;
        Wrench::on_fingertip(force, at.cross(&force) + spin)
    })
}
