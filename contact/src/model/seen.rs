//! The crossings of a line of action that are no contact, and why.

use fingertip_surfaces::Crossing;
use fingertip_surfaces::numeric::vectors::{in_range, larger, smaller};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::NoContact;

/// Friction can't hold a force at this cosine of incidence.
pub(super) fn too_flat<T: Real>(point: Vector3<T>, incidence: T) -> NoContact<T> {
    let sine = larger((T::one() - incidence) * (T::one() + incidence), T::zero()).root();
    NoContact::BeyondFriction { point, friction_ratio: smaller(sine / incidence, T::GREATEST) }
}

/// What has been seen of the crossings so far.
pub(super) struct Seen<T: Real> {
    pub(super) best: Option<(Crossing<T>, T)>,
    pub(super) candidates: u8,
    pub(super) too_flat: Option<(Vector3<T>, T)>,
    pub(super) tangent: Option<Crossing<T>>,
    pub(super) pulling: Option<Vector3<T>>,
    pub(super) outside: Option<Vector3<T>>,
}

impl<T: Real> Seen<T> {
    /// Takes note of why a crossing is no contact.
    #[inline(never)]
    pub(super) fn refuse(&mut self, crossing: &Crossing<T>, incidence: T) {
        if !in_range(&crossing.point) {
            return;
        }
        if !crossing.active {
            self.outside = Some(crossing.point);
        } else if !(incidence > T::zero()) {
            if incidence >= -T::EPSILON * T::literal(64.0) {
                self.tangent = Some(*crossing);
            }
            self.pulling = Some(crossing.point);
        } else if self.too_flat.is_none_or(|(_, best)| incidence > best) {
            self.too_flat = Some((crossing.point, incidence));
        }
    }

    /// Why none of the crossings is a contact; `None` if there was none at all.
    #[cold]
    pub(super) fn reason(&self) -> Option<NoContact<T>> {
        if let Some((point, incidence)) = self.too_flat {
            return Some(too_flat(point, incidence));
        }
        if let Some(point) = self.pulling {
            return Some(NoContact::OnlyPulling { point });
        }
        self.outside.map(|point| NoContact::OutsideActiveRegion { point })
    }
}
