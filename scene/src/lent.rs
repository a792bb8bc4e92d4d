//! Forces for functions that are called out of line.

use fingertip::wrench::{ContactForce, Real, TangentialForce};
use nalgebra::Vector3;

/// A copy by components, for what is called out of line: a force whose address is taken stays in memory, and what is told of
/// it would come from there. The compiler sees through a copy in one piece.
#[inline(always)]
pub(crate) fn lent<T: Real>(force: &ContactForce<T>) -> ContactForce<T> {
    let [x, y, z] = force.tangential.vector().into();
    let tangential = TangentialForce::of_magnitude(Vector3::new(x, y, z), force.tangential.magnitude());
    ContactForce { normal: force.normal, tangential, spin: force.spin }
}
