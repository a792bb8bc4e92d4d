//! The surface of revolution.

use fingertip_surfaces::{Knot, Profile, Revolution, SmoothSurface};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use crate::soft_finger::double::{Moved, spins_little};
use crate::soft_finger::refined::settled;
use crate::{Patch, Search, SoftContact, SoftFingerSurface, newton_soft_contacts};

/// More contacts than that are not told apart.
const MOST: usize = 16;

fn patch<T: Real, K: Profile<T>>(shape: &Revolution<T, K>, point: &Vector3<T>) -> Option<Patch> {
    shape.local_surface_at(point.z).map(Patch::from)
}

/// By Newton's method, and where the spin torque is large from there to the last digit.
fn search<T: Real, K: Profile<T>>(
    shape: &Revolution<T, K>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
    visit: &mut dyn FnMut(SoftContact<T>),
) -> Search<T> {
    let Some([low, high]) = shape.heights() else { return Search::Complete };
    let reach = shape.extent().radius;
    let spins_little = spins_little(wrench, reach);
    let mut spun: [Option<Vector3<T>>; MOST] = [None; MOST];
    newton_soft_contacts(shape, wrench, last, |rough| {
        let mut contact = rough;
        // Where the profile is straight rounding under a large spin torque moves contacts past its ends, and
        // one may have been found as several.
        if !spins_little(&rough) {
            contact = settled(wrench, &|point| patch(shape, point), &rough).unwrap_or(rough);
            let close = T::EPSILON * T::literal(64.0) * reach;
            let is_known = |known: &Vector3<T>| (known - contact.point).amax() <= close;
            if spun.iter().flatten().any(is_known) {
                return;
            }
            if let Some(free) = spun.iter_mut().find(|slot| slot.is_none()) {
                *free = Some(contact.point);
            }
        }
        let active = contact.point.z >= low && contact.point.z <= high;
        visit(SoftContact { active, ..contact });
    })
}

/// Contacts past the ends of the profile, where a flat end would be met, are not active.
impl<T: Real, K: AsRef<[Knot<T>]>> SoftFingerSurface<T> for Revolution<T, K> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        search(self, wrench, last, &mut visit)
    }

    fn posed_soft_contacts_in_double(
        &self,
        wrench: &Wrench<f64>,
        pose: &RigidTransform<T>,
        visit: &mut dyn FnMut(SoftContact<f64>),
    ) -> Option<Search<f64>> {
        let double = self.in_double();
        Moved::new(pose).all(wrench, |inside, found| Some(search(&double, inside, None, found)), visit)
    }

    fn patch(&self, point: &Vector3<T>) -> Option<Patch> {
        patch(self, point)
    }
}
