//! From wrench and surface to contact.

use fingertip_wrench::{ContactForce, Real, Wrench};
use nalgebra::Vector3;

use crate::{Contact, Resolution};

/// An assumption about what the contact can transmit, and how to find the contact under it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` finds no contact of `{T}` on `{S}`",
    note = "a point contact takes any `ActiveSurface`, a soft finger any `SoftFingerSurface`; both must be of one scalar"
)]
pub trait ContactModel<T: Real, S> {
    /// The contact that explains the wrench. `last` is the contact point of the sample before, if
    /// the caller wants continuity where several points explain the wrench.
    fn resolve_near(&self, wrench: &Wrench<T>, surface: &S, last: Option<&Vector3<T>>) -> Resolution<T>;

    /// [`resolve_near`](Self::resolve_near), and the force of the contact split at its tangent plane, of
    /// which the way to the contact may know more than [`Contact::contact_force`](crate::Contact::contact_force)
    /// can tell afterwards. `None` without a contact.
    #[inline(always)]
    fn feel_near(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
    ) -> (Resolution<T>, Option<ContactForce<T>>) {
        let resolution = self.resolve_near(wrench, surface, last);
        let force = resolution.contact().map(Contact::contact_force);
        (resolution, force)
    }

    /// The contact that explains the wrench.
    #[inline]
    fn resolve(&self, wrench: &Wrench<T>, surface: &S) -> Resolution<T> {
        self.resolve_near(wrench, surface, None)
    }
}
