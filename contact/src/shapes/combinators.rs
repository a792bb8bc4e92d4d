//! Shapes made of shapes.

use fingertip_surfaces::is_inside_along;
use fingertip_surfaces::numeric::fine_pose::FinePose;
use fingertip_surfaces::numeric::mixed_precision::is_asked_again;
use fingertip_surfaces::numeric::moved::{direction_inside, direction_outside, point_inside, point_outside};
use fingertip_surfaces::{
    ActiveSurface, Compound, ForceLine, Offset, Posed, Region, SignedDistance, SmoothSurface, Trimmed,
};
use fingertip_wrench::{Line, Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use crate::model::flat_when_moved;
use crate::soft_finger::closed_form::is_pure_force;
use crate::soft_finger::double::{Moved, in_type, narrow, widened};
use crate::soft_finger::placed::placed;
use crate::{GeometrySensitivity, Patch, Search, SoftContact, SoftFingerSurface, newton_soft_contacts};

/// The contacts of a posed shape by those of the shape, under the wrench in its frame.
fn moved<T: Real, S: SoftFingerSurface<T>>(
    posed: &Posed<T, S>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
    mut visit: impl FnMut(SoftContact<T>),
) -> Search<T> {
    let pose = posed.sensor_from_shape();
    let inside = Wrench::on_fingertip(
        direction_inside(pose, &wrench.force()),
        direction_inside(pose, &wrench.torque_about(&pose.origin())),
    );
    let last = last.map(|last| point_inside(pose, last));
    let search = posed.inner().soft_contacts(&inside, last.as_ref(), |contact| {
        let (point, normal) = (point_outside(pose, &contact.point), direction_outside(pose, &contact.normal));
        visit(SoftContact { point, normal, ..contact });
    });
    match search {
        Search::Grazing(pair) => Search::Grazing(pair.map(|point| point_outside(pose, &point))),
        other => other,
    }
}

/// A contact of the shape, if in a narrower type the force presses more steeply than the shape asks for.
#[inline(always)]
fn steeply_moved<T: Real>(
    pose: &RigidTransform<T>,
    push: &ForceLine<T>,
    of_shape: impl Fn(&ForceLine<T>) -> Option<SoftContact<T>>,
) -> Option<SoftContact<T>> {
    let found = of_shape(&push.seen_from(pose))?;
    let normal = pose.rotate(&found.normal);
    let pressing = push.force().dot(&normal);
    if is_asked_again::<T>()
        && !(pressing * pressing >= flat_when_moved::<T>().whole_power(2) * push.squared())
    {
        return None;
    }
    Some(SoftContact { point: pose.transform_point(&found.point), normal, ..found })
}

impl<T: Real, S: SoftFingerSurface<T>> SoftFingerSurface<T> for Posed<T, S> {
    /// In double precision where the type is narrower and the shape knows: moving a wrench rounds it, and turning it by a
    /// rotation that is orthogonal to a few digits bends it.
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        if !is_asked_again::<T>() {
            return moved(self, wrench, last, |contact| {
                visit(self.with_more_digits(wrench, None, Ok(contact)).unwrap_or(contact));
            });
        }
        let (pose, mut any) = (self.sensor_from_shape(), false);
        let told = self.inner().posed_soft_contacts_in_double(&widened(wrench), pose, &mut |contact| {
            any = true;
            visit(narrow(&contact));
        });
        let ended = match told {
            Some(ended) if any || matches!(ended, Search::Grazing(_)) => return in_type(ended),
            Some(ended) => ended,
            None => return moved(self, wrench, last, visit),
        };
        // A pure force either hits or misses, though it is none any more once it is moved.
        if is_pure_force(&wrench.force(), &wrench.torque()) {
            return Search::Complete;
        }
        if ended != Search::Complete {
            return moved(self, wrench, last, visit);
        }
        // There is none; whether rounding could make one is for the narrower type to say.
        let mut any = false;
        let search = moved(self, wrench, last, |_| any = true);
        if any { Search::Incomplete } else { search }
    }

    /// In a narrower type only of a force that presses a little more steeply than the shape asks for: moving the wrench
    /// rounds it.
    #[inline]
    fn sole_soft_contact(&self, push: &ForceLine<T>) -> Option<SoftContact<T>> {
        steeply_moved(
            self.sensor_from_shape(),
            push,
            #[inline(always)]
            |inside| self.inner().sole_soft_contact(inside),
        )
    }

    #[inline(always)]
    fn sole_soft_contacts_in_columns(&self) -> impl Fn(&ForceLine<T>) -> Option<SoftContact<T>> {
        let (pose, of_shape) = (*self.sensor_from_shape(), self.inner().sole_soft_contacts_in_columns());
        #[inline(always)]
        move |push| {
            // Not `&of_shape`, which the compiler would rather call.
            steeply_moved(
                &pose,
                push,
                #[inline(always)]
                |inside| of_shape(inside),
            )
        }
    }

    fn sole_soft_contact_in_double(&self, wrench: &Wrench<f64>) -> Option<SoftContact<f64>> {
        let moved = Moved::new(self.sensor_from_shape());
        moved.sole(wrench, |inside| self.inner().sole_soft_contact_in_double(inside).map(Ok))?.ok()
    }

    /// Of a pose of a pose.
    fn posed_soft_contacts_in_double(
        &self,
        wrench: &Wrench<f64>,
        pose: &RigidTransform<T>,
        visit: &mut dyn FnMut(SoftContact<f64>),
    ) -> Option<Search<f64>> {
        let own = self.sensor_from_shape();
        let inner = self.inner();
        Moved::new(pose).all(
            wrench,
            |inside, found| inner.posed_soft_contacts_in_double(inside, own, found),
            visit,
        )
    }

    /// That of the shape, in its place. A pose of a pose has none.
    fn patch(&self, point: &Vector3<T>) -> Option<Patch> {
        let pose = self.sensor_from_shape();
        let inside = pose.rotation().tr_mul(&(point - pose.origin()));
        placed(self.inner().patch(&inside)?, Some(pose))
    }

    /// Of the shape in its pose. A pose of a pose keeps what was found.
    fn with_more_digits(
        &self,
        wrench: &Wrench<T>,
        pose: Option<&RigidTransform<T>>,
        found: Result<SoftContact<T>, Search<T>>,
    ) -> Result<SoftContact<T>, Search<T>> {
        match pose {
            None => self.inner().with_more_digits(wrench, Some(self.sensor_from_shape()), found),
            Some(_) => found,
        }
    }

    /// That of the shape, wherever it is. (How well its place is known is a matter of
    /// [`GeometryUncertainty`](crate::GeometryUncertainty).)
    fn sensitivity(&self, size: usize, point: &Vector3<T>) -> Option<GeometrySensitivity<T>> {
        let pose = self.sensor_from_shape();
        let inside = pose.rotation().tr_mul(&(point - pose.origin()));
        let change = self.inner().sensitivity(size, &inside)?;
        Some(GeometrySensitivity { tilt: pose.rotation() * change.tilt, ..change })
    }
}

/// A contact of the whole shape, active only where its place in the frame of the shape is in the region.
fn within<T: Real, U: Real, S, R: Region<T>>(
    trimmed: &Trimmed<S, R>,
    contact: SoftContact<U>,
    place: &Vector3<T>,
) -> SoftContact<U> {
    SoftContact { active: contact.active && trimmed.region().includes(place), ..contact }
}

impl<T: Real, S: SoftFingerSurface<T>, R: Region<T>> SoftFingerSurface<T> for Trimmed<S, R> {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        self.inner().soft_contacts(wrench, last, |contact| visit(within(self, contact, &contact.point)))
    }

    fn patch(&self, point: &Vector3<T>) -> Option<Patch> {
        self.inner().patch(point)
    }

    fn posed_soft_contacts_in_double(
        &self,
        wrench: &Wrench<f64>,
        pose: &RigidTransform<T>,
        visit: &mut dyn FnMut(SoftContact<f64>),
    ) -> Option<Search<f64>> {
        let fine = FinePose::new(pose);
        self.inner().posed_soft_contacts_in_double(wrench, pose, &mut |contact| {
            let place = fine.point_inside(&contact.point);
            visit(within(self, contact, &place.map(T::literal)));
        })
    }

    fn with_more_digits(
        &self,
        wrench: &Wrench<T>,
        pose: Option<&RigidTransform<T>>,
        found: Result<SoftContact<T>, Search<T>>,
    ) -> Result<SoftContact<T>, Search<T>> {
        let again = self.inner().with_more_digits(wrench, pose, found);
        again.map(|contact| {
            let place = pose.map_or(contact.point, |pose| point_inside(pose, &contact.point));
            within(self, contact, &place)
        })
    }

    #[inline]
    fn sole_soft_contact(&self, push: &ForceLine<T>) -> Option<SoftContact<T>> {
        self.inner().sole_soft_contact(push).map(|contact| within(self, contact, &contact.point))
    }

    fn sole_soft_contact_in_double(&self, wrench: &Wrench<f64>) -> Option<SoftContact<f64>> {
        let found = self.inner().sole_soft_contact_in_double(wrench);
        found.map(|contact| within(self, contact, &contact.point.map(T::literal)))
    }

    /// That of the whole shape.
    fn sensitivity(&self, size: usize, point: &Vector3<T>) -> Option<GeometrySensitivity<T>> {
        self.inner().sensitivity(size, point)
    }
}

/// `true` if a contact of one part lies inside another part, or on the seam and is not its own.
fn is_covered<T: Real>(part: &impl ActiveSurface<T>, contact: &SoftContact<T>, tie: bool) -> bool {
    let line = Line { point: contact.point, direction: contact.normal };
    is_inside_along(part, &line, T::zero(), &contact.point, tie)
}

/// What is known of a union from what is known of two parts; `seen` if there was a contact.
fn of_both<T: Real>(first: Search<T>, second: Search<T>, seen: bool) -> Search<T> {
    match (first, second) {
        (Search::Incomplete, _) | (_, Search::Incomplete) => Search::Incomplete,
        (Search::Uncertified, _) | (_, Search::Uncertified) => Search::Uncertified,
        (Search::Grazing(pair), _) | (_, Search::Grazing(pair)) if !seen => Search::Grazing(pair),
        _ => Search::Complete,
    }
}

/// The contacts of both parts that do not lie inside the other. On the seam, which is a groove,
/// nothing flat can touch.
impl<T: Real, A: SoftFingerSurface<T>, B: SoftFingerSurface<T>> SoftFingerSurface<T> for Compound<A, B> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let (first, second) = self.parts();
        let mut seen = false;
        let of_first = first.soft_contacts(wrench, last, |contact| {
            if !is_covered(second, &contact, true) {
                seen = true;
                visit(contact);
            }
        });
        let of_second = second.soft_contacts(wrench, last, |contact| {
            if !is_covered(first, &contact, false) {
                seen = true;
                visit(contact);
            }
        });
        of_both(of_first, of_second, seen)
    }
}

impl<T: Real, S: SmoothSurface<T> + SignedDistance<T>> SoftFingerSurface<T> for Offset<T, S> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        newton_soft_contacts(self, wrench, last, visit)
    }

    /// The distance, which is its only size.
    fn sensitivity(&self, size: usize, _: &Vector3<T>) -> Option<GeometrySensitivity<T>> {
        (size == 0).then(GeometrySensitivity::offset)
    }
}
