//! From wrench and surface to contact.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::Resolution;

/// An assumption about what the contact can transmit, and how to find the contact under it.
pub trait ContactModel<T: Real, S> {
    /// The contact that explains the wrench. `last` is the contact point of the sample before, if
    /// the caller wants continuity where several points explain the wrench.
    fn resolve_near(&self, wrench: &Wrench<T>, surface: &S, last: Option<&Vector3<T>>) -> Resolution<T>;

    /// The contact that explains the wrench.
    #[inline]
    fn resolve(&self, wrench: &Wrench<T>, surface: &S) -> Resolution<T> {
        self.resolve_near(wrench, surface, None)
    }
}
