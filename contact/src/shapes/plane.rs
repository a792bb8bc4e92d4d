//! The plane.

use fingertip_surfaces::numeric::vectors::{largest, wide};
use fingertip_surfaces::{Disk, ForceLine, LocalSurface, Plane, Rectangle};
use fingertip_wrench::Real;
use nalgebra::Vector3;

#[cfg(feature = "batch")]
use crate::batch::Lines;
#[cfg(feature = "batch")]
use crate::batch::kernel::{Answer, Kernel, Push, Versions, add, dot, pick, zip};
use crate::soft_finger::closed_form::{is_steady, part_of, soft_finger, told};
use crate::{GeometrySensitivity, Search, SoftContact};

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

/// The same for a force that is tame and presses steeply, without a branch.
#[inline(always)]
fn steeply_on_plane<T: Real>(plane: &Plane<T>, push: &ForceLine<T>) -> Option<SoftContact<T>> {
    let (origin, normal, force) = (plane.point(), plane.outward(), push.force());
    let torque = push.torque_about(&origin);
    let pressing = -force.dot(&normal);
    let point = torque.cross(&normal) / pressing + origin;
    let contact = SoftContact { point, normal, spin_torque: -force.dot(&torque) / pressing, active: true };
    let in_range = (point.x + point.y + point.z + contact.spin_torque).is_number();
    ((pressing > T::zero()) & in_range & is_steady(push, &contact, largest(&point))).then_some(contact)
}

soft_finger!(
    Plane,
    |shape, wrench, _, visit| told(
        on_plane(&shape.outward(), &wrench.force(), &wrench.torque_about(&shape.point()))
            .map(|contact| SoftContact { point: contact.point + shape.point(), ..contact })
            .ok_or(Search::Complete),
        visit
    ),
    sole | shape,
    push | steeply_on_plane(shape, push),
    patch | shape,
    _ | Some(LocalSurface::Plane { point: wide(&shape.point()), normal: wide(&shape.outward()) }),
    sizes | _,
    size,
    _ | (size == 0).then(GeometrySensitivity::offset)
);

part_of!(Disk, plane);
part_of!(Rectangle, plane);

#[cfg(feature = "batch")]
crate::batch::sweep::swept!(Plane);

#[cfg(feature = "batch")]
impl<T: Real> Kernel<T> for Plane<T> {
    const VERSIONS: Versions = Versions::One;

    #[inline(always)]
    fn answer(&self, push: Push<T>, _: Lines) -> Answer<T> {
        let (origin, normal): ([T; 3], [T; 3]) = (self.point().into(), self.outward().into());
        let slope = dot(push.force, normal);
        let foot = push.foot(origin, T::one());
        let across = add(foot, push.force, -dot(foot, normal) / slope);
        let gap = pick(slope < T::zero(), T::zero(), T::one() / T::zero());
        Answer::new(zip(origin, across, |o, a| o + a), normal, gap)
    }
}
