//! Contact in a point, without local torque.

use fingertip_wrench::{NoLineOfAction, Real, Wrench};
use nalgebra::Vector3;

use crate::{ActiveSurface, BadShape, Contact, ContactModel, Crossing, NoContact, Resolution};

/// A contact that transmits a force and no torque of its own: it lies where the wrench's line of
/// action *enters* the surface (Salisbury 1984; equations (1), (2) of Bicchi & Dario 1987, mended
/// in theory 1).
///
/// The pitch of the wrench is ignored. On a shape that the line enters several times, the entry
/// nearest to the last contact is taken if one is given, otherwise the one where the force presses
/// most squarely, which asks least of friction; [`Contact::alternatives`] counts the others.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PointContact<T: Real> {
    least_force: T,
    greatest_gap: T,
}

impl<T: Real> PointContact<T> {
    /// Forces below `least_force` \[N\] are no contact. Take it from the noise of the sensor: three
    /// to five standard deviations of the force at rest. Zero accepts every force but zero.
    ///
    /// # Errors
    /// [`BadShape`] unless the threshold is finite and not negative.
    pub fn new(least_force: T) -> Result<Self, BadShape> {
        Ok(Self { least_force: check("least force", least_force)?, greatest_gap: T::zero() })
    }

    /// Accepts a line of action that misses the surface by at most `greatest_gap` \[m\], as noise
    /// makes it do near grazing: the contact is then the closest point of the surface.
    ///
    /// # Errors
    /// [`BadShape`] unless the gap is finite and not negative.
    pub fn accepting_gap(self, greatest_gap: T) -> Result<Self, BadShape> {
        Ok(Self { greatest_gap: check("accepted gap", greatest_gap)?, ..self })
    }

    /// The least force that counts as a contact \[N\].
    #[inline]
    #[must_use]
    pub const fn least_force(&self) -> T {
        self.least_force
    }
}

fn check<T: Real>(parameter: &'static str, value: T) -> Result<T, BadShape> {
    if value >= T::zero() && value.is_number() {
        Ok(value)
    } else {
        Err(BadShape { shape: "point contact", parameter, requirement: "finite and not negative" })
    }
}

/// What has been seen of the crossings so far.
struct Seen<T: Real> {
    best: Option<(Crossing<T>, T)>,
    candidates: u8,
    pulling: Option<Vector3<T>>,
    outside: Option<Vector3<T>>,
    any: bool,
}

impl<T: Real, S: ActiveSurface<T>> ContactModel<T, S> for PointContact<T> {
    #[inline]
    fn resolve_near(&self, wrench: &Wrench<T>, surface: &S, last: Option<&Vector3<T>>) -> Resolution<T> {
        let axis = match wrench.line_of_action() {
            Ok(axis) => axis,
            Err(NoLineOfAction::NoForce) => {
                return Resolution::NoContact(NoContact::BelowThreshold { force: T::zero() });
            }
            Err(_) => return Resolution::NoContact(NoContact::NotFinite),
        };
        if axis.force < self.least_force {
            return Resolution::NoContact(NoContact::BelowThreshold { force: axis.force });
        }
        let direction = axis.line.direction;
        let mut seen = Seen { best: None, candidates: 0, pulling: None, outside: None, any: false };
        surface.crossings(&axis.line, |crossing| {
            seen.any = true;
            let incidence = -direction.dot(&crossing.normal);
            if !(incidence > T::zero()) {
                if crossing.active {
                    seen.pulling = Some(crossing.point);
                }
                return;
            }
            if !crossing.active {
                seen.outside = Some(crossing.point);
                return;
            }
            seen.candidates = seen.candidates.saturating_add(1);
            let better = match (&seen.best, last) {
                (None, _) => true,
                (Some((best, _)), Some(last)) => {
                    (crossing.point - last).norm_squared() < (best.point - last).norm_squared()
                }
                (Some((_, best)), None) => incidence > *best,
            };
            if better {
                seen.best = Some((crossing, incidence));
            }
        });
        let contact = |point, normal, incidence: T, gap, alternatives| {
            Resolution::Contact(Contact {
                point,
                normal,
                force: wrench.force(),
                spin_torque: T::zero(),
                incidence: incidence.min(T::one()),
                gap,
                alternatives,
            })
        };
        if let Some((crossing, incidence)) = seen.best {
            return contact(crossing.point, crossing.normal, incidence, T::zero(), seen.candidates - 1);
        }
        if let Some(point) = seen.pulling {
            return Resolution::NoContact(NoContact::OnlyPulling { point });
        }
        if let Some(point) = seen.outside {
            return Resolution::NoContact(NoContact::OutsideActiveRegion { point });
        }
        let approach = surface.closest_approach(&axis.line);
        if approach.gap <= self.greatest_gap && approach.active && !seen.any {
            let incidence = (-direction.dot(&approach.normal)).max(T::zero());
            return contact(approach.point, approach.normal, incidence, approach.gap, 0);
        }
        Resolution::NoContact(NoContact::Misses {
            gap: approach.gap,
            closest: approach.point,
            normal: approach.normal,
        })
    }
}
