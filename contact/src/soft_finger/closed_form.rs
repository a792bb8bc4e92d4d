//! What closed forms find, as the searches of shapes.

use fingertip_surfaces::nearest_crossing;
use fingertip_surfaces::numeric::vectors::largest;
use fingertip_surfaces::{ActiveSurface, ForceLine};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;

use crate::model::flat;
use crate::{Search, SoftContact};

/// Whether a point of the surface belongs to its active part: as the crossing of the normal there
/// says.
pub(crate) fn is_active<T: Real, S: ActiveSurface<T>>(surface: &S, contact: &SoftContact<T>) -> bool {
    let line = Line { point: contact.point, direction: -contact.normal };
    nearest_crossing(surface, &line).is_some_and(|crossing| crossing.active)
}

/// Gives a shape its soft fingers: from the shape, the wrench and the last contact, to a search that
/// visits what it finds.
macro_rules! soft_finger {
    ($(#[$doc:meta])* $shape:ident, |$this:ident, $wrench:ident, $last:pat_param, $visit:ident| $search:expr
        $(, sole |$only:ident, $load:ident| $sole:expr)?
        $(, columns |$each:ident, $many:ident| $columns:expr)?
        $(, exactly |$narrow:ident, $wide:ident| $exactly:expr)?
        $(, double |$coarse:ident, $fine:ident| $again:expr)?
        $(, all in double |$whole_coarse:ident, $whole_fine:ident, $each_of:ident| $all:expr)?
        $(, surely |$sure:ident, $whole:ident, $pose:ident, $found:ident| $surely:expr)?
        $(, patch |$part:pat_param, $point:pat_param| $patch:expr)?
        $(, sizes |$sized:pat_param, $size:ident, $place:pat_param| $change:expr)?) => {
        $(#[$doc])*
        impl<T: fingertip_wrench::Real> $crate::SoftFingerSurface<T> for $shape<T> {
            #[inline]
            #[allow(unused_mut)]
            fn soft_contacts(
                &self,
                $wrench: &fingertip_wrench::Wrench<T>,
                $last: Option<&nalgebra::Vector3<T>>,
                mut $visit: impl FnMut($crate::SoftContact<T>),
            ) -> $crate::Search<T> {
                let $this = self;
                $search
            }

            $(#[inline(always)]
            fn sole_soft_contact(&self, $load: &fingertip_surfaces::ForceLine<T>) -> Option<$crate::SoftContact<T>> {
                let $only = self;
                $sole
            })?

            #[inline(always)]
            fn sole_soft_contacts_in_columns(
                &self,
            ) -> impl Fn(&fingertip_surfaces::ForceLine<T>) -> Option<$crate::SoftContact<T>> {
                let shape = *self;
                #[inline(always)]
                move |push| $crate::soft_finger::closed_form::in_columns!(&shape, push $(, |$each, $many| $columns)?)
            }

            $(fn sole_soft_contact_in_double(
                &self,
                $wide: &fingertip_wrench::Wrench<f64>,
            ) -> Option<$crate::SoftContact<f64>> {
                let $narrow = self;
                $exactly
            })?

            $(fn posed_soft_contacts_in_double(
                &self,
                wrench: &fingertip_wrench::Wrench<f64>,
                pose: &fingertip_wrench::RigidTransform<T>,
                visit: &mut dyn FnMut($crate::SoftContact<f64>),
            ) -> Option<$crate::Search<f64>> {
                let $coarse = self;
                let found = $crate::soft_finger::double::Moved::new(pose).sole(wrench, |$fine| $again)?;
                // The wrench has been rounded on its way into the frame of the shape.
                let found = match self.in_double() {
                    Some(double) => {
                        let pose = $crate::soft_finger::placed::widely(pose);
                        double.with_more_digits(wrench, Some(&pose), found)
                    }
                    None => found,
                };
                Some($crate::soft_finger::closed_form::told(found, visit))
            })?

            $(fn posed_soft_contacts_in_double(
                &self,
                wrench: &fingertip_wrench::Wrench<f64>,
                pose: &fingertip_wrench::RigidTransform<T>,
                visit: &mut dyn FnMut($crate::SoftContact<f64>),
            ) -> Option<$crate::Search<f64>> {
                let $whole_coarse = self;
                $crate::soft_finger::double::Moved::new(pose).all(
                    wrench,
                    |$whole_fine, $each_of| $all,
                    visit,
                )
            })?

            $(#[inline]
            fn with_more_digits(
                &self,
                $whole: &fingertip_wrench::Wrench<T>,
                $pose: Option<&fingertip_wrench::RigidTransform<T>>,
                $found: Result<$crate::SoftContact<T>, $crate::Search<T>>,
            ) -> Result<$crate::SoftContact<T>, $crate::Search<T>> {
                let $sure = self;
                $surely
            })?

            $(fn patch(&self, $point: &nalgebra::Vector3<T>) -> Option<$crate::Patch> {
                let $part = self;
                $patch.map($crate::Patch::from)
            })?

            $(fn sensitivity(
                &self,
                $size: usize,
                $place: &nalgebra::Vector3<T>,
            ) -> Option<$crate::GeometrySensitivity<T>> {
                let $sized = self;
                $change
            })?
        }
    };
}

pub(crate) use soft_finger;

/// The sole contact without a branch, of a shape that has its own way to it; of others, as they find it at all times.
macro_rules! in_columns {
    ($shape:expr, $push:ident) => {
        $shape.sole_soft_contact($push)
    };
    ($shape:expr, $push:ident, |$each:ident, $many:ident| $columns:expr) => {{
        let ($each, $many) = ($shape, $push);
        $columns
    }};
}

pub(crate) use in_columns;

/// Shapes that are a part of another shape.
macro_rules! part_of {
    ($shape:ident, $whole:ident) => {
        $crate::soft_finger::closed_form::soft_finger!(
            $shape,
            |shape, wrench, last, visit| {
                shape.$whole().soft_contacts(wrench, last, |contact| {
                    visit($crate::SoftContact {
                        active: $crate::soft_finger::closed_form::is_active(shape, &contact),
                        ..contact
                    });
                })
            },
            sole | shape,
            push | shape.$whole().sole_soft_contact(push).map(|contact| $crate::SoftContact {
                active: $crate::soft_finger::closed_form::is_active(shape, &contact),
                ..contact
            }),
            patch | shape,
            point | shape.$whole().patch(point),
            sizes | shape,
            size,
            point | shape.$whole().sensitivity(size, point)
        );
    };
}

pub(crate) use part_of;

/// Of a round surface, how many radii the lever is at which a force at the flattest angle may have the spin torque, if rounding
/// is not to grow by more than the type can bear: it grows with the square.
#[inline(always)]
pub(crate) fn steady_levers<T: Real>() -> T {
    T::literal(if T::EPSILON.to_f64() > f64::EPSILON { 0.5 } else { 4.0 })
}

/// `true` if the force presses at no flat angle on what a shortcut found, and the spin torque is not more
/// than the force has at a lever of this length: otherwise rounding errors grow.
#[inline(always)]
pub(crate) fn is_steady<T: Real>(push: &ForceLine<T>, contact: &SoftContact<T>, lever: T) -> bool {
    is_steady_under(&push.force(), push.squared().root(), contact, lever)
}

/// The same under a force of this strength.
#[inline(always)]
pub(crate) fn is_steady_under<T: Real>(
    force: &Vector3<T>,
    strength: T,
    contact: &SoftContact<T>,
    lever: T,
) -> bool {
    let steep = -force.dot(&contact.normal) >= flat::<T>() * strength;
    steep & (contact.spin_torque.abs() <= strength * lever)
}

/// What was found, or why not, as a search.
#[inline]
pub(crate) fn told<T: Real>(
    found: Result<SoftContact<T>, Search<T>>,
    mut visit: impl FnMut(SoftContact<T>),
) -> Search<T> {
    match found {
        Ok(contact) => {
            visit(contact);
            Search::Complete
        }
        Err(search) => search,
    }
}

/// The contact of a closed convex body, which has one wherever there is a spin torque: if none was found,
/// rounding hides it, unless the wrench is a pure force for all that its numbers say.
///
/// # Errors
/// How the search ended without it.
pub(crate) fn sole<T: Real>(
    found: Option<SoftContact<T>>,
    wrench: &Wrench<T>,
) -> Result<SoftContact<T>, Search<T>> {
    found.ok_or_else(|| {
        let pure = is_pure_force(&wrench.force(), &wrench.torque());
        if pure { Search::Complete } else { Search::Incomplete }
    })
}

/// Whether a wrench is a pure force, `f·m = 0`, for all that its numbers say.
pub(crate) fn is_pure_force<T: Real>(force: &Vector3<T>, torque: &Vector3<T>) -> bool {
    is_pure_force_of(force, torque, T::EPSILON)
}

/// The same of a wrench whose numbers are rounded to so much of them.
pub(crate) fn is_pure_force_of<T: Real>(force: &Vector3<T>, torque: &Vector3<T>, epsilon: T) -> bool {
    let power = force.dot(torque).abs();
    // Half a unit in the last place of every number, and as much in three products and two sums.
    !(power > largest(force) * largest(torque) * epsilon * T::literal(8.0))
}

/// Whether a wrench has surely a torque along its force, even if each of its numbers were off by 16 units in the last place:
/// where force and torque are along different axes, [`is_pure_force_of`] takes a wrench for a pure force that is none.
pub(crate) fn is_surely_twisted(force: &Vector3<f64>, torque: &Vector3<f64>, epsilon: f64) -> bool {
    let products = force.component_mul(torque);
    products.sum().abs() > 32.0 * epsilon * products.abs().sum()
}
