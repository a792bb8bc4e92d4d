//! Contact in a point, without local torque.

use fingertip_surfaces::numeric::mixed_precision::is_asked_again;
use fingertip_surfaces::numeric::vectors::{hypotenuse, in_range, larger, largest};
use fingertip_surfaces::{
    ActiveSurface, BadShape, ClosestApproach, ForceLine, ForceParts, Shortcuts, is_closed_convex,
};
use fingertip_wrench::{
    ContactForce, Line, LineOfAction, NoLineOfAction, Real, TangentialForce, Wrench, stored,
};
use nalgebra::Vector3;

use super::long_way::long_way;
use super::onto_line::{MoreDigits, Place, by_more_digits, entered};
use super::seen::{Seen, too_flat};
use super::{Contact, ContactModel, NoContact, Resolution};

/// A contact that transmits a force and no torque of its own: it lies where the wrench's line of
/// action *enters* the surface (Salisbury 1984; equations (1), (2) of Bicchi & Dario 1987, mended
/// in `docs/theory/README.md#errata-of-the-paper`).
///
/// The pitch of the wrench is ignored. A shape that is not convex may be entered several times. Of
/// those entries the ones that would need more friction than
/// [`with_greatest_friction`](Self::with_greatest_friction) allows are set aside; of the rest the one
/// nearest to the last contact is taken if that is given, otherwise the one where the force presses
/// most squarely, which asks least of friction. [`Contact::alternatives`] counts the others, and
/// [`candidates`](Self::candidates) reports them all.
///
/// ```
/// use fingertip_contact::{ContactModel, NoContact, PointContact};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // Forces of 50 mN and more count, and none needs more friction than 1.5.
/// let model = PointContact::new(0.05)?.with_greatest_friction(1.5)?;
/// let (sphere, place) = (Sphere::centred(0.01)?, Vector3::new(0.006, 0.0, 0.008));
/// let push = Wrench::from_force_at(&place, Vector3::new(-0.5, 0.2, -0.8));
/// let contact = model.resolve(&push, &sphere).into_result()?;
/// assert!((contact.point - place).norm() < 1e-12);
/// // 2 N aside under 1 N.
/// let scrape = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.01), Vector3::new(2.0, 0.0, -1.0));
/// assert!(matches!(model.resolve(&scrape, &sphere).into_result(), Err(NoContact::BeyondFriction { .. })));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointContact<T: Real> {
    least_force: T,
    greatest_gap: T,
    greatest_friction: Option<T>,
    /// `1/√(1 + μ²)`: the least cosine between force and inward normal.
    least_incidence: T,
    /// The least square of a force, and of the cosine, that take the short way.
    short_way: [T; 2],
}

/// Below this cosine of incidence, where rounding errors grow more than threefold, the long way is
/// taken.
#[inline]
pub(crate) fn flat<T: Real>() -> T {
    T::literal(0.3)
}

/// The same in a narrower type where a pose has moved the shape, which rounds force and torque once more.
#[inline]
pub(crate) fn flat_when_moved<T: Real>() -> T {
    T::literal(0.6)
}

/// The one or the other, as the surface is.
#[inline(always)]
pub(super) fn flat_on<T: Real>(shortcuts: &impl Shortcuts<T>) -> T {
    if is_asked_again::<T>() && shortcuts.is_moved() { flat_when_moved() } else { flat() }
}

impl<T: Real> PointContact<T> {
    /// Forces below `least_force` \[N\] are no contact. Take it from the noise of the sensor: three
    /// to five standard deviations of the force at rest. Zero accepts every force but zero.
    ///
    /// # Errors
    /// [`BadShape`] unless the threshold is finite and not negative.
    pub fn new(least_force: T) -> Result<Self, BadShape> {
        let least_force = check("least force", least_force)?;
        Ok(Self {
            least_force,
            greatest_gap: T::zero(),
            greatest_friction: None,
            least_incidence: T::zero(),
            short_way: [
                (least_force * least_force).max(ForceLine::least_squared()),
                flat::<T>().whole_power(2),
            ],
        })
    }

    /// Accepts a line of action that misses the surface by at most `greatest_gap` \[m\], as noise
    /// makes it do near grazing: the contact is then the closest point of the surface. A surface that does
    /// not know its closest point (see [`ActiveSurface::closest_approach`]) has none.
    ///
    /// # Errors
    /// [`BadShape`] unless the gap is finite and not negative.
    pub fn with_greatest_gap(self, greatest_gap: T) -> Result<Self, BadShape> {
        Ok(Self { greatest_gap: check("greatest gap", greatest_gap)?, ..self })
    }

    /// No contact needs a friction ratio above `greatest_friction`: entries that do are left out,
    /// and so are lines that miss, at which the ratio is infinite.
    ///
    /// # Errors
    /// [`BadShape`] unless it is finite and not negative.
    pub fn with_greatest_friction(self, greatest_friction: T) -> Result<Self, BadShape> {
        let mu = check("greatest friction", greatest_friction)?;
        let least_incidence = T::one() / hypotenuse(T::one(), mu);
        let [least_squared, _] = self.short_way;
        let short_way = [least_squared, least_incidence.max(flat()).whole_power(2)];
        Ok(Self { greatest_friction: Some(mu), least_incidence, short_way, ..self })
    }

    /// The least force that counts as a contact \[N\].
    #[inline]
    #[must_use]
    pub const fn least_force(&self) -> T {
        self.least_force
    }

    /// By how much a line of action may miss the surface \[m\].
    #[inline]
    #[must_use]
    pub const fn greatest_gap(&self) -> T {
        self.greatest_gap
    }

    /// The greatest friction ratio that a contact may need, if there is a limit.
    #[inline]
    #[must_use]
    pub const fn greatest_friction(&self) -> Option<T> {
        self.greatest_friction
    }

    /// The line of action, if the force is one.
    #[inline]
    fn axis(&self, wrench: &Wrench<T>) -> Result<LineOfAction<T>, NoContact<T>> {
        match wrench.line_of_action() {
            Ok(axis) if axis.force >= self.least_force => Ok(axis),
            Ok(axis) => Err(NoContact::BelowThreshold { force: axis.force }),
            Err(NoLineOfAction::NoForce) => Err(NoContact::BelowThreshold { force: T::zero() }),
            Err(_) => Err(NoContact::NotFinite),
        }
    }

    /// Calls `visit` with every contact that would explain the wrench, in no particular order: all
    /// entries of the line of action into the active surface that friction can hold. Their
    /// `alternatives` are left zero.
    ///
    /// # Errors
    /// [`NoContact`] if there is none, as [`resolve`](ContactModel::resolve) would say.
    pub fn candidates<S: ActiveSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        mut visit: impl FnMut(Contact<T>),
    ) -> Result<(), NoContact<T>> {
        let axis = self.axis(wrench)?;
        let mut any = false;
        surface.crossings(&axis.line, |crossing| {
            let incidence = -axis.line.direction.dot(&crossing.normal);
            let pressing = incidence > T::zero() && incidence >= self.least_incidence;
            if crossing.active && pressing && in_range(&crossing.point) {
                any = true;
                let place = entered(wrench, surface, (crossing.point, crossing.normal), incidence);
                visit(contact_at(wrench, place.point, place.normal));
            }
        });
        if any {
            return Ok(());
        }
        self.resolve(wrench, surface).into_result().map(&mut visit)
    }
}

#[inline]
fn contact_at<T: Real>(wrench: &Wrench<T>, point: Vector3<T>, normal: Vector3<T>) -> Contact<T> {
    Contact {
        point,
        normal,
        force: wrench.force(),
        spin_torque: T::zero(),
        gap: T::zero(),
        alternatives: 0,
        searched: false,
    }
}

fn check<T: Real>(parameter: &'static str, value: T) -> Result<T, BadShape> {
    BadShape::check(
        "point contact",
        parameter,
        "finite and not negative",
        value >= T::zero() && value.is_number(),
    )
    .map(|()| value)
}

impl<T: Real, S: ActiveSurface<T>> ContactModel<T, S> for PointContact<T> {
    /// Always in line, with the long way kept out of the registers: a contact that is found the short
    /// way then never goes through memory on its way to friction.
    #[inline(always)]
    fn resolve_near(&self, wrench: &Wrench<T>, surface: &S, last: Option<&Vector3<T>>) -> Resolution<T> {
        match self.short_way(wrench, surface) {
            Some((contact, _)) => Resolution::Contact(contact),
            None => long_way(wrench, |copy| self.choose(copy, surface, last)),
        }
    }

    #[inline(always)]
    fn feel_near(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
    ) -> (Resolution<T>, Option<ContactForce<T>>) {
        if let Some((contact, parts)) = self.short_way(wrench, surface) {
            let force = parts.map_or_else(|| contact.contact_force(), |parts| split(&contact, &parts));
            return (Resolution::Contact(contact), Some(force));
        }
        let resolution = long_way(wrench, |copy| self.choose(copy, surface, last));
        let force = resolution.contact().map(Contact::contact_force);
        (resolution, force)
    }
}

/// Splits the force of a contact whose parts are known.
#[inline(always)]
fn split<T: Real>(contact: &Contact<T>, parts: &ForceParts<T>) -> ContactForce<T> {
    let tangential = contact.force + contact.normal * parts.normal;
    ContactForce {
        normal: parts.normal,
        tangential: TangentialForce::of_magnitude(tangential, parts.tangential),
        spin: contact.spin_torque,
    }
}

impl<T: Real> PointContact<T> {
    /// The contact of a force that enters where closed forms say, squarely enough that rounding does
    /// not matter.
    #[inline(always)]
    fn short_way<S: ActiveSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
    ) -> Option<(Contact<T>, Option<ForceParts<T>>)> {
        let [least_squared, least_steepness] = self.short_way;
        let push = ForceLine::new(wrench, least_squared)?;
        let shortcuts = surface.shortcuts();
        let entry = shortcuts.sole_entry(&push)?;
        let steep = entry.incidence_squared >= least_steepness
            && (!shortcuts.is_moved() || entry.incidence_squared >= flat_on(&shortcuts).whole_power(2));
        (entry.active && steep).then(
            #[inline(always)]
            || (contact_at(wrench, entry.point, entry.normal), entry.parts),
        )
    }

    /// The contact, or the reason why there is none.
    #[inline(never)]
    fn choose<S: ActiveSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        last: Option<&Vector3<T>>,
    ) -> Resolution<T> {
        let axis = match self.axis(wrench) {
            Ok(axis) => axis,
            Err(reason) => return Resolution::NoContact(reason),
        };
        let found = if is_closed_convex(&surface.shortcuts()) {
            self.only_entry(wrench, surface, &axis.line)
        } else {
            self.best_entry(wrench, surface, &axis.line, last).unwrap_or_else(|| {
                let closest = surface.closest_approach(&axis.line);
                self.meet(wrench, surface, &axis.line, closest, false)
            })
        };
        // One place writes the contact, whichever way it was found: that keeps the code small.
        match found {
            Ok(Place { point, normal, gap, alternatives }) => {
                Resolution::Contact(Contact { gap, alternatives, ..contact_at(wrench, point, normal) })
            }
            Err(reason) => Resolution::NoContact(reason),
        }
    }

    /// Where the line enters a surface that no line enters twice, or what to make of it if it misses.
    #[inline(always)]
    fn only_entry<S: ActiveSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        line: &Line<T>,
    ) -> Result<Place<T>, NoContact<T>> {
        // What both ways do is there once: that keeps the code small, too.
        let (enters, found) = surface.entry_or_closest(line);
        self.meet(wrench, surface, line, found, enters)
    }

    /// Of all entries the best, or the reason why none is a contact; `None` if there are none.
    #[inline(always)]
    fn best_entry<S: ActiveSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        line: &Line<T>,
        last: Option<&Vector3<T>>,
    ) -> Option<Result<Place<T>, NoContact<T>>> {
        let mut seen =
            Seen { best: None, candidates: 0, too_flat: None, tangent: None, pulling: None, outside: None };
        surface.crossings(line, |crossing| {
            let incidence = -line.direction.dot(&crossing.normal);
            let pressing = incidence > T::zero() && incidence >= self.least_incidence;
            if !(crossing.active && pressing && in_range(&crossing.point)) {
                seen.refuse(&crossing, incidence);
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
        if let Some((crossing, incidence)) = seen.best {
            let place = entered(wrench, surface, (crossing.point, crossing.normal), incidence);
            return Some(Ok(Place { alternatives: seen.candidates - 1, ..place }));
        }
        // A line that is tangent within rounding neither presses nor pulls, but touches.
        if let (Some(crossing), true) = (seen.tangent, self.least_incidence <= T::zero()) {
            return Some(Ok(entered(wrench, surface, (crossing.point, crossing.normal), T::zero())));
        }
        seen.reason().map(Err)
    }

    /// What to make of a line that enters at `closest`, or misses and is closest there.
    #[inline(always)]
    fn meet<S: ActiveSurface<T>>(
        &self,
        wrench: &Wrench<T>,
        surface: &S,
        line: &Line<T>,
        closest: Option<ClosestApproach<T>>,
        enters: bool,
    ) -> Result<Place<T>, NoContact<T>> {
        let Some(approach) = closest else {
            return Err(NoContact::Misses { closest: None });
        };
        let ClosestApproach { gap, point, normal, active } = approach;
        if !(in_range(&point) && gap.is_number()) {
            return Err(NoContact::NotFinite);
        }
        // A line that is tangent within rounding neither presses nor pulls, but touches.
        let incidence = larger(-line.direction.dot(&normal), T::zero());
        let held = incidence >= self.least_incidence;
        if enters {
            if !held {
                return Err(too_flat(point, incidence));
            }
            let place = entered(wrench, surface, (point, normal), incidence);
            // Rounding may make a line meet that misses, and pull where the surface is bent so sharply that it turns
            // the normal by more than that of a line that grazes.
            return if line.direction.dot(&place.normal) <= T::EPSILON.root() {
                Ok(place)
            } else {
                Err(NoContact::Misses { closest })
            };
        }
        // Rounding may make a line miss that meets: more digits know.
        let hair = T::EPSILON * T::literal(64.0) * largest(&point);
        if active
            && gap <= hair
            && let MoreDigits::Enters(point, normal) = by_more_digits(wrench, surface, &point, T::zero())
            && -line.direction.dot(&normal) >= self.least_incidence
        {
            return Ok(Place::at(point, normal));
        }
        if gap <= self.greatest_gap && active && held {
            return Ok(Place { gap, ..Place::at(point, normal) });
        }
        Err(NoContact::Misses { closest: Some(approach) })
    }
}

stored! {
    PointContact<T>, [T: Real],
    |model| {
        #[serde(rename = "least_force_N", default = "T::zero")] least_force: T = model.least_force,
        #[serde(default = "T::zero")] greatest_gap_m: T = model.greatest_gap,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        greatest_friction: Option<T> = model.greatest_friction,
    },
    PointContact::new(least_force)
        .and_then(|model| model.with_greatest_gap(greatest_gap_m))
        .and_then(|model| match greatest_friction {
            Some(friction) => model.with_greatest_friction(friction),
            None => Ok(model),
        })
}
