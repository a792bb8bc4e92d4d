//! Sphere and ellipsoid, through the unit sphere.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::unit_sphere::{OnUnitSphere, on_unit_sphere};
use crate::{Search, SoftContact};

/// The soft-finger contact on a sphere around the origin, for a wrench about its centre.
#[inline]
pub(super) fn on_sphere<T: Real>(
    radius: T,
    curvature: T,
    force: &Vector3<T>,
    torque: &Vector3<T>,
    mut visit: impl FnMut(SoftContact<T>),
) -> Search<T> {
    let lever = torque * curvature;
    let scale = force.amax().max(lever.amax()).normalising_factor();
    match on_unit_sphere(&(force * scale), &(lever * scale)) {
        OnUnitSphere::Contact { point, spin } => {
            visit(SoftContact {
                point: point * radius,
                normal: point,
                spin_torque: spin * radius / scale,
                active: true,
            });
            Search::Complete
        }
        OnUnitSphere::Grazing(pair) => Search::Grazing(pair.map(|point| point * radius)),
    }
}

/// The soft-finger contact on the ellipsoid with these semi-axes (and their reciprocals) along the
/// axes of the frame, for a wrench about its centre in the same frame.
///
/// With `c = A y`, `A = diag(a)`, the equations become those of the unit sphere under the wrench
/// `(A⁻¹ f, A m / det A)`; the spin torque is `k |A⁻¹ y| · det A` in the scale of that wrench.
/// (`D = A⁻²` in theory 3.2, where the identity is `(Df) × m = A(f̃ × m̃)`.)
#[inline]
pub(super) fn on_ellipsoid<T: Real>(
    semi_axes: &Vector3<T>,
    reciprocals: &Vector3<T>,
    force: &Vector3<T>,
    torque: &Vector3<T>,
    mut visit: impl FnMut(SoftContact<T>),
) -> Search<T> {
    // Lengths in units of the largest semi-axis, by a power of two; then the product of two
    // reciprocals is at least 1/4 and overflows only where the shape itself is not representable.
    let unit = semi_axes.amax().normalising_factor();
    let length = T::one() / unit;
    let (a, b) = (semi_axes * unit, reciprocals * length);
    let lever = torque * unit;
    let scale = force.amax().max(lever.amax()).normalising_factor();
    let f = force.component_mul(&b) * scale;
    let across = Vector3::new(b.y * b.z, b.z * b.x, b.x * b.y);
    let m = lever.component_mul(&across) * scale;
    // In the affine frame the wrench may have grown again.
    let again = f.amax().max(m.amax()).normalising_factor();
    match on_unit_sphere(&(f * again), &(m * again)) {
        OnUnitSphere::Contact { point, spin } => {
            let gradient = point.component_mul(&b);
            let steepness = gradient.norm_squared().root();
            let volume = a.x * a.y * a.z;
            visit(SoftContact {
                point: point.component_mul(semi_axes),
                normal: gradient / steepness,
                spin_torque: spin * volume * steepness / (again * scale) * length,
                active: true,
            });
            Search::Complete
        }
        OnUnitSphere::Grazing(pair) => Search::Grazing(pair.map(|point| point.component_mul(semi_axes))),
    }
}
