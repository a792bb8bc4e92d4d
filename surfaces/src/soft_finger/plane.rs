//! The plane.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::closed_form::{is_steady, part_of, soft_finger, told};
use crate::numeric::vectors::{largest, wide};
use crate::{Disk, Patch, Plane, Rectangle, Search, SoftContact};

/// The soft-finger contact on the plane through the origin, for a wrench about the origin:
/// `τ = f·m/f·n`, `c = n × m/f·n` (`docs/theory/contact.md#central-quadrics`). It is the centre of pressure
/// whatever the friction (`docs/theory/contact.md#contact-centroid`). `None` unless the force presses and the
/// point can be represented.
#[inline]
pub(super) fn on_plane<T: Real>(
    normal: &Vector3<T>,
    force: &Vector3<T>,
    torque: &Vector3<T>,
) -> Option<SoftContact<T>> {
    let scale = force.amax().normalising_factor();
    let f = force * scale;
    let m = torque * scale;
    let pressing = -f.dot(normal);
    if !(pressing > T::zero()) {
        return None;
    }
    let point = m.cross(normal) / pressing;
    let spin_torque = -f.dot(&m) / pressing / scale;
    (point.x + point.y + point.z + spin_torque).is_number().then_some(SoftContact {
        point,
        normal: *normal,
        spin_torque,
        active: true,
    })
}

#[inline(always)]
fn plane_contact<T: Real>(
    plane: &Plane<T>,
    force: &Vector3<T>,
    torque_about: impl FnOnce(&Vector3<T>) -> Vector3<T>,
) -> Option<SoftContact<T>> {
    let origin = plane.point();
    on_plane(&plane.outward(), force, &torque_about(&origin))
        .map(|contact| SoftContact { point: contact.point + origin, ..contact })
}

soft_finger!(
    Plane,
    |shape, wrench, _, visit| told(
        plane_contact(shape, &wrench.force(), |point| wrench.torque_about(point)).ok_or(Search::Complete),
        visit
    ),
    sole | shape,
    push | plane_contact(shape, &push.force(), |point| push.torque_about(point)).filter(|contact| is_steady(
        push,
        contact,
        largest(&contact.point)
    )),
    patch | shape,
    _ | Some(Patch::Plane { point: wide(&shape.point()), normal: wide(&shape.outward()) })
);

part_of!(Disk, plane);
part_of!(Rectangle, plane);
