//! Shapes that are given by an equation.

use fingertip_surfaces::{Implicit, ImplicitSurface};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::{Search, SoftContact, SoftFingerSurface, newton_soft_contacts};

impl<T: Real, S: ImplicitSurface<T>> SoftFingerSurface<T> for Implicit<T, S> {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        newton_soft_contacts(self, wrench, last, visit)
    }
}
