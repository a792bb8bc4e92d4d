//! Solids of revolution with flat ends: closed cylinder, cone, truncated cone.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::cone::on_cone;
use super::cylinder::on_cylinder;
use super::newton::Problem;
use super::plane::on_plane;
use super::rim::on_rim;
use crate::numeric::vectors::tangents;
use crate::{Cone, Frustum, SoftContact};

/// The soft-finger contact on a frustum: of the side, by the closed form of its cone or cylinder; of
/// the flat ends, by that of the plane; of the edges between them and of a tip, with a normal between
/// those of the faces that meet. A convex solid has one contact, and it has it on one of these.
pub(super) fn on_frustum<T: Real>(solid: &Frustum<T>, wrench: &Wrench<T>) -> Option<SoftContact<T>> {
    let (base, axis, height) = (solid.base_centre(), solid.axis(), solid.height());
    let force = wrench.force();
    if let Some(contact) = on_side(solid, wrench) {
        let above = (contact.point - base).dot(&axis);
        if above >= T::zero() && above <= height {
            return Some(contact);
        }
    }
    let (sine, cosine) = (solid.taper() * solid.side_cosine(), solid.side_cosine());
    for (outward, origin, radius) in
        [(axis, base + axis * height, solid.top_radius()), (-axis, base, solid.base_radius())]
    {
        let torque = wrench.torque_about(&origin);
        if let Some(contact) = on_plane(&outward, &force, &torque)
            && contact.point.norm_squared() <= radius * radius
        {
            return Some(SoftContact { point: contact.point + origin, ..contact });
        }
        // The side's normal has this much along the end's.
        let lean = if outward == axis { sine } else { -sine };
        let mut found = None;
        on_rim(
            radius,
            &outward,
            &force,
            &torque,
            |normal, ring| {
                let up = normal.dot(&outward);
                let out = if radius.is_zero() {
                    (normal - outward * up).norm_squared().root()
                } else {
                    normal.dot(ring)
                };
                out >= T::zero() && cosine * up >= lean * out
            },
            |contact| found = Some(SoftContact { point: contact.point + origin, ..contact }),
        );
        if found.is_some() {
            return found;
        }
    }
    None
}

/// On the side, unbounded: by a closed form, and a step of Newton's method, which makes good what the
/// closed form of a slender cone loses by counting from a far apex.
fn on_side<T: Real>(solid: &Frustum<T>, wrench: &Wrench<T>) -> Option<SoftContact<T>> {
    let (base, axis, taper) = (solid.base_centre(), solid.axis(), solid.taper());
    let cone = || {
        let apex = base + axis * (solid.base_radius() / taper);
        let into = if taper > T::zero() { -axis } else { axis };
        Cone::new(apex, into, taper.abs().atan()).ok()
    };
    let rough = if taper.is_zero() { None } else { cone().map(|cone| on_cone(&cone, wrench)) };
    let rough = match rough {
        Some(contact) => contact.ok()?,
        None => {
            let radius = (solid.base_radius() + solid.top_radius()) * T::literal(0.5);
            on_round_side(&base, &axis, radius, &wrench.force(), &wrench.torque_about(&base))?
        }
    };
    if taper.is_zero() {
        return Some(rough);
    }
    Problem::new(solid, &wrench.force(), &wrench.torque()).polished(&rough)
}

/// On the side of an unbounded circular cylinder, for the torque about its centre.
pub(super) fn on_round_side<T: Real>(
    centre: &Vector3<T>,
    axis: &Vector3<T>,
    radius: T,
    force: &Vector3<T>,
    torque: &Vector3<T>,
) -> Option<SoftContact<T>> {
    let (first, second) = tangents(axis);
    let inward = |v: &Vector3<T>| Vector3::new(v.dot(&first), v.dot(&second), v.dot(axis));
    let outward = |v: &Vector3<T>| first * v.x + second * v.y + axis * v.z;
    let (force, torque) = (inward(force), inward(torque));
    let mut found = None;
    on_cylinder([radius; 2], [T::one() / radius; 2], &force, &torque, |contact| {
        found = Some(SoftContact {
            point: outward(&contact.point) + centre,
            normal: outward(&contact.normal),
            ..contact
        });
    });
    found
}
