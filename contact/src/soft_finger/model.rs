//! The soft finger as a contact model.

use fingertip_surfaces::numeric::vectors::{hypotenuse, is_tame, larger, largest, length, smaller};
use fingertip_surfaces::{BadShape, ForceLine};
use fingertip_wrench::{Real, Wrench, stored};
use nalgebra::Vector3;

use super::refined::refined;
use crate::model::long_way;
use crate::{Contact, ContactModel, NoContact, Resolution, Search, SoftContact, SoftFingerSurface};

/// A contact that transmits a force and a torque about the normal: `m = c × f + τ n`, `c` on the
/// surface, `f·n < 0` (Bicchi, Salisbury & Brock 1990, 1993).
///
/// The point is the contact centroid: for a patch on a plane, or one that is small against the
/// radius of curvature, the centre of pressure, whatever the friction (on a sphere, up to
/// 0.06 a²/R for a patch of radius `a` at a friction coefficient of 0.5;
/// `docs/theory/contact.md#contact-centroid`).
///
/// On a convex surface there is at most one such point; a shape that is not convex may have
/// several, and [`Contact::alternatives`] counts the others. Those that would need more friction than
/// [`with_greatest_friction`](Self::with_greatest_friction) allows are set aside. Of the rest the one
/// nearest to the last contact is taken if one is given, otherwise the one where the force presses most
/// squarely.
///
/// Where a body has a round edge of no thickness, a corner or a tip, a contact there has a normal
/// between those of the faces that meet, such that something flat could touch. Meshes and heightfields
/// are taken for the bodies of facets that they are.
///
/// Against [`PointContact`](crate::PointContact): it is right where there is a spin torque, and
/// noisier where there is none, since it takes every torque along the force for spin
/// (`docs/theory/contact.md#errors-of-a-soft-finger`; the factor is the tangent of the angle between force
/// and normal). [`Auto`](crate::Auto) chooses.
///
/// What is no contact is said by type: [`NoContact::PureCouple`] where there is a torque but no
/// force, [`NoContact::Ambiguous`] where a pure force could only graze the surface at two points,
/// [`NoContact::BeyondFriction`] where friction, if it is stated, holds no contact,
/// [`NoContact::Unresolved`] where a search ended at its bound, or rounding of the wrench hides whether
/// there is a contact, as of a needle under a large spin torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftFinger<T: Real> {
    least_force: T,
    /// The least square of a force that takes the short way.
    least_squared: T,
    greatest_friction: Option<T>,
    torque_arm: Option<T>,
}

impl<T: Real> SoftFinger<T> {
    /// Forces below `least_force` \[N\] are no contact. Take it from the noise of the sensor: three
    /// to five standard deviations of the force at rest. Zero accepts every force but zero.
    ///
    /// # Errors
    /// [`BadShape`] unless the threshold is finite and not negative.
    pub fn new(least_force: T) -> Result<Self, BadShape> {
        let good = least_force >= T::zero() && least_force.is_number();
        BadShape::check("soft finger", "least force", "finite and not negative", good).map(|()| Self {
            least_force,
            least_squared: larger(least_force * least_force, ForceLine::least_squared()),
            greatest_friction: None,
            torque_arm: None,
        })
    }

    /// No contact needs a friction ratio above `greatest_friction`, and with a
    /// [torque arm](Self::with_torque_arm) none needs more for its force and spin torque together:
    /// `√(|f_t|² + (τ/e)²) ≤ μ f_n` (`docs/theory/friction.md#soft-finger-limit`).
    ///
    /// State it wherever wrenches may miss; there is none unless it is stated. Without it the noise of a pure force
    /// whose line misses is taken for a spin torque, and explained by a contact that next to nothing presses: a force
    /// of 2 N that passes the centre of a sphere of 13 mm at 14 mm, with 1e-9 N·m along it, would press with 2e-7 N
    /// and spin with 10 mN·m. With it the answer follows from what friction can hold, and not from the last digits of
    /// `f·m`. It may be generous: no finger holds a ratio of 10.
    ///
    /// Models without it take a shorter way to simple shapes.
    ///
    /// # Errors
    /// [`BadShape`] unless it is finite and not negative.
    pub fn with_greatest_friction(self, greatest_friction: T) -> Result<Self, BadShape> {
        let good = greatest_friction >= T::zero() && greatest_friction.is_number();
        BadShape::check("soft finger", "greatest friction", "finite and not negative", good)
            // No force takes the short way, which looks at no limit.
            .map(|()| Self { greatest_friction: Some(greatest_friction), least_squared: T::GREATEST, ..self })
    }

    /// The torque arm `e` \[m\] of the contact, by which a spin torque counts as a tangential force: `3πa/16` for
    /// Hertz's patch of radius `a`, and never more than the radius of the patch. It has a say together with
    /// [`with_greatest_friction`](Self::with_greatest_friction) only.
    ///
    /// # Errors
    /// [`BadShape`] unless it is positive and finite.
    pub fn with_torque_arm(self, torque_arm: T) -> Result<Self, BadShape> {
        let good = torque_arm > T::zero() && torque_arm.is_number();
        BadShape::check("soft finger", "torque arm", "positive and finite", good)
            .map(|()| Self { torque_arm: Some(torque_arm), ..self })
    }

    /// The greatest friction ratio that a contact may need, if there is a limit.
    #[inline]
    #[must_use]
    pub const fn greatest_friction(&self) -> Option<T> {
        self.greatest_friction
    }

    /// The torque arm \[m\], if one is stated.
    #[inline]
    #[must_use]
    pub const fn torque_arm(&self) -> Option<T> {
        self.torque_arm
    }

    /// The friction ratio that a contact needs, if that is more than there is.
    fn beyond_friction(&self, force: &Vector3<T>, contact: &SoftContact<T>) -> Option<T> {
        let greatest = self.greatest_friction?;
        let pressing = -force.dot(&contact.normal);
        let sliding = length(&(force + contact.normal * pressing));
        let turning = self.torque_arm.map_or_else(T::zero, |arm| contact.spin_torque / arm);
        let needed = hypotenuse(sliding, if turning.is_number() { turning } else { T::GREATEST });
        (!(needed <= greatest * pressing)).then(|| smaller(needed / pressing, T::GREATEST))
    }

    /// The least force that counts as a contact \[N\].
    #[inline]
    #[must_use]
    pub const fn least_force(&self) -> T {
        self.least_force
    }
}

/// What has been seen of the solutions so far.
struct Seen<T: Real> {
    best: Option<(SoftContact<T>, T)>,
    candidates: u8,
    outside: Option<Vector3<T>>,
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

impl<T: Real> SoftFinger<T> {
    /// The long way.
    #[inline(never)]
    fn resolve_any<S: SoftFingerSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
    ) -> Resolution<T> {
        let most_torque = largest(&wrench.torque());
        if is_tame(largest(&wrench.force())) && (is_tame(most_torque) || most_torque.is_zero()) {
            let squared = wrench.force().norm_squared();
            // A NaN may have hidden behind a number.
            let torque = wrench.torque();
            if (squared + torque.x + torque.y + torque.z).is_number() {
                if !(squared >= self.least_force * self.least_force) {
                    return Resolution::NoContact(NoContact::BelowThreshold { force: squared.root() });
                }
                let scaled = Scaled { wrench: *wrench, unit: None };
                return self.search(wrench, &scaled, surface, last);
            }
        }
        self.resolve_extreme(wrench, surface, last)
    }

    /// Tiny, huge, zero, NaN.
    #[cold]
    #[inline(never)]
    fn resolve_extreme<S: SoftFingerSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
    ) -> Resolution<T> {
        if !wrench.is_finite() {
            return Resolution::NoContact(NoContact::NotFinite);
        }
        let (force, torque) = (length(&wrench.force()), length(&wrench.torque()));
        if !(force >= self.least_force) || !(force > T::zero()) {
            return Resolution::NoContact(if force > T::zero() || torque.is_zero() {
                NoContact::BelowThreshold { force }
            } else {
                NoContact::PureCouple { torque }
            });
        }
        let unit = larger(largest(&wrench.force()), largest(&wrench.torque())).normalising_factor();
        let scaled = *wrench * unit;
        let scaled = Scaled { wrench: scaled, unit: Some(unit) };
        self.search(wrench, &scaled, surface, last)
    }

    fn search<S: SoftFingerSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        scaled: &Scaled<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
    ) -> Resolution<T> {
        let direction = scaled.wrench.force();
        let mut seen = Seen { best: None, candidates: 0, outside: None, too_flat: None, beyond_range: false };
        let search = surface.soft_contacts(&scaled.wrench, last, |contact| {
            if !is_in_range(&contact) {
                seen.beyond_range = true;
                return;
            }
            if !contact.active {
                seen.outside = Some(contact.point);
                return;
            }
            if let Some(ratio) = self.beyond_friction(&direction, &contact) {
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
        });
        if let Some((contact, _)) = seen.best {
            let contact = refined(&scaled.wrench, surface, &contact);
            let spin_torque = scaled.unit.map_or(contact.spin_torque, |unit| {
                (contact.spin_torque / unit).max(-T::GREATEST).min(T::GREATEST)
            });
            let found = contact_at(wrench, &contact, spin_torque);
            return Resolution::Contact(Contact { alternatives: seen.candidates - 1, ..found });
        }
        if seen.beyond_range {
            return Resolution::NoContact(NoContact::NotFinite);
        }
        if let (Some((point, friction_ratio)), Search::Complete) = (seen.too_flat, search) {
            return Resolution::NoContact(NoContact::BeyondFriction { point, friction_ratio });
        }
        Resolution::NoContact(match (search, seen.outside) {
            (_, Some(point)) => NoContact::OutsideActiveRegion { point },
            (Search::Grazing([first, second]), _) => NoContact::Ambiguous { first, second },
            (Search::Incomplete, _) => NoContact::Unresolved,
            (Search::Complete, _) => why_none(wrench, surface),
        })
    }
}

#[inline]
fn is_in_range<T: Real>(contact: &SoftContact<T>) -> bool {
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
    }
}

/// The line of action misses, or meets the surface where it pulls.
#[cold]
fn why_none<T: Real, S: SoftFingerSurface<T>>(wrench: &Wrench<T>, surface: &S) -> NoContact<T> {
    let Ok(axis) = wrench.line_of_action() else { return NoContact::NotFinite };
    let mut pulling = None;
    surface.crossings(&axis.line, |crossing| {
        if axis.line.direction.dot(&crossing.normal) >= T::zero() {
            pulling = Some(crossing.point);
        }
    });
    if let Some(point) = pulling {
        return NoContact::OnlyPulling { point };
    }
    NoContact::Misses { closest: surface.closest_approach(&axis.line) }
}

stored! {
    SoftFinger<T>, [T: Real],
    |model| {
        #[serde(rename = "least_force_N", default = "T::zero")]
        least_force: T = model.least_force,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        greatest_friction: Option<T> = model.greatest_friction,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        torque_arm_m: Option<T> = model.torque_arm,
    },
    SoftFinger::new(least_force)
        .and_then(|model| match greatest_friction {
            Some(friction) => model.with_greatest_friction(friction),
            None => Ok(model),
        })
        .and_then(|model| match torque_arm_m {
            Some(arm) => model.with_torque_arm(arm),
            None => Ok(model),
        })
}
