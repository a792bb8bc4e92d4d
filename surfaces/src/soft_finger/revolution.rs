//! The surface of revolution.

use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix3, Vector3};

use super::double::spins_little;
use super::refined::settled;
use crate::{
    Extent, Knot, Level, Patch, Revolution, Search, SmoothSurface, SoftContact, SoftFingerSurface, Topology,
    newton_soft_contacts,
};

/// More contacts than that are not told apart.
const MOST: usize = 16;

/// `x² + y² − ρ²(z)`, piece by piece; beyond the ends of the profile `ρ²` goes on straight, which
/// keeps a convex profile convex. The curvature jumps where pieces meet; the flat ends are not part
/// of the level function.
impl<T: Real, K: AsRef<[Knot<T>]>> SmoothSurface<T> for Revolution<T, K> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let [squared, slope, curvature] = self.profile(point.z);
        let two = T::one() + T::one();
        Level {
            value: point.x * point.x + point.y * point.y - squared,
            gradient: Vector3::new(two * point.x, two * point.y, -slope),
            hessian: Matrix3::from_diagonal(&Vector3::new(two, two, -curvature)),
        }
    }

    fn extent(&self) -> Extent<T> {
        let (centre, radius) = self.bounds();
        Extent { centre, radius }
    }

    fn topology(&self) -> Topology {
        if self.is_convex() { Topology::Convex } else { Topology::Unknown }
    }
}

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
        self.patch_at(point.z)
    }
}
