//! A surface chosen at run time.

use fingertip_surfaces::{DynSurface, ForceLine, Parts, each_surface};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::combinators::{is_covered, of_both};
use crate::{Search, SoftContact, SoftFingerSurface};

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

    fn patch(&self, point: &Vector3<T>) -> Option<fingertip_surfaces::LocalSurface> {
        each_surface!(self, shape => shape.patch(point))
    }

    #[inline]
    fn sole_soft_contact(&self, push: &ForceLine<T>) -> Option<SoftContact<T>> {
        each_surface!(self, shape => shape.sole_soft_contact(push))
    }
}

impl<T: Real> SoftFingerSurface<T> for Parts<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let mut search = Search::Complete;
        let mut seen = false;
        for (k, part) in self.parts.iter().enumerate() {
            let of_part = part.soft_contacts(wrench, last, |contact| {
                let mut others = self.parts.iter().enumerate().filter(|(other, _)| *other != k);
                if !others.any(|(other, part)| is_covered(part, &contact, other > k)) {
                    seen = true;
                    visit(contact);
                }
            });
            search = of_both(search, of_part, false);
        }
        if seen { of_both(search, Search::Complete, true) } else { search }
    }
}
