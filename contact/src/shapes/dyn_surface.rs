//! A surface chosen at run time.

use fingertip_surfaces::{DynSurface, ForceLine, each_surface};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use crate::{GeometrySensitivity, Patch, Search, SoftContact, SoftFingerSurface};

impl<T: Real> SoftFingerSurface<T> for DynSurface<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let visit: &mut dyn FnMut(SoftContact<T>) = &mut visit;
        each_surface!(self, shape => shape.soft_contacts(wrench, last, visit))
    }

    fn patch(&self, point: &Vector3<T>) -> Option<Patch> {
        each_surface!(self, shape => shape.patch(point))
    }

    #[inline]
    fn sole_soft_contact(&self, push: &ForceLine<T>) -> Option<SoftContact<T>> {
        each_surface!(self, shape => shape.sole_soft_contact(push))
    }

    fn sole_soft_contact_in_double(&self, wrench: &Wrench<f64>) -> Option<SoftContact<f64>> {
        each_surface!(self, shape => shape.sole_soft_contact_in_double(wrench))
    }

    fn posed_soft_contacts_in_double(
        &self,
        wrench: &Wrench<f64>,
        pose: &RigidTransform<T>,
        visit: &mut dyn FnMut(SoftContact<f64>),
    ) -> Option<Search<f64>> {
        each_surface!(self, shape => shape.posed_soft_contacts_in_double(wrench, pose, visit))
    }

    fn with_more_digits(
        &self,
        wrench: &Wrench<T>,
        pose: Option<&RigidTransform<T>>,
        found: Result<SoftContact<T>, Search<T>>,
    ) -> Result<SoftContact<T>, Search<T>> {
        each_surface!(self, shape => shape.with_more_digits(wrench, pose, found))
    }

    fn sensitivity(&self, size: usize, point: &Vector3<T>) -> Option<GeometrySensitivity<T>> {
        each_surface!(self, shape => shape.sensitivity(size, point))
    }
}
