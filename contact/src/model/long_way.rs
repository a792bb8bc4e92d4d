//! Where the short way does not lead to a contact.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::{Contact, Resolution};

/// Takes a long way, kept out of line, such that a contact that is found the short way never goes
/// through memory on its way to friction: what the two share would.
#[inline(always)]
pub(crate) fn long_way<T: Real>(
    wrench: &Wrench<T>,
    resolve: impl FnOnce(&Wrench<T>) -> Resolution<T>,
) -> Resolution<T> {
    let copy = Wrench::on_fingertip(by_components(&wrench.force()), by_components(&wrench.torque()));
    match resolve(&copy) {
        Resolution::Contact(contact) => Resolution::Contact(Contact {
            point: by_components(&contact.point),
            normal: by_components(&contact.normal),
            force: by_components(&contact.force),
            ..contact
        }),
        none => none,
    }
}

/// The same vector. A compiler that sees one block of memory copied hands that memory on, and the short
/// way would have to go through it as well.
#[inline(always)]
fn by_components<T: Real>(v: &Vector3<T>) -> Vector3<T> {
    Vector3::new(v.x, v.y, v.z)
}
