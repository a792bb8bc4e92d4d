//! The plane.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::SoftContact;

/// The soft-finger contact on the plane through the origin, for a wrench about the origin:
/// `τ = f·m/f·n`, `c = n × m/f·n` (theory 3.2). It is the centre of pressure whatever the friction
/// (theory 3.6). `None` unless the force presses and the point can be represented.
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
