//! The bound that needs nothing but a contact.

use fingertip_wrench::Real;

use crate::Contact;

/// How far a point contact moves at most, to first order, when the force is off by at most
/// `force_error` \[N\] and the torque about the origin by at most `torque_error` \[N·m\], in any
/// direction: `(|δm| + |c||δf|)/(|f| cos φ)` \[m\] (theory 2.2).
///
/// It holds for every surface: the line of action moves by no more than `|δm − c × δf|/|f|` at
/// the contact, and the surface cuts it at the angle `φ`. A sphere around the origin attains it.
/// Infinite where the force grazes.
#[must_use]
pub fn ball_bound<T: Real>(contact: &Contact<T>, force_error: T, torque_error: T) -> T {
    let scale = contact.force.amax().normalising_factor();
    let force = (contact.force * scale).norm_squared().root() / scale;
    let reach = contact.point.amax().normalising_factor();
    let distance = (contact.point * reach).norm_squared().root() / reach;
    let bound = (torque_error + distance * force_error) / (force * contact.incidence);
    if bound.is_number() { bound } else { T::one() / T::zero() }
}
