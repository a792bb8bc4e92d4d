//! A mesh whose shape is known.

use alloc::vec::Vec;

use fingertip_wrench::Real;
use nalgebra::Vector3;

/// A ball of radius 1 about the origin: vertices on `rings − 1` circles of latitude between two poles,
/// `sectors` on each, and triangles that face outward.
///
/// With a `sliver`, the first of the sectors is that many radians wide and the others share the rest;
/// otherwise all are alike.
#[must_use]
pub fn ball_of_triangles<T: Real>(
    rings: u32,
    sectors: u32,
    sliver: Option<f64>,
) -> (Vec<Vector3<T>>, Vec<[u32; 3]>) {
    use core::f64::consts::{PI, TAU};
    let whole = f64::from(sectors);
    let mut vertices = Vec::new();
    let mut add = |x: f64, y: f64, z: f64| vertices.push(Vector3::new(x, y, z).map(T::literal));
    let sine_and_cosine = |angle: f64| Real::sine_and_cosine(angle);
    add(0.0, 0.0, 1.0);
    for i in 1..rings {
        let (sine, cosine) = sine_and_cosine(PI * f64::from(i) / f64::from(rings));
        for j in 0..sectors {
            let (s, c) = sine_and_cosine(match sliver {
                None => TAU * f64::from(j) / whole,
                Some(sliver) if j == 0 => -sliver,
                Some(_) => TAU * (f64::from(j) - 1.0) / (whole - 1.0),
            });
            add(sine * c, sine * s, cosine);
        }
    }
    add(0.0, 0.0, -1.0);
    let last = 1 + (rings - 1) * sectors;
    let at = |i: u32, j: u32| 1 + (i - 1) * sectors + j % sectors;
    let mut triangles = Vec::new();
    for j in 0..sectors {
        triangles.push([0, at(1, j), at(1, j + 1)]);
        triangles.push([last, at(rings - 1, j + 1), at(rings - 1, j)]);
        for i in 1..rings - 1 {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    (vertices, triangles)
}
