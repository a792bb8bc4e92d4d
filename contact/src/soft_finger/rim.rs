//! Edges and tips that have a range of normals.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::closed_form::is_pure_force;
use crate::SoftContact;

/// The soft-finger contacts on a circular edge around the origin, for a wrench about the origin:
/// the limit of a torus whose tube becomes a line. `on_edge` says whether the normal found at a point
/// lies between those of the faces that meet there, so that something flat could touch.
///
/// With `c = ϱ ρ(θ)` the equations `τ n + c × f = m` make `n` parallel to `M = m − c × f`, and it must
/// be across the edge's tangent `t = a × ρ`: `M·t = m·t + ϱ f·a = 0`, which two angles fulfil. Pressing
/// asks for `n = −sign(f·m) M/|M|`, `τ = −sign(f·m)|M|`. Without a spin torque, `f·m = 0` for all that the
/// numbers say, a line would have to meet the edge exactly: that is left to the faces. A radius of zero makes it a tip.
pub(crate) fn on_rim<T: Real>(
    radius: T,
    axis: &Vector3<T>,
    force: &Vector3<T>,
    torque: &Vector3<T>,
    on_edge: impl Fn(&Vector3<T>, &Vector3<T>) -> bool,
    mut visit: impl FnMut(SoftContact<T>),
) {
    let power = force.dot(torque);
    let mut try_at = |outward: Vector3<T>| {
        let contact = touching(outward * radius, force, torque, power);
        visit_on(contact, &outward, &on_edge, &mut visit);
    };
    if is_pure_force(force, torque) {
        return;
    }
    if radius.is_zero() {
        return try_at(Vector3::zeros());
    }
    let across = torque - axis * torque.dot(axis);
    for outward in around(axis, &across, radius * force.dot(axis)).into_iter().flatten() {
        try_at(outward);
    }
}

/// The same on an ellipse with these semi-axes along the first two axes; `axis` is the third, either way.
///
/// With `c = A ρ(θ)`, `A = diag(a, b)`, the tangent is `A t`, and `c × A t = ab a`: so `M·A t = (A m)·t +
/// ab f·a`, which is the condition on a circle under another wrench.
pub(crate) fn on_elliptic_rim<T: Real>(
    semi_axes: [T; 2],
    axis: &Vector3<T>,
    force: &Vector3<T>,
    torque: &Vector3<T>,
    on_edge: impl Fn(&Vector3<T>, &Vector3<T>) -> bool,
    mut visit: impl FnMut(SoftContact<T>),
) {
    let power = force.dot(torque);
    if is_pure_force(force, torque) {
        return;
    }
    let [a, b] = semi_axes;
    // In units of the longer one, so that products of lengths stay in range.
    let unit = a.max(b).normalising_factor();
    let across = Vector3::new(a * unit * torque.x, b * unit * torque.y, T::zero());
    for outward in around(axis, &across, (a * unit) * b * force.dot(axis)).into_iter().flatten() {
        let point = Vector3::new(outward.x * a, outward.y * b, T::zero());
        visit_on(touching(point, force, torque, power), &outward, &on_edge, &mut visit);
    }
}

/// The two unit vectors `ρ` across the axis for which `m·(a × ρ) + lift = 0`.
fn around<T: Real>(axis: &Vector3<T>, across: &Vector3<T>, lift: T) -> [Option<Vector3<T>>; 2] {
    let scale = across.amax().normalising_factor();
    let scaled = across * scale;
    let length = scaled.norm_squared().root();
    let along = scaled / length;
    let cosine = -lift * scale / length;
    let sine = ((T::one() - cosine) * (T::one() + cosine)).root();
    let aside = axis.cross(&along);
    [sine, -sine].map(|sine| sine.is_number().then(|| (along * cosine + aside * sine).cross(axis)))
}

/// The contact at a point whose normal nothing but the torque tells.
pub(super) fn touching<T: Real>(
    point: Vector3<T>,
    force: &Vector3<T>,
    torque: &Vector3<T>,
    power: T,
) -> SoftContact<T> {
    let rest = torque - point.cross(force);
    let scale = rest.amax().normalising_factor();
    let scaled = rest * scale;
    let length = scaled.norm_squared().root();
    let sign = if power > T::zero() { -T::one() } else { T::one() };
    SoftContact {
        point,
        normal: scaled * (sign / length),
        spin_torque: sign * (length / scale),
        active: true,
    }
}

fn visit_on<T: Real>(
    contact: SoftContact<T>,
    outward: &Vector3<T>,
    on_edge: &impl Fn(&Vector3<T>, &Vector3<T>) -> bool,
    visit: &mut impl FnMut(SoftContact<T>),
) {
    if contact.normal.sum().is_number() && on_edge(&contact.normal, outward) {
        visit(contact);
    }
}
