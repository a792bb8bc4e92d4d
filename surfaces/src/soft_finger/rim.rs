//! Edges and tips that have a range of normals.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::SoftContact;

/// The soft-finger contacts on a circular edge around the origin, for a wrench about the origin:
/// the limit of a torus whose tube becomes a line. `on_edge` says whether the normal found at a point
/// lies between those of the faces that meet there, so that something flat could touch.
///
/// With `c = ϱ ρ(θ)` the equations `τ n + c × f = m` make `n` parallel to `M = m − c × f`, and it must
/// be across the edge's tangent `t = a × ρ`: `M·t = m·t + ϱ f·a = 0`, which two angles fulfil. Pressing
/// asks for `n = −sign(f·m) M/|M|`, `τ = −sign(f·m)|M|`. Without a spin torque, `f·m = 0`, a line
/// would have to meet the edge exactly: that is left to the faces. A radius of zero makes it a tip.
pub(super) fn on_rim<T: Real>(
    radius: T,
    axis: &Vector3<T>,
    force: &Vector3<T>,
    torque: &Vector3<T>,
    on_edge: impl Fn(&Vector3<T>, &Vector3<T>) -> bool,
    mut visit: impl FnMut(SoftContact<T>),
) {
    let power = force.dot(torque);
    let mut try_at = |outward: Vector3<T>| {
        let point = outward * radius;
        let rest = torque - point.cross(force);
        let scale = rest.amax().normalising_factor();
        let scaled = rest * scale;
        let length = scaled.norm_squared().root();
        let sign = if power > T::zero() { -T::one() } else { T::one() };
        let normal = scaled * (sign / length);
        let spin_torque = sign * (length / scale);
        if normal.sum().is_number() && on_edge(&normal, &outward) {
            visit(SoftContact { point, normal, spin_torque, active: true });
        }
    };
    if power.is_zero() {
        return;
    }
    if radius.is_zero() {
        return try_at(Vector3::zeros());
    }
    let across = torque - axis * torque.dot(axis);
    let scale = across.amax().normalising_factor();
    let scaled = across * scale;
    let length = scaled.norm_squared().root();
    let along = scaled / length;
    let cosine = -(radius * force.dot(axis)) * scale / length;
    let sine = ((T::one() - cosine) * (T::one() + cosine)).root();
    if !(sine >= T::zero()) {
        return;
    }
    let aside = axis.cross(&along);
    for sine in [sine, -sine] {
        let tangent = along * cosine + aside * sine;
        try_at(tangent.cross(axis));
    }
}
