//! From a wrench to the contact of a soft finger, or the reason why there is none.

use fingertip_surfaces::ForceLine;
use fingertip_surfaces::numeric::mixed_precision::is_asked_again;
use fingertip_surfaces::numeric::vectors::{hypotenuse, is_tame, larger, largest, rarely_length, smaller};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;

use super::closed_form::is_pure_force;
use super::double::{narrow, widened};
use super::refined::refined;
use crate::model::long_way;
use crate::{
    Contact, ContactModel, NoContact, Resolution, Search, SoftContact, SoftFinger, SoftFingerSurface,
};

/// What has been seen of the solutions so far.
struct Seen<T: Real> {
    best: Option<(SoftContact<T>, T)>,
    candidates: u8,
    /// A place outside the active region, if friction holds it there.
    outside: Option<Vector3<T>>,
    /// One that friction does not hold.
    outside_too_flat: Option<Vector3<T>>,
    /// Of the contacts that friction can't hold the one that needs least, and how much.
    too_flat: Option<(Vector3<T>, T)>,
    beyond_range: bool,
}

impl<T: Real, S: SoftFingerSurface<T>> ContactModel<T, S> for SoftFinger<T> {
    /// Always in line, with the long way kept out of the registers.
    #[inline(always)]
    fn resolve_near(&self, wrench: &Wrench<T>, surface: &S, last: Option<&Vector3<T>>) -> Resolution<T> {
        if let Some(push) = ForceLine::new(wrench, self.least_squared)
            && let Some(contact) = surface.sole_soft_contact(&push)
            && contact.active
            && is_in_range(&contact)
        {
            return Resolution::Contact(contact_at(wrench, &contact, contact.spin_torque));
        }
        long_way(wrench, |copy| self.resolve_any(copy, surface, last))
    }
}

/// A wrench whose squares stay within the range of the type, times a factor if that was needed.
struct Scaled<T: Real> {
    wrench: Wrench<T>,
    unit: Option<T>,
}

impl<T: Real> Scaled<T> {
    /// A torque of the wrench as it was told.
    fn back(&self, torque: T) -> T {
        self.unit.map_or(torque, |unit| (torque / unit).max(-T::GREATEST).min(T::GREATEST))
    }
}

impl<T: Real> SoftFinger<T> {
    /// The friction ratio that a contact needs, if that is more than there is.
    fn beyond_friction(&self, force: &Vector3<T>, contact: &SoftContact<T>) -> Option<T> {
        let greatest = self.greatest_friction?;
        let pressing = -force.dot(&contact.normal);
        // Far from the limit, and of squares within the range; where it is near, the limit itself is asked.
        let squared = pressing * pressing;
        let most = (greatest * greatest + T::one()) * squared * T::literal(0.99);
        let tame = (squared >= T::LEAST_NORMAL) & (most <= T::GREATEST) & (pressing > T::zero());
        if tame && self.torque_arm.is_none() && force.norm_squared() <= most {
            return None;
        }
        let sliding = rarely_length(&(force + contact.normal * pressing));
        let turning = self.torque_arm.map_or_else(T::zero, |arm| contact.spin_torque / arm);
        let needed = hypotenuse(sliding, if turning.is_number() { turning } else { T::GREATEST });
        (!(needed <= greatest * pressing)).then(|| smaller(needed / pressing, T::GREATEST))
    }

    /// The long way.
    #[inline(never)]
    fn resolve_any<S: SoftFingerSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
    ) -> Resolution<T> {
        let scaled = match self.tame(wrench).unwrap_or_else(|| self.scaled(wrench)) {
            Ok(scaled) => scaled,
            Err(reason) => return Resolution::NoContact(reason),
        };
        if is_asked_again::<T>()
            && let Some(contact) = self.in_double(wrench, &scaled, surface)
        {
            return Resolution::Contact(contact);
        }
        let found = self.search(wrench, &scaled, surface, last);
        if self.torque_noise.is_zero() { found } else { self.either_side(found, &scaled, surface) }
    }

    /// The one contact in closed form, in double precision: for a narrower type, which has no more digits to be refined to.
    /// `None` says nothing.
    #[inline(never)]
    fn in_double<S: SoftFingerSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        scaled: &Scaled<T>,
        surface: &S,
    ) -> Option<Contact<T>> {
        if !self.torque_noise.is_zero() {
            return None;
        }
        let contact = narrow(&surface.sole_soft_contact_in_double(&widened(&scaled.wrench))?);
        let is_told = contact.active
            && is_in_range(&contact)
            && self.beyond_friction(&scaled.wrench.force(), &contact).is_none();
        is_told.then(|| contact_at(wrench, &contact, scaled.back(contact.spin_torque)))
    }

    /// A wrench that needs no factor, or why it is no contact; `None` of another.
    fn tame(&self, wrench: &Wrench<T>) -> Option<Result<Scaled<T>, NoContact<T>>> {
        let (force, torque) = (wrench.force(), wrench.torque());
        let most_torque = largest(&torque);
        if !(is_tame(largest(&force)) && (is_tame(most_torque) || most_torque.is_zero())) {
            return None;
        }
        let squared = force.norm_squared();
        // A NaN may have hidden behind a number.
        (squared + torque.x + torque.y + torque.z).is_number().then(|| {
            if squared >= self.least_force * self.least_force {
                Ok(Scaled { wrench: *wrench, unit: None })
            } else {
                Err(NoContact::BelowThreshold { force: squared.root() })
            }
        })
    }

    /// Tiny, huge, zero, NaN.
    #[cold]
    #[inline(never)]
    fn scaled(&self, wrench: &Wrench<T>) -> Result<Scaled<T>, NoContact<T>> {
        if !wrench.is_finite() {
            return Err(NoContact::NotFinite);
        }
        let (force, torque) = (rarely_length(&wrench.force()), rarely_length(&wrench.torque()));
        if !(force >= self.least_force) || !(force > T::zero()) {
            return Err(if force > T::zero() || torque.is_zero() {
                NoContact::BelowThreshold { force }
            } else {
                NoContact::PureCouple { torque }
            });
        }
        let unit = larger(largest(&wrench.force()), largest(&wrench.torque())).normalising_factor();
        Ok(Scaled { wrench: *wrench * unit, unit: Some(unit) })
    }

    #[inline(never)]
    fn search<S: SoftFingerSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        scaled: &Scaled<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
    ) -> Resolution<T> {
        let mut seen = Seen::new();
        let search = self.look(&scaled.wrench, surface, last, &mut seen);
        if let Some((contact, _)) = seen.best {
            let contact = refined(&scaled.wrench, surface, &contact);
            let spin_torque = scaled.back(contact.spin_torque);
            let found = contact_at(wrench, &contact, spin_torque);
            let searched = matches!(search, Search::Uncertified);
            return Resolution::Contact(Contact { alternatives: seen.candidates - 1, searched, ..found });
        }
        Resolution::NoContact(if seen.beyond_range {
            NoContact::NotFinite
        } else if let Some(point) = seen.outside {
            NoContact::OutsideActiveRegion { point }
        } else {
            // A pure force is told by the crossings of its line, of which none is missing.
            let is_told = || is_pure_force(&wrench.force(), &wrench.torque());
            match (search, seen.too_flat, seen.outside_too_flat) {
                (Search::Complete | Search::Uncertified, Some((point, friction_ratio)), _) => {
                    NoContact::BeyondFriction { point, friction_ratio }
                }
                (_, _, Some(point)) => NoContact::OutsideActiveRegion { point },
                (Search::Grazing([first, second]), ..) => NoContact::Ambiguous { first, second },
                (Search::Incomplete, ..) => NoContact::Unresolved,
                (Search::Uncertified, ..) if !is_told() => NoContact::Unresolved,
                (Search::Complete | Search::Uncertified, ..) => why_none(wrench, surface),
            }
        })
    }

    /// Sees all solutions of a wrench.
    fn look<S: SoftFingerSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
        seen: &mut Seen<T>,
    ) -> Search<T> {
        let direction = wrench.force();
        surface.soft_contacts(wrench, last, |contact| {
            if !is_in_range(&contact) {
                seen.beyond_range = true;
                return;
            }
            let beyond = self.beyond_friction(&direction, &contact);
            if !contact.active {
                let place = if beyond.is_some() { &mut seen.outside_too_flat } else { &mut seen.outside };
                *place = Some(contact.point);
                return;
            }
            if let Some(ratio) = beyond {
                if seen.too_flat.is_none_or(|(_, least)| ratio < least) {
                    seen.too_flat = Some((contact.point, ratio));
                }
                return;
            }
            seen.candidates = seen.candidates.saturating_add(1);
            let incidence = -direction.dot(&contact.normal);
            let better = match (&seen.best, last) {
                (None, _) => true,
                (Some((best, _)), Some(last)) => {
                    (contact.point - last).norm_squared() < (best.point - last).norm_squared()
                }
                (Some((_, best)), None) => incidence > *best,
            };
            if better {
                seen.best = Some((contact, incidence));
            }
        })
    }

    /// Where a line of action misses and the torque along the force is within the noise: the contact that was found, and
    /// the one of the opposite torque along the force.
    #[cold]
    #[inline(never)]
    fn either_side<S: SoftFingerSurface<T>>(
        &self,
        found: Resolution<T>,
        scaled: &Scaled<T>,
        surface: &S,
    ) -> Resolution<T> {
        let noise = self.torque_noise * scaled.unit.unwrap_or_else(T::one);
        let (force, torque) = (scaled.wrench.force(), scaled.wrench.torque());
        if !(force.dot(&torque).abs() <= noise * rarely_length(&force)) {
            return found;
        }
        let Some(first) =
            place(&found).filter(|_| !met(&scaled.wrench, surface).is_some_and(|met| met.entered))
        else {
            return found;
        };
        let opposite = Scaled { wrench: mirrored(&scaled.wrench), unit: scaled.unit };
        match place(&self.search(&opposite.wrench, &opposite, surface, None)) {
            Some(second) => Resolution::NoContact(NoContact::Ambiguous { first, second }),
            None => found,
        }
    }
}

/// Where a contact is, or would be if friction held it.
fn place<T: Real>(resolution: &Resolution<T>) -> Option<Vector3<T>> {
    match resolution {
        Resolution::Contact(contact) => Some(contact.point),
        Resolution::NoContact(NoContact::BeyondFriction { point, .. }) => Some(*point),
        Resolution::NoContact(_) => None,
    }
}

/// The wrench with the opposite torque along its force.
pub(crate) fn mirrored<T: Real>(wrench: &Wrench<T>) -> Wrench<T> {
    let (force, torque) = (wrench.force(), wrench.torque());
    let direction = force / rarely_length(&force);
    let along = direction.dot(&torque);
    Wrench::on_fingertip(force, torque - direction * (along + along))
}

impl<T: Real> Seen<T> {
    fn new() -> Self {
        Self {
            best: None,
            candidates: 0,
            outside: None,
            outside_too_flat: None,
            too_flat: None,
            beyond_range: false,
        }
    }
}

#[inline]
pub(crate) fn is_in_range<T: Real>(contact: &SoftContact<T>) -> bool {
    let c = contact.point;
    (c.x + c.y + c.z + contact.spin_torque).is_number()
}

#[inline]
fn contact_at<T: Real>(wrench: &Wrench<T>, found: &SoftContact<T>, spin_torque: T) -> Contact<T> {
    Contact {
        point: found.point,
        normal: found.normal,
        force: wrench.force(),
        spin_torque,
        gap: T::zero(),
        alternatives: 0,
        searched: false,
    }
}

/// What the line of action of a wrench meets.
struct Met<T: Real> {
    line: Line<T>,
    /// Whether it enters the active surface.
    entered: bool,
    /// A place where it leaves, and so pulls.
    left: Option<Vector3<T>>,
}

/// Compiled once for whoever asks, which few samples do.
#[cold]
#[inline(never)]
fn met<T: Real, S: SoftFingerSurface<T>>(wrench: &Wrench<T>, surface: &S) -> Option<Met<T>> {
    let line = wrench.line_of_action().ok()?.line;
    let (entered, left) = surface.entered_and_left(&line);
    Some(Met { line, entered, left })
}

/// The line of action misses, or meets the surface where it pulls.
#[cold]
fn why_none<T: Real, S: SoftFingerSurface<T>>(wrench: &Wrench<T>, surface: &S) -> NoContact<T> {
    match met(wrench, surface) {
        None => NoContact::NotFinite,
        Some(Met { left: Some(point), .. }) => NoContact::OnlyPulling { point },
        Some(met) => NoContact::Misses { closest: surface.closest_approach(&met.line) },
    }
}
