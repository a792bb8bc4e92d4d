//! Smooth shapes without a closed form.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::closed_form::{is_active, soft_finger};
use crate::{Search, SoftContact, SoftFingerSurface, newton_soft_contacts};
use fingertip_surfaces::numeric::vectors::wide;
use fingertip_surfaces::{Implicit, ImplicitSurface, LocalSurface, Paraboloid, Superquadric};

// The first is active all over.
soft_finger!(
    Superquadric,
    |shape, wrench, last, visit| newton_soft_contacts(shape, wrench, last, visit),
    patch | shape,
    _ | {
        // Of a shape in double precision there is no more to be had.
        let narrow = T::EPSILON.to_f64() > f64::EPSILON;
        let double =
            narrow.then(|| Superquadric::new(wide(&shape.semi_axes()), shape.exponents().map(Real::to_f64)));
        double.and_then(Result::ok).map(LocalSurface::Superquadric)
    }
);

soft_finger!(Paraboloid, |shape, wrench, last, visit| {
    newton_soft_contacts(shape, wrench, last, |contact| {
        visit(SoftContact { active: is_active(shape, &contact), ..contact });
    })
});

impl<T: Real, S: ImplicitSurface<T>> SoftFingerSurface<T> for Implicit<S> {
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
