//! More grip where there is room for it.

use fingertip_wrench::{ContactForce, Frame, Real};

use crate::{FingerLimits, Grasp};

/// The normal forces of `forces`, which hold a load, with their internal part made as large as limits and friction allow, up
/// to `most` times. The load is held as before, since internal forces cancel; limits are half-spaces and friction is a cone,
/// so that what both ends keep is kept between them (`docs/theory/hand.md#without-safety`).
pub(crate) fn squeezed<T: Real, const N: usize, const ROWS: usize, F: Frame>(
    grasp: &Grasp<T, N, F>,
    limits: &[FingerLimits<T, ROWS>; N],
    forces: &[ContactForce<T>; N],
    most: T,
) -> [T; N] {
    let more = grasp.split(forces).internal;
    let touching = || {
        let each = grasp.contacts().iter().zip(limits).zip(forces.iter().zip(&more));
        each.filter_map(|((contact, limits), forces)| Some((contact.as_ref()?, limits, forces)))
    };
    let times = touching().fold(most - T::one(), |times, (contact, limits, (force, more))| {
        times.min(limits.room(contact, force, more))
    });
    let kept = touching().all(|(contact, _, (force, more))| {
        let used = contact.scaled(force) + contact.scaled(more) * times;
        used.fixed_rows::<3>(1).norm() <= used.x
    });
    let mut normal = forces.map(|force| force.normal);
    if kept {
        normal.iter_mut().zip(&more).for_each(|(normal, more)| *normal += more.normal * times);
    }
    normal
}
