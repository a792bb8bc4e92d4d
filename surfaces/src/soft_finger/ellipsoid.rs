//! Sphere and ellipsoid, through the unit sphere.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::unit_sphere::{OnUnitSphere, on_unit_sphere};
use crate::SoftContact;
use crate::numeric::vectors::{larger, largest, taming_factor};

/// The soft-finger contact on a sphere around the origin, for a wrench about its centre.
///
/// # Errors
/// The pair of points that a pure force which misses would graze.
#[inline(always)]
pub(super) fn on_sphere<T: Real>(
    radius: T,
    curvature: T,
    force: &Vector3<T>,
    torque: &Vector3<T>,
) -> Result<SoftContact<T>, [Vector3<T>; 2]> {
    let lever = torque * curvature;
    let scale = taming_factor(larger(largest(force), largest(&lever)));
    match on_unit_sphere(&(force * scale), &(lever * scale)) {
        OnUnitSphere::Contact { point, spin } => Ok(SoftContact {
            point: point * radius,
            normal: point,
            spin_torque: spin * radius * scale.normalising_factor(),
            active: true,
        }),
        OnUnitSphere::Grazing(pair) => Err(pair.map(|point| point * radius)),
    }
}

/// The soft-finger contact on the ellipsoid with these semi-axes (and their reciprocals) along the
/// axes of the frame, for a wrench about its centre in the same frame.
///
/// With `c = A y`, `A = diag(a)`, the equations become those of the unit sphere under the wrench
/// `(A⁻¹ f, A m / det A)`; the spin torque is `k |A⁻¹ y| · det A` in the scale of that wrench.
/// (`D = A⁻²` in theory 3.2, where the identity is `(Df) × m = A(f̃ × m̃)`.)
///
/// # Errors
/// The pair of points that a pure force which misses would graze.
#[inline(always)]
pub(super) fn on_ellipsoid<T: Real>(
    semi_axes: &Vector3<T>,
    reciprocals: &Vector3<T>,
    force: &Vector3<T>,
    torque: &Vector3<T>,
) -> Result<SoftContact<T>, [Vector3<T>; 2]> {
    // Lengths in units of the largest semi-axis, by a power of two; then the product of two
    // reciprocals is at least 1/4 and overflows only where the shape itself is not representable.
    let unit = largest(semi_axes).normalising_factor();
    let length = unit.normalising_factor();
    let b = reciprocals * length;
    let f = force.component_mul(&b);
    let across = Vector3::new(b.y * b.z, b.z * b.x, b.x * b.y) * unit;
    let m = torque.component_mul(&across);
    let scale = taming_factor(larger(largest(&f), largest(&m)));
    match on_unit_sphere(&(f * scale), &(m * scale)) {
        OnUnitSphere::Contact { point, spin } => {
            let gradient = point.component_mul(&b);
            let steepness = gradient.norm_squared().root();
            let volume = (semi_axes.x * unit) * (semi_axes.y * unit) * semi_axes.z;
            Ok(SoftContact {
                point: point.component_mul(semi_axes),
                normal: gradient * (T::one() / steepness),
                spin_torque: spin * volume * steepness * scale.normalising_factor(),
                active: true,
            })
        }
        OnUnitSphere::Grazing(pair) => Err(pair.map(|point| point.component_mul(semi_axes))),
    }
}
