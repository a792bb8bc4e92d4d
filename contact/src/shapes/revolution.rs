//! The surface of revolution.

use fingertip_surfaces::{Knot, Revolution, SmoothSurface};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::soft_finger::double::spins_little;
use crate::soft_finger::refined::settled;
use crate::{Patch, Search, SoftContact, SoftFingerSurface, newton_soft_contacts};

/// More contacts than that are not told apart.
const MOST: usize = 16;

/// Contacts past the ends of the profile, where a flat end would be met, are not active.
impl<T: Real, K: AsRef<[Knot<T>]>> SoftFingerSurface<T> for Revolution<T, K> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let (low, high) = match self.knots() {
            [low, .., high] => (low.point()[0], high.point()[0]),
            _ => return Search::Complete,
        };
        let reach = self.extent().radius;
        let spins_little = spins_little(wrench, reach);
        let mut spun: [Option<Vector3<T>>; MOST] = [None; MOST];
        newton_soft_contacts(self, wrench, last, |rough| {
            let mut contact = rough;
            // Where the profile is straight rounding under a large spin torque moves contacts past its ends, and
            // one may have been found as several.
            if !spins_little(&rough) {
                contact = settled(wrench, self, &rough).unwrap_or(rough);
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

    fn patch(&self, point: &Vector3<T>) -> Option<Patch> {
        self.local_surface_at(point.z).map(Patch::from)
    }
}
